// The operator console as an operator meets it. Each step says what it saw; the first that fails ends the run.
import {existsSync, readFileSync, statSync} from "node:fs";
import {fixCanBeChanged, fixIsTwoClicks, viewerHasNoFix} from "./fix.mjs";
import {kMayBeEmpty, overviewFits} from "./layout.mjs";
import {
  check,
  ddsStatus,
  field,
  findings,
  kShots,
  sentence,
  startBrowser,
  startDemo,
  startEmptyConsole,
  startTlsConsole,
  until,
  view,
} from "./stage.mjs";

const kViews = ["overview", "map", "sensors", "filter", "network"];
const store = (page, read) => page.evaluate(`import("/js/store.js").then(({store}) => (${read})(store))`);
const said = (text) => console.log(`${new Date().toISOString().slice(11, 19)} ${text}`);

/** The navigation that the page holds, at an instant between two of its rows. */
function between({t, lat, lon, depth, yaw}, at) {
  const i = t.findIndex((time) => time >= at);
  if (i <= 0) return null;
  const share = (at - t[i - 1]) / (t[i] - t[i - 1]);
  const turn = ((yaw[i] - yaw[i - 1] + 540) % 360) - 180;
  const mix = (values) => values[i - 1] + share * (values[i] - values[i - 1]);
  return {lat: mix(lat), lon: mix(lon), depth: mix(depth), yaw: yaw[i - 1] + share * turn};
}

async function valuesEqualDds(page) {
  await until(
    "a position",
    async () =>
      (await field(page, "lat")) !== "–" && (await store(page, "(s) => s.tick.status.navigation.mode")) === "gps_aided",
  );
  // A fix may move the state between two rows of the page, so that what lies between them is not on a line: asked again.
  const difference = await until("the page to hold what DDS gave", async () => {
    const dds = (await ddsStatus()).navigation;
    const at = Date.parse(dds.stamp_utc);
    const shown = await until("rows around that instant", async () =>
      between(
        await store(
          page,
          `(s) => ({t: s.nav.columns[0], lat: s.nav.column("lat_deg"), lon: s.nav.column("lon_deg"),
            depth: s.nav.column("depth_m"), yaw: s.nav.column("yaw_deg")})`,
        ),
        at,
      ),
    );
    const off = {
      lat: Math.abs(shown.lat - dds.lat_deg),
      lon: Math.abs(shown.lon - dds.lon_deg),
      depth: Math.abs(shown.depth - dds.depth_m),
      yaw: Math.abs(((shown.yaw - dds.rpy_deg[2] + 540) % 360) - 180),
    };
    if (off.lat < 2e-6 && off.lon < 2e-6 && off.depth < 0.2 && off.yaw < 1) return off;
    throw new Error(`off by ${JSON.stringify(off)}`);
  });
  // What stands on the screen is what the newest event says, to its last digit.
  await until("the newest event on the screen", () =>
    page.evaluate(async () => {
      const {store} = await import("/js/store.js");
      const shown = (name) => parseFloat(document.querySelector(`[data-field="${name}"]`).textContent);
      const {lat_deg, depth_m, horizontal_95_m, rpy_deg} = store.tick.status.navigation;
      const off = (name, value, digit) => Math.abs(shown(name) - value) <= 0.51 * digit;
      const same = [off("lat", lat_deg, 1e-6), off("depth", depth_m, 0.1)];
      return [...same, off("h95", horizontal_95_m, 0.01), off("roll", rpy_deg[0], 0.1)].every(Boolean);
    }),
  );
  const [lat, lon] = [difference.lat, difference.lon].map((value) => value.toExponential(1));
  said(`values: latitude differs from DDS by ${lat} deg, longitude by ${lon} deg`);
}

/** Before there is anything to show: a sentence in the map, and the same layout. */
async function nothingIsKnown(stage) {
  const empty = await startEmptyConsole(18498);
  try {
    const page = await stage.open(empty.address);
    await until("the map to say so", async () => /^No position yet/.test(await field(page, "place")));
    check(await page.isVisible('[data-field="place"]'), "the sentence is seen");
    const words = await page.locator('[data-field="place"]').boundingBox();
    const map = await page.locator(".mapbox").boundingBox();
    check(
      words.x >= map.x && words.x + words.width <= map.x + map.width && words.y >= map.y,
      "the sentence lies in the map",
    );
    await overviewFits(page, "nothing", kMayBeEmpty);
    said(`nothing known: "${await field(page, "place")}"`);
    await page.context().close();
  } finally {
    await empty.stop();
  }
}

