// The live stream. fetch() rather than EventSource: it can carry a token, and it says why it was refused.

const kRetryMs = 700;
const kSilentMs = 4000; // a stream this silent is dead, whatever TCP believes

/** `handlers`: snapshot(object), tick(object), state(word, reason). Runs until the page is gone. */
export function openLink(token, handlers) {
  let last = performance.now();
  let abort = null;
  let stopped = false;

  function take(block) {
    let kind = "message";
    let data = "";
    for (const line of block.split("\n")) {
      if (line.startsWith("event: ")) kind = line.slice(7);
      if (line.startsWith("data: ")) data = line.slice(6);
    }
    if (data === "") return;
    const value = JSON.parse(data);
    if (kind === "snapshot") handlers.snapshot(value);
    if (kind === "tick") handlers.tick(value);
  }

  async function read(response) {
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    while (true) {
      const {value, done} = await reader.read();
      if (done) return;
      last = performance.now();
      const blocks = (rest + value).split("\n\n");
      rest = blocks.pop();
      for (const block of blocks) take(block);
    }
  }

  /** In the console's words, where it found any. */
  async function reason(response) {
    const answer = await response.json().catch(() => ({}));
    return answer.text ?? `the console answered ${response.status}`;
  }

  async function once() {
    abort = new AbortController();
    last = performance.now();
    const shown = token();
    const headers = shown ? {Authorization: "Bearer " + shown} : {};
    const response = await fetch("/api/live", {headers, signal: abort.signal, cache: "no-store"});
    if (response.status === 401) return handlers.state("refused", "This console shows itself only to those with a token; sign in.");
    if (!response.ok) return handlers.state("refused", await reason(response));
    handlers.state("live", "");
    await read(response);
    handlers.state("lost", "the console ended the stream");
  }

  async function forever() {
    while (!stopped) {
      try {
        await once();
      } catch {
        handlers.state("lost", "the console does not answer");
      }
      await new Promise((resolve) => setTimeout(resolve, kRetryMs));
    }
  }

  const watch = setInterval(() => {
    if (performance.now() - last > kSilentMs) abort?.abort();
  }, 1000);
  forever();
  return {
    again: () => abort?.abort(),
    stop: () => {
      stopped = true;
      clearInterval(watch);
      abort?.abort();
    },
  };
}
