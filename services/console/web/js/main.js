// Puts the page together: views, the live stream, the trust line by the page's own clock as well as by the service's.
import {el, put} from "./dom.js";
import {makeFilter} from "./filter.js";
import {help} from "./help.js";
import {openLink} from "./link.js";
import {makeMapPanel} from "./map/panel.js";
import {makeMap} from "./map_view.js";
import {makeNetwork} from "./network.js";
import {loadSession, notice, onSession, signIn, takeTokenFromAddress, token} from "./orders.js";
import {makeOverview} from "./overview.js";
import {isPaused, setPaused} from "./plot.js";
import {onPrefs, prefs, setPref, theme, toggleTheme} from "./prefs.js";
import {makeSensors} from "./sensors.js";
import {store, takeSnapshot, takeTick} from "./store.js";
import * as units from "./units.js";

const kSilentMs = 800; // no message from the console for this long is no navigation
const kLooks = {good: ["✔", "GOOD"], caution: ["▲", "CAUTION"], bad: ["✖", "NO TRUST"]};
const get = (id) => document.getElementById(id);
const panel = makeMapPanel();
const views = [makeOverview(panel), makeMap(panel), makeSensors(), makeFilter(), makeNetwork()];
let current = null;

function show(index) {
  current = views[index];
  current.drawnAt = 0;
  current.drawnTick = -1;
  views.forEach((view, i) => {
    view.root.hidden = view !== current;
    view.tab.toggleAttribute("data-on", view === current);
    if (view === current) view.tab.setAttribute("aria-current", "page");
    else view.tab.removeAttribute("aria-current");
    if (view === current) history.replaceState(null, "", "#" + views[i].key);
  });
  current.shown?.();
  draw();
}

function draw() {
  if (!current || !store.tick) return;
  const now = performance.now();
  if (now - (current.drawnAt ?? 0) < current.everyMs - 20 || current.drawnTick === store.tickNumber) return;
  current.drawnAt = now;
  current.drawnTick = store.tickNumber;
  current.update(store.tick);
}

function trust(level, sentence, advice, word) {
  const box = get("trust");
  const [mark, usual] = kLooks[level];
  if (box.dataset.level !== level) box.className = "trust " + level;
  box.dataset.level = level;
  put(box.querySelector(".mark"), mark);
  put(box.querySelector(".word"), word ?? usual);
  put(get("sentence"), sentence);
  put(get("advice"), advice);
}

let refused = ""; // why the console lets this page see nothing; empty: it does not refuse

/** By this page's clock: a console that is gone, or that stands still, must not leave an old answer standing. */
function judge() {
  const silentMs = store.tick ? performance.now() - store.tickAt : Infinity;
  const root = document.documentElement;
  let lost = false;
  if (refused && silentMs > kSilentMs) {
    trust("bad", "No navigation: the console refuses this page", refused, "NO DATA");
    lost = true;
  } else if (!store.tick) {
    trust(
      "bad",
      "No navigation: the console has not answered yet",
      "Is the console's service running, and the cable in?",
      "NO DATA",
    );
    lost = true;
  } else if (silentMs > kSilentMs) {
    trust(
      "bad",
      `No navigation: the console has been silent for ${units.duration(silentMs / 1000)}`,
      "What is shown below is old.",
      "NO DATA",
    );
    lost = true;
  } else {
    const {level, sentence, advice} = store.tick.trust;
    lost = sentence.startsWith("No navigation:");
    trust(level, sentence, advice, sentence.startsWith("No navigation") ? "NO NAVIGATION" : undefined);
  }
  const navigation = lost ? "none" : "there";
  if (root.dataset.navigation !== navigation) {
    root.dataset.navigation = navigation;
    if (lost) root.dataset.losses = String(Number(root.dataset.losses ?? 0) + 1);
    root.dataset.since = String(Date.now());
    root.dataset.stamp = String(Date.parse(store.tick?.status.navigation?.stamp_utc ?? 0));
  }
}

function buttons() {
  put(get("theme"), theme() === "night" ? "Day" : "Night");
  put(get("units"), `${prefs.length} · ${prefs.angle} · ${prefs.speed}`);
}
function nextUnits() {
  const imperial = prefs.length === "ft";
  setPref("length", imperial ? "m" : "ft");
  setPref("angle", imperial ? "deg" : "dms");
  setPref("speed", imperial ? "m/s" : "kn");
}
function who() {
  const {role, name, orders, vehicle} = store.session;
  put(get("who"), role === "nobody" ? "Sign in" : `${name} (${role})`);
  get("who").title =
    role === "nobody"
      ? "Sign in with a token"
      : orders
        ? "Sign out"
        : "Orders are switched off in this console; sign out";
  put(get("vehicle"), vehicle || "fathom");
  document.title = `${vehicle} – fathom console`;
}

function keys(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select, dialog, textarea")) return;
  const number = Number(event.key);
  if (number >= 1 && number <= views.length) show(number - 1);
  else if (event.key === "?") help();
  else if (event.key === "t") toggleTheme();
  else if (event.key === "u") nextUnits();
  else if (event.key === "p" || (event.key === " " && !event.target.closest("button"))) setPaused(!isPaused());
  else if (current.keys?.[event.key]) current.keys[event.key]();
  else return;
  event.preventDefault();
}

views.forEach((view, i) => {
  view.tab = el(
    "button",
    {type: "button", title: `${view.name} (${i + 1})`, "data-view": view.key, onclick: () => show(i)},
    `${i + 1} ${view.name}`,
  );
  get("tabs").append(view.tab);
  get("main").append(view.root);
});
takeTokenFromAddress();
onPrefs(buttons);
onSession(who);
buttons();
get("theme").addEventListener("click", toggleTheme);
get("units").addEventListener("click", nextUnits);
get("help").addEventListener("click", help);
document.addEventListener("keydown", keys);

const link = openLink(token, {
  snapshot: takeSnapshot,
  tick(event) {
    if (!takeTick(event)) return;
    put(get("clock"), units.clockText(event.utc_ms) + " UTC");
    judge();
    draw();
  },
  state(word, reason) {
    const box = get("link");
    box.classList.toggle("live", word === "live");
    put(box, word);
    box.title = reason;
    refused = word === "refused" ? reason : "";
    if (word === "live" && store.session.vehicle === "") loadSession();
  },
});
get("who").addEventListener("click", async () => {
  if (await signIn()) link.again();
});
setInterval(() => {
  judge();
  draw(); // events that came in one heap are drawn up to the last of them
}, 100);
show(
  Math.max(
    0,
    views.findIndex((view) => "#" + view.key === location.hash),
  ),
);
loadSession();
window.addEventListener("error", (event) => notice(`The page has a fault: ${event.message}`, false));
