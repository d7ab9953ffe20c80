// The stage that the tests play on: the demonstration, Chromium, pages, and patience.
import {spawn, execFile, execFileSync} from "node:child_process";
import {createRequire} from "node:module";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {setTimeout as pause} from "node:timers/promises";

const require = createRequire(process.env.FATHOM_NPM_DIR + "/package.json");
const {chromium} = require("playwright-core");
const axeSource = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");
export const kBin = process.env.FATHOM_BIN;
export const kDomain = process.env.FATHOM_DOMAIN;

/** What is awaited may take this long: the machine may have other things to do on every core. */
export const kPatienceMs = 240000;
export const kShots = process.env.FATHOM_SHOTS;

export function check(condition, what) {
  if (!condition) throw new Error("NOT AS EXPECTED: " + what);
}

/** Waits until `ask` gives something true, and returns it. */
export async function until(what, ask, patienceMs = kPatienceMs) {
  const end = Date.now() + patienceMs;
  let last;
  while (Date.now() < end) {
    try {
      last = await ask();
      if (last) return last;
    } catch (error) {
      last = error.message;
    }
    await pause(100);
  }
  throw new Error(`NOT WITHIN ${patienceMs / 1000} s: ${what}; last: ${JSON.stringify(last)}`);
}

/** The demonstration, started; `address` is what it printed. */
export async function startDemo() {
  const demo = spawn(kBin + "/fathom-demo", ["--domain", kDomain, "--duration", "1600"], {
    stdio: ["ignore", "pipe", "pipe"],
  });
  let output = "";
  for (const stream of [demo.stdout, demo.stderr]) stream.on("data", (bytes) => (output += bytes));
  const ended = new Promise((resolve) => demo.on("exit", resolve));
  const address = await until("the console's address", () => output.match(/Console: (\S+)/)?.[1]);
  return {
    address,
    plain: address.replace(/#.*/, ""),
    output: () => output,
    async stop() {
      demo.kill("SIGINT");
      await ended;
    },
  };
}

/** A console besides the demonstration's; `address`: what of its output is its address. */
async function startConsole(sets, address) {
  const config = process.env.FATHOM_SOURCE + "/deploy/config/console.json";
  const words = Object.entries({"bus.domain": kDomain, ...sets}).flatMap(([name, value]) => [
    "--set",
    `${name}=${value}`,
  ]);
  const service = spawn(kBin + "/fathom-console", ["--config", config, ...words], {
    stdio: ["ignore", "ignore", "pipe"],
  });
  let output = "";
  service.stderr.on("data", (bytes) => (output += bytes));
  const ended = new Promise((resolve) => service.on("exit", resolve));
  return {
    address: await until("the console's address", () => output.match(address)?.[1]),
    output: () => output,
    async stop() {
      service.kill("SIGTERM");
      await ended;
    },
  };
}

/** The console of a vehicle of which nothing is ever heard. */
export const startEmptyConsole = (port) =>
  startConsole({"http.port": port, vehicle: "nobody"}, /console at (http:\S+\/),/);

/** A second console of the same vehicle that speaks https with a certificate of its own; `address` is its page. */
export async function startTlsConsole(port) {
  const folder = mkdtempSync(tmpdir() + "/fathom-tls-");
  const [certificate, key, tokens] = ["console.pem", "console.key", "tokens.json"].map((name) => `${folder}/${name}`);
  const curve = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "90", "-subj", "/CN=fathom"];
  const names = ["-addext", "subjectAltName=IP:127.0.0.1"];
  execFileSync("openssl", ["req", "-x509", ...curve, ...names, "-keyout", key, "-out", certificate], {stdio: "pipe"});
  const token = "operator-0123456789";
  writeFileSync(tokens, JSON.stringify({tokens: [{name: "bridge", role: "operator", token}]}), {mode: 0o600});
  const console = await startConsole(
    {
      "http.port": port,
      "tls.certificate_file": certificate,
      "tls.key_file": key,
      "access.orders": true,
      "access.token_file": tokens,
    },
    /console at (https:\S+\/),/,
  );
  return {
    address: `${console.address}#token=${token}`,
    output: console.output,
    async stop() {
      await console.stop();
      rmSync(folder, {recursive: true});
    },
  };
}

/** What `fathom status --json` says. */
export const ddsStatus = () =>
  new Promise((resolve, reject) => {
    execFile(kBin + "/fathom", ["status", "--json", "--domain", kDomain, "--timeout", "60"], (error, out) => {
      try {
        resolve(JSON.parse(out));
      } catch {
        reject(error ?? new Error("no JSON: " + out));
      }
    });
  });

/** A browser whose pages' complaints are collected. */
export async function startBrowser() {
  const browser = await chromium.launch({
    executablePath: process.env.FATHOM_CHROMIUM,
    timeout: kPatienceMs,
    args: ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
  });
  const complaints = [];
  const stage = {
    complaints,
    connectionMayFail: false,
    /** A page in a browser profile of its own. */
    async open(address, options = {}) {
      const context = await browser.newContext({
        viewport: {width: 1280, height: 720},
        colorScheme: "light",
        ...options,
      });
      context.setDefaultTimeout(kPatienceMs);
      const page = await context.newPage();
      const complain = (text) => {
        // A console that is not there is complained about by the browser itself, whatever the page does.
        if (!(stage.connectionMayFail && /net::ERR_|Failed to (load|fetch)/.test(text))) complaints.push(text);
      };
      page.on("console", (message) => ["error", "warning"].includes(message.type()) && complain(message.text()));
      page.on("pageerror", (error) => complain(String(error.stack)));
      await page.goto(address, {timeout: kPatienceMs});
      // On a machine that stands still for seconds a browser may give up a file of the page; a person reloads then.
      for (let tries = 0; tries < 3; ++tries) {
        if (await page.waitForSelector("#link.live", {timeout: kPatienceMs / 4}).then(() => true, () => false)) break;
        await page.reload({timeout: kPatienceMs});
      }
      await page.waitForSelector("#link.live");
      await until("the first data on the page", () =>
        page.evaluate(async () => (await import("/js/store.js")).store.tick !== null),
      );
      return page;
    },
    close: () => browser.close(),
  };
  return stage;
}

export const field = (page, name) => page.textContent(`[data-field="${name}"]`);
export const sentence = (page) => page.textContent("#sentence");
export const view = (page, name) => page.click(`[data-view="${name}"]`);

/** Serious findings of axe-core, as one text each. */
export async function findings(page) {
  await page.evaluate(axeSource);
  const result = await page.evaluate(() => globalThis.axe.run());
  return result.violations
    .filter((one) => ["serious", "critical"].includes(one.impact))
    .map(
      (one) =>
        `${one.id}: ${one.help}: ${one.nodes
          .map((node) => node.html.slice(0, 160))
          .slice(0, 3)
          .join(" | ")}`,
    );
}