async function outageAppears(pages) {
  for (const page of pages) {
    await until("the GPS outage", async () => /GPS gone/.test(await sentence(page)));
    await until("the outage clock to run", async () => /\d/.test(await field(page, "outage")));
    await page.waitForSelector('[data-alarm="gps_outage"]');
  }
  said(`outage: "${await sentence(pages[0])}"`);
}

async function acknowledged(one, other) {
  const button = '[data-alarm="gps_outage"] button';
  await one.click(button);
  await until("the acknowledgement in the other browser", async () => {
    const shown = await other.$(button);
    return !shown || !(await shown.isVisible());
  });
  said("an alarm acknowledged in one browser needs no acknowledgement in the other");
}

async function outageClears(pages) {
  for (const page of pages) {
    await until(
      "the end of the GPS outage",
      async () => (await field(page, "outage")) === "✔ fix" && !/GPS gone/.test(await sentence(page)),
      600000,
    );
    // An alarm that grew worse after it was acknowledged asks once more, and stays until somebody has seen that, too.
    await until("the alarm to leave", async () => {
      const again = await pages[0].$('[data-alarm="gps_outage"] button:not([hidden])');
      await again?.click({timeout: 1000}).catch(() => {});
      return (await page.$('[data-alarm="gps_outage"]')) === null;
    });
  }
  said(`outage over: "${await sentence(pages[0])}"`);
}

async function looksRight(page) {
  for (const _ of [0, 1]) {
    for (const name of kViews) {
      await view(page, name);
      await until("the view to be drawn", () =>
        page.evaluate(
          (key) => document.querySelector(`.view:not([hidden])`)?.className.includes(key),
          name === "map" ? "mapview" : name,
        ),
      );
      if (name === "filter" || name === "sensors") await page.waitForSelector(".view:not([hidden]) .uplot");
      const before = await store(page, "(s) => s.tickNumber");
      await until("an update of every part", () => store(page, `(s) => s.tickNumber > ${before} + 12`));
      const theme = await page.evaluate(() => document.documentElement.dataset.theme);
      await page.waitForSelector("#notices p", {state: "detached"}); // the answer to an order lies over the corner
      await page.screenshot({path: `${kShots}/${name}-${theme}.png`});
      const found = await findings(page);
      check(found.length === 0, `${name} by ${theme}: ${found.join("\n")}`);
    }
    await page.keyboard.press("t");
  }
  for (const name of kViews)
    for (const theme of ["day", "night"]) {
      check(
        existsSync(`${kShots}/${name}-${theme}.png`) && statSync(`${kShots}/${name}-${theme}.png`).size > 5000,
        `a picture of ${name} by ${theme}`,
      );
    }
  said("ten pictures, no serious finding of axe-core");
}

async function tabletFits(stage, address) {
  const page = await stage.open(address, {viewport: {width: 820, height: 1180}, colorScheme: "dark"});
  check(
    (await page.evaluate(() => document.documentElement.dataset.theme)) === "night",
    "the system's preference is followed",
  );
  for (const name of kViews) {
    await view(page, name);
    const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    check(over <= 0, `${name} is ${over} pixels wider than a tablet`);
  }
  await view(page, "overview");
  await page.screenshot({path: `${kShots}/tablet-night.png`});
  await page.context().close();
}

async function toolsWork(page) {
  await view(page, "filter");
  await page.waitForSelector(".view:not([hidden]) .uplot");
  const saved = async (label) => {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.click(`button[aria-label="${label}: sigma of position"]`),
    ]);
    return readFileSync(await download.path());
  };
  const csv = (await saved("Save as CSV")).toString();
  check(csv.startsWith("utc,") && csv.split("\n").length > 20, "a CSV file with rows");
  check((await saved("Save as PNG")).subarray(1, 4).toString() === "PNG", "a PNG file");
  await page.keyboard.press("p");
  check((await page.getAttribute(".view:not([hidden]) [data-pause]", "aria-pressed")) === "true", "p pauses");
  await page.keyboard.press("p");
  await page.keyboard.press("1");
  check(await page.isVisible(".view.overview"), "1 is the overview");
  await page.keyboard.press("u");
  await until(
    "feet",
    async () =>
      (await field(page, "h95")).endsWith("ft") &&
      (await field(page, "lat")).includes("′") &&
      (await field(page, "speed")).endsWith("kn"),
  );
  await page.keyboard.press("u");
  await page.keyboard.press("?");
  await page.waitForSelector("dialog[open]");
  await page.keyboard.press("Escape");
  await page.waitForSelector("dialog", {state: "detached"});
  await page.keyboard.press("2");
  await page.waitForSelector("#map canvas");
  const box = await (await page.$("#map")).boundingBox();
  await page.click("text=Measure");
  await page.mouse.click(box.x + 200, box.y + 200);
  await page.mouse.click(box.x + 300, box.y + 200);
  await until("a distance", async () => /\d m at 0?90\.0°/.test(await field(page, "distance")));
  check(/°/.test(await field(page, "pointer")), "coordinates under the pointer");
  await page.click("text=Measure");
  await page.keyboard.press("1");
  said("CSV, PNG, pause, keys, units, distance and pointer work");
}

