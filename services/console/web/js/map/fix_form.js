// A position that somebody tells: where the vehicle was, how well that is known, and when it was there. A click on the map
// opens the form with all of it filled in, and a second one sends it. Nothing is sent by the first.
import {el, put, verdictLook} from "../dom.js";
import {order} from "../orders.js";
import {store} from "../store.js";
import * as units from "../units.js";

const kDigits = 7; // a centimetre
const kShownMs = 20000; // how long the answer stays
const kPatienceMs = 5000; // navigation judges a fix within its horizon
const kSame = {deg: 1e-6, ms: 30000}; // its time is that of its arrival less its age

/** `changed()`: the place or its sigma is another one. */
export function makeFixForm(changed) {
  let opened = null; // {at: performance.now() of the click, text: the vehicle's time of it in words}
  let told = null; // the fix that was sent: {lat, lng, ms, at: performance.now()}
  let sigma = "20"; // kept: who told one fix well tells the next one as well
  const input = (name, properties) => {
    const node = el("input", {name, required: true, autocomplete: "off", ...properties});
    node.addEventListener("input", refresh);
    return node;
  };
  const number = {type: "number", step: "any"};
  const lat = input("lat_deg", {...number, min: -90, max: 90});
  const lon = input("lon_deg", {...number, min: -180, max: 180});
  const sigmaBox = input("sigma_m", {...number, min: 0.01, max: 100000});
  const time = input("seen", {
    type: "text",
    pattern: "[0-2]?\\d:[0-5]\\d:[0-5]\\d",
    title: "UTC, as 09:05:00",
    inputmode: "numeric",
  });
  const ago = el("p", {class: "soft num"});
  const send = el("button", {class: "primary", "data-act": "send"}, "Send fix");
  const row = (label, box) => el("label", {}, el("span", {}, label), box);
  const root = el(
    "form",
    {class: "fixform", "aria-label": "Fix by hand", hidden: true},
    el("strong", {}, "Where the vehicle was"),
    row("Latitude [°]", lat),
    row("Longitude [°]", lon),
    row("1 sigma [m]", sigmaBox),
    row("Seen [UTC]", time),
    ago,
    el("div", {class: "row"}, el("button", {type: "button", onclick: close}, "Cancel"), send),
  );
  root.addEventListener("submit", (event) => {
    event.preventDefault();
    tell();
  });
  const verdict = el("p", {class: "overlay verdict", "data-field": "fix_verdict", role: "status", hidden: true});

  /** Seconds since the time in the box; exact where nobody has changed it. */
  const age = () =>
    time.value === opened.text
      ? (performance.now() - opened.at) / 1000
      : units.secondsSince(time.value, store.tick.utc_ms);

  function refresh() {
    if (!opened) return;
    const seconds = age();
    time.setCustomValidity(seconds === null ? "A time of the last two hours, as 09:05:00" : "");
    put(ago, seconds === null ? "✖ no time of the last two hours" : `${units.duration(seconds)} ago`);
    ago.className = seconds === null ? "bad-text num" : "soft num";
    changed();
  }

  /** `aside`: the place lies in the right half, and the form must not cover it. */
  function open(at, aside = false) {
    if (!store.tick) return;
    root.classList.toggle("aside", aside);
    opened = {at: performance.now(), text: units.clockText(store.tick.utc_ms)};
    lat.value = at ? at.lat.toFixed(kDigits) : "";
    lon.value = at ? at.lng.toFixed(kDigits) : "";
    sigmaBox.value = sigma;
    time.value = opened.text;
    root.hidden = false;
    if (!at) lat.focus();
    refresh();
  }
  function close() {
    opened = null;
    root.hidden = true;
    changed();
  }

  async function tell() {
    refresh();
    if (!root.reportValidity()) return;
    const content = {
      kind: "fix",
      lat_deg: Number(lat.value),
      lon_deg: Number(lon.value),
      sigma_m: Number(sigmaBox.value),
      age_s: age(),
    };
    const ms = store.tick.utc_ms - 1000 * content.age_s;
    send.disabled = true;
    const taken = await order(content);
    send.disabled = false;
    if (!taken) return; // the console said why; what was filled in stays
    sigma = sigmaBox.value;
    told = {lat: content.lat_deg, lng: content.lon_deg, ms, at: performance.now()};
    close();
    update();
  }

  const isTold = (fix) =>
    fix.source === "fix" &&
    Math.abs(fix.lat - told.lat) < kSame.deg &&
    Math.abs(fix.lon - told.lng) < kSame.deg &&
    Math.abs(fix.t - told.ms) < kSame.ms;

  function update() {
    if (opened) refresh();
    verdict.hidden = !told || performance.now() - told.at > kShownMs;
    if (verdict.hidden) return;
    const found = store.fixes.findLast(isTold);
    const kind = found && found.verdict !== null ? store.kinds[found.verdict] : null;
    const late = found || performance.now() - told.at > kPatienceMs;
    const [words, look] = kind
      ? verdictLook(kind)
      : late
        ? ["○ not judged by navigation", "caution-text"]
        : ["… sent", "soft"];
    put(verdict, `Fix of ${units.clockText(told.ms)} UTC: ${words}`);
    verdict.className = "overlay verdict " + look;
  }

  return {
    root,
    verdict,
    open,
    close,
    update,
    isOpen: () => opened !== null,
    /** Nothing while there is no such place. */
    candidate() {
      const place = {lat_deg: lat.valueAsNumber, lon_deg: lon.valueAsNumber, sigma_m: sigmaBox.valueAsNumber};
      return opened && Number.isFinite(place.lat_deg) && Number.isFinite(place.lon_deg) ? place : null;
    },
  };
}
