// Who one is, and what one orders. A token lives in this tab only; it comes by the sign-in dialog or in the part
// of the address after '#', which browsers never send.
import {el} from "./dom.js";
import {store} from "./store.js";

const kKey = "fathom.token";
const listeners = [];
export const token = () => sessionStorage.getItem(kKey) ?? "";
/** Headers that say who asks; none without a token. */
export const authorization = () => (token() ? {Authorization: "Bearer " + token()} : {});
export const onSession = (listener) => listeners.push(listener);
export const mayOrder = () => store.session.role === "operator" && store.session.orders;

export function takeTokenFromAddress() {
  const match = location.hash.match(/^#token=(.+)$/);
  if (!match) return;
  sessionStorage.setItem(kKey, decodeURIComponent(match[1]));
  history.replaceState(null, "", location.pathname);
}

export async function loadSession() {
  try {
    const response = await fetch("/api/session", {headers: authorization(), cache: "no-store"});
    const answer = await response.json();
    if (response.ok) Object.assign(store.session, answer);
    else {
      sessionStorage.removeItem(kKey);
      notice(answer.text, false);
    }
  } catch {
    return false;
  }
  for (const listener of listeners) listener();
  return true;
}

export function notice(text, good) {
  const line = el("p", {class: good ? "" : "failed"}, (good ? "✔ " : "✖ ") + text);
  const box = document.getElementById("notices");
  box.append(line);
  while (box.children.length > 4) box.firstChild.remove();
  setTimeout(() => line.remove(), 8000);
}

/** True when the order was passed on. One that has to be confirmed is, where the operator says so. */
export async function order(content) {
  try {
    const response = await fetch("/api/order", {
      method: "POST",
      headers: {"Content-Type": "application/json", ...authorization()},
      body: JSON.stringify(content),
    });
    const answer = await response.json();
    if (response.ok && answer.confirm) {
      const sure = await ask("Confirm the position", answer.text, "Set it all the same");
      return sure ? order({...content, confirmed: true}) : false;
    }
    notice(answer.text, response.ok && (answer.verdict ?? "used") === "used");
    return response.ok;
  } catch {
    notice("The console does not answer; the order was not given.", false);
    return false;
  }
}

/** A question before anything that changes navigation. `fields`: [label, key, value, step]. Resolves to the values or null. */
export function ask(title, text, verb, fields = []) {
  return new Promise((resolve) => {
    const inputs = fields.map(([, key, value, type]) =>
      el("input", {
        name: key,
        value: String(value ?? ""),
        type: type ?? "number",
        step: "any",
        required: true,
        autocomplete: "off",
      }),
    );
    const form = el(
      "form",
      {method: "dialog"},
      el("h2", {}, title),
      text ? el("p", {}, text) : null,
      ...fields.map(([label], i) => el("label", {}, label, inputs[i])),
      el(
        "div",
        {class: "row"},
        el("button", {type: "button", onclick: () => dialog.close()}, "Cancel"),
        el("button", {class: "primary", value: "yes"}, verb),
      ),
    );
    const dialog = el(
      "dialog",
      {
        "aria-label": title,
        onclose: () => {
          const values = Object.fromEntries(
            inputs.map((input) => [input.name, input.type === "number" ? Number(input.value) : input.value]),
          );
          resolve(dialog.returnValue === "yes" ? values : null);
          dialog.remove();
        },
      },
      form,
    );
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** A tunnel or a proxy ends on this host; from any other one plain http passes over the network. */
const overheard = () =>
  location.protocol === "http:" && !/^(localhost|127\.\d+\.\d+\.\d+|\[::1\])$/.test(location.hostname);

export async function signIn() {
  if (token()) {
    sessionStorage.removeItem(kKey);
    await loadSession();
    return true;
  }
  const values = await ask(
    "Sign in",
    "The token of a viewer or an operator, as in the console's token file." +
      (overheard() ? " ▲ This connection is not encrypted: others on the network can read the token." : ""),
    "Sign in",
    [["Token", "token", "", "password"]],
  );
  if (!values) return false;
  sessionStorage.setItem(kKey, values.token.trim());
  await loadSession();
  return true;
}
