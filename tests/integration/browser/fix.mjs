// A fix by hand on the overview: two clicks of an operator, none of anybody else.
import {execFileSync, spawn} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {check, field, kBin, kDomain, until, view} from "./stage.mjs";

const kRecordS = "900"; // the recorder ends by itself where a test ends before it
const kProbeSigmaM = 50000; // of a fix that only finds out whether the recorder listens: it tells navigation nothing

/** Seconds from what a fix tells of to its arrival: a table without a time of arrival says that every row came at its own. */
const ageOf = ({t_s, t_received_s = t_s}) => t_received_s - t_s;

/** Records the fixes on the vehicle network; stop() gives their rows. */
async function recordFixes(page) {
  const folder = mkdtempSync(tmpdir() + "/fathom-fixes-");
  const file = folder + "/fixes.mcap";
  const recorder = spawn(
    kBin + "/fathom",
    ["record", "--topic", "fix", "--duration", kRecordS, "--domain", kDomain, "--out", file],
    {
      stdio: ["ignore", "pipe", "pipe"],
    },
  );
  let output = "";
  for (const stream of [recorder.stdout, recorder.stderr]) stream.on("data", (bytes) => (output += bytes));
  const ended = new Promise((resolve) => recorder.on("exit", resolve));
  await until("the recorder to hear the console", async () => {
    await page.evaluate(async (sigma_m) => {
      const [{store}, {order}] = await Promise.all([import("/js/store.js"), import("/js/orders.js")]);
      const {lat_deg, lon_deg} = store.tick.status.navigation;
      await order({kind: "fix", lat_deg, lon_deg, sigma_m});
    }, kProbeSigmaM);
    return output.includes("recording to");
  });
  return {
    async stop() {
      recorder.kill("SIGINT");
      await ended;
      execFileSync(kBin + "/fathom", ["export", file, "--format", "csv", "--out", folder + "/csv"], {stdio: "pipe"});
      const [head, ...rows] = readFileSync(folder + "/csv/fix.csv", "utf8")
        .trim()
        .split("\n");
      rmSync(folder, {recursive: true});
      const names = head.split(",");
      const named = rows.map((row) => Object.fromEntries(row.split(",").map((value, i) => [names[i], Number(value)])));
      return named.filter((fix) => fix.sigma_m !== kProbeSigmaM);
    },
  };
}

/** In the page: pixels of the map, some way off the vehicle. */
async function mapPoint(page, right, down) {
  const {x, y, width, height} = await page.locator(".view:not([hidden]) #map").boundingBox();
  return [x + right * width, y + down * height];
}

export async function fixIsTwoClicks(page) {
  await view(page, "overview");
  const recording = await recordFixes(page);
  const point = await mapPoint(page, 0.3, 0.6);
  await page.mouse.move(...point);
  await until("the place under the pointer", async () => /°/.test(await field(page, "pointer")));
  await page.mouse.click(...point); // the first
  const form = page.locator(".fixform");
  await form.waitFor();
  const [lat, lon, sigma] = await Promise.all(
    ["lat_deg", "lon_deg", "sigma_m"].map(async (name) => Number(await form.locator(`[name="${name}"]`).inputValue())),
  );
  check(/^\d\d:\d\d:\d\d$/.test(await form.locator('[name="seen"]').inputValue()), "the time is filled in");
  const fixes = await page.evaluate(async () => (await import("/js/store.js")).store.fixes);
  check(!fixes.some(({source, sigma}) => source === "fix" && sigma !== kProbeSigmaM), "the first click sends nothing");
  await page.click('.fixform button:text("Send fix")'); // the second
  await until("the verdict on the map", async () => /: (✔ used|✖ rejected)$/.test(await field(page, "fix_verdict")));
  check(await page.isVisible('[data-field="fix_verdict"]'), "the verdict is seen");
  check(!(await form.isVisible()), "the form is gone");
  const told = await recording.stop();
  check(told.length === 1, `one fix on the network: ${JSON.stringify(told)}`);
  const off = [told[0].lat_deg - lat, told[0].lon_deg - lon].map(Math.abs);
  check(
    Math.max(...off) < 1e-7 && told[0].sigma_m === sigma,
    `the fix on the network is that of the form: ${JSON.stringify(told)}`,
  );
  const age = ageOf(told[0]);
  check(age >= 0 && age < 240, `its time is that of the click, ${age} s before`);
  return `${await field(page, "fix_verdict")}; on the network ${age.toFixed(1)} s after the click`;
}

/** What was filled in can be changed between the clicks, and nothing goes out without the second one. */
export async function fixCanBeChanged(page) {
  const recording = await recordFixes(page);
  await page.mouse.click(...(await mapPoint(page, 0.7, 0.5)));
  const form = page.locator(".fixform");
  await form.waitFor();
  const [box, click] = [await form.boundingBox(), await mapPoint(page, 0.7, 0.5)];
  check(box.x + box.width < click[0], "the form does not cover the place");
  await page.keyboard.press("Tab");
  await form.locator('[name="sigma_m"]').fill("35");
  await form.locator('[name="seen"]').fill("25:00:00");
  await page.click('.fixform button:text("Send fix")');
  check(await form.isVisible(), "a time that is none is not sent");
  const minuteAgo = await page.evaluate(async () => {
    const {store} = await import("/js/store.js");
    return new Date(store.tick.utc_ms - 60000).toISOString().slice(11, 19);
  });
  await form.locator('[name="seen"]').fill(minuteAgo);
  await page.click('.fixform button:text("Send fix")');
  await form.waitFor({state: "hidden"});
  await page.mouse.click(...(await mapPoint(page, 0.4, 0.4)));
  await form.waitFor();
  check((await form.locator('[name="sigma_m"]').inputValue()) === "35", "the sigma of last time");
  await page.click('.fixform button:text("Cancel")');
  await form.waitFor({state: "hidden"});
  const told = await recording.stop();
  check(told.length === 1, `one fix on the network: ${JSON.stringify(told)}`);
  const age = ageOf(told[0]);
  check(told[0].sigma_m === 35 && age > 58 && age < 300, `as it was changed: ${JSON.stringify(told)}`);
}

export async function viewerHasNoFix(stage, address) {
  const page = await stage.open(address);
  await view(page, "overview");
  await until("a map", () => page.isVisible(".view:not([hidden]) #map"));
  check(await page.isVisible('button:text("Measure")'), "the other tools of the map");
  check(!(await page.isVisible('button:text("Fix …")')), "no button for a fix");
  for (const button of ["left", "right"]) await page.mouse.click(...(await mapPoint(page, 0.3, 0.6)), {button});
  const before = await page.evaluate(async () => (await import("/js/store.js")).store.tickNumber);
  await until("the map to be drawn again", () =>
    page.evaluate(async (n) => (await import("/js/store.js")).store.tickNumber > n + 5, before),
  );
  check(!(await page.isVisible(".fixform")), "a click on the map tells nothing");
  await page.context().close();
}