async function routeIsShown(page) {
  await view(page, "map");
  const line = '[data-route="guidance_example_client"]';
  await until("the route of guidance", async () => /to waypoint \d of 4 · \d\.\d s old/.test(await page.textContent(line)));
  const route = await store(page, "(s) => s.routes[0]");
  const drawn = await page.evaluate(async (one) => {
    const {shapeOf} = await import("/js/routes.js");
    return shapeOf(one).legs.filter(({state}) => state === "active").length;
  }, route);
  check(drawn === 1, "one leg that is steered");
  said(`route: "${await page.textContent(line)}"`);
  await view(page, "overview");
}

async function worksOverTls(stage) {
  const secure = await startTlsConsole(18499);
  try {
    const page = await stage.open(secure.address, {ignoreHTTPSErrors: true});
    check(page.url().startsWith("https://") && !page.url().includes("token"), "https, and no token in the address");
    await navigates(page);
    await until("the role of the token", () => store(page, '(s) => s.session.role === "operator"'));
    await view(page, "overview");
    await page.evaluate(async () => (await import("/js/orders.js")).order({kind: "acknowledge_alarm", target: "*"}));
    await until("the order in the log", () => /passed on an order of bridge \(operator\)/.test(secure.output()));
    said(`https: "${await sentence(page)}", and an order was taken`);
    await page.context().close();
  } finally {
    await secure.stop();
  }
}

async function sourceIsSwitched(page) {
  await view(page, "sensors");
  const row = '[data-source="usbl"] button:text("Disable …")';
  await page.click(".view:not([hidden]) " + row);
  await page.click('dialog[open] button:text("Disable")');
  await until("the source to be disabled", () =>
    store(page, '(s) => s.tick.sources.find((one) => one.sensor === "usbl")?.last === "source_disabled"'),
  );
  await page.click('.view:not([hidden]) [data-source="usbl"] button:text("Enable …")');
  await page.click('dialog[open] button:text("Enable")');
  await until("the source to be enabled again", () =>
    store(page, '(s) => s.tick.sources.find((one) => one.sensor === "usbl")?.last !== "source_disabled"'),
  );
  await view(page, "overview");
  said("a source is disabled and enabled again, each after a confirmation");
}

async function farPositionIsHeld(page) {
  const nav = await store(page, "(s) => s.tick.status.navigation");
  const resets = nav.reset_counter;
  await page.click('button:text("Set position …")');
  await page.fill('dialog[open] input[name="lat_deg"]', String(nav.lat_deg + 1));
  await page.fill('dialog[open] input[name="sigma_m"]', "1");
  await page.click('dialog[open] button:text("Set position")');
  const question = await page.waitForSelector('dialog[open] h2:text("Confirm the position")');
  const text = await page.textContent("dialog[open] p");
  check(/^This position lies 11\d{4} m from where navigation is/.test(text), `the distance: ${text}`);
  check((await question.isVisible()) && resets === (await store(page, "(s) => s.tick.status.navigation.reset_counter")), "held");
  await page.click('dialog[open] button:text("Cancel")');
  await until("an alarm that says who ordered it", () =>
    store(page, '(s) => s.tick.status.alarms?.some((one) => one.alarm === "position_order_held" && /^console:/.test(one.text))'),
  );
  await page.evaluate(async () => (await import("/js/orders.js")).order({kind: "acknowledge_alarm", target: "position_order_held"}));
  said(`a position far away: "${text}"`);
}

async function manyClients(stage, address) {
  stage.connectionMayFail = true;
  const pages = await Promise.all(Array.from({length: 10}, () => stage.open(address)));
  stage.connectionMayFail = false;
  for (const page of pages) {
    const first = await store(page, "(s) => s.tickNumber");
    await until("events on each of ten pages", async () => (await store(page, "(s) => s.tickNumber")) > first + 5);
    check(
      (await page.getAttribute(".view:not([hidden]) .alarms button", "disabled")) !== null,
      "who has no token cannot order",
    );
  }
  await Promise.all(pages.map((page) => page.context().close()));
  said("ten browsers at the same time are served");
}

/** How often this page has said "no navigation". */
const losses = (page) => page.evaluate(() => Number(document.documentElement.dataset.losses ?? 0));
const navigates = (page) =>
  until("navigation", async () => (await page.getAttribute("html", "data-navigation")) === "there");

async function killFusion(page) {
  await navigates(page);
  const pid = await store(page, '(s) => s.tick.status.services.find((one) => one.name === "fusion").pid');
  const before = await losses(page);
  process.kill(pid, "SIGKILL");
  await until("no navigation", async () => (await losses(page)) > before);
  const {since, stamp} = await page.evaluate(() => ({...document.documentElement.dataset}));
  await until("the map to say that its position is an old one", async () =>
    /^Last known position/.test(await field(page, "place")),
  );
  said(`kill -9 of fusion: "${await sentence(page)}", shown ${since - stamp} ms after the last state`);
  await until("a new process", () =>
    store(page, `(s) => s.tick.status.services.find((one) => one.name === "fusion").pid !== ${pid}`),
  );
  await navigates(page);
  await until("a position on the map again", async () => !(await page.isVisible('[data-field="place"]')));
  await until("the restart to be counted", () =>
    store(page, '(s) => s.services.find((one) => one.name === "fusion").restarts >= 1'),
  );
  said(`fusion is back: "${await sentence(page)}"`);
}

async function killConsole(stage, pages) {
  stage.connectionMayFail = true;
  const pid = await store(pages[0], '(s) => s.tick.status.services.find((one) => one.name === "console").pid');
  const before = await Promise.all(pages.map(losses));
  process.kill(pid, "SIGKILL");
  for (const [i, page] of pages.entries())
    await until("the page to notice", async () => (await losses(page)) > before[i]);
  const dds = await ddsStatus();
  check(dds.services.find((one) => one.name === "fusion") !== undefined, "navigation goes on without its console");
  for (const page of pages) {
    await until("a new console on the page", () =>
      store(page, `(s) => s.tick.status.services.find((one) => one.name === "console").pid !== ${pid}`),
    );
    await until("the page to be connected again", async () =>
      (await page.getAttribute("#link", "class")).includes("live"),
    );
    await navigates(page);
    await until("the position on the map again", async () => !(await page.isVisible('[data-field="place"]')));
  }
  stage.connectionMayFail = false;
  said("the console was killed; the pages said so and came back with it");
}

const demo = await startDemo();
let stage = null;
let code = 0;
try {
  stage = await startBrowser();
  const [page, other] = [await stage.open(demo.address), await stage.open(demo.address)];
  check(!page.url().includes("token"), "the token does not stay in the address");
  await valuesEqualDds(page);
  await overviewFits(page, "gps");
  await outageAppears([page, other]);
  await overviewFits(page, "outage");
  await acknowledged(page, other);
  await looksRight(page);
  await view(page, "overview");
  await tabletFits(stage, demo.plain);
  await toolsWork(page);
  await outageClears([page, other]);
  await routeIsShown(page);
  await sourceIsSwitched(page);
  said(`a fix by two clicks: ${await fixIsTwoClicks(page)}`);
  await fixCanBeChanged(page);
  await viewerHasNoFix(stage, demo.plain);
  said("a fix can be changed before it is sent; those who may only look have none");
  await farPositionIsHeld(page);
  await nothingIsKnown(stage);
  await worksOverTls(stage);
  await manyClients(stage, demo.plain);
  await killFusion(page);
  await killConsole(stage, [page, other]);
  check(stage.complaints.length === 0, "no complaints of the browser:\n" + stage.complaints.join("\n"));
  said("no error or warning in any browser's console");
} catch (error) {
  console.error(error);
  console.error("complaints of the browser:", stage?.complaints);
  console.error("--- the last lines of the demonstration:\n" + demo.output().split("\n").slice(-30).join("\n"));
  code = 1;
} finally {
  await stage?.close();
  await demo.stop();
}
process.exit(code);
