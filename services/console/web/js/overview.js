// What one looks at for hours: the map, and around it what says whether to believe it.
import {makeAlarms} from "./alarms.js";
import {isAligned, makeAlignment, phaseWords} from "./alignment.js";
import {makeAttitude} from "./attitude.js";
import {card, el, put} from "./dom.js";
import {ask, mayOrder, onSession, order} from "./orders.js";
import {store} from "./store.js";
import {makeStrip} from "./strip.js";
import {isPassed, limitWords, nextLimit, UncertaintyPlot} from "./uncertainty.js";
import * as units from "./units.js";

/** Values with their names above them; scripts find each by data-field. */
function readouts(kind, fields, into) {
  const list = el("dl", {class: "readouts " + kind});
  for (const [name, label] of fields) {
    into[name] = el("dd", {"data-field": name}, "–");
    list.append(el("div", {}, el("dt", {}, label), into[name]));
  }
  return list;
}

const kMapMs = 180; // the map is drawn five times a second

export function makeOverview(panel) {
  const f = {};
  let mapAt = 0;
  const state = el(
    "section",
    {class: "card state", "aria-label": "State"},
    readouts(
      "three",
      [
        ["mode", "Mode"],
        ["phase", "Alignment"],
        ["rate", "Navigation"],
      ],
      f,
    ),
  );
  const setPosition = el("button", {type: "button", class: "push", onclick: orderPosition}, "Set position …");
  const realign = el("button", {type: "button", onclick: orderRealign}, "Realign …");
  const reach = el("progress", {max: 1, value: 0, "aria-label": "95 % radius as a share of its next limit"});
  const place = card(
    "place",
    "Position",
    [setPosition, realign],
    readouts(
      "two",
      [
        ["lat", "Latitude"],
        ["lon", "Longitude"],
      ],
      f,
    ),
    readouts(
      "three",
      [
        ["h95", "95 % horizontal"],
        ["v95", "95 % vertical"],
        ["limit", "Limit"],
      ],
      f,
    ),
    reach,
  );
  const limitLabel = f.limit.previousElementSibling;
  const attitude = makeAttitude();
  const numbers = [
    ["heading", "Heading"],
    ["course", "Course"],
    ["speed", "Speed"],
    ["roll", "Roll"],
    ["pitch", "Pitch"],
    ["yaw_sigma", "Heading ±1σ"],
    ["depth", "Depth"],
    ["bottom", "Above bottom"],
    ["alt", "Altitude"],
  ];
  const current = readouts("inline", [["current", "Current"]], f);
  const motion = el(
    "section",
    {class: "card motion", "aria-label": "Motion"},
    el("div", {class: "with"}, attitude.root, readouts("three", numbers, f)),
    current,
  );
  const clock = el("span", {class: "big num", "data-field": "outage"}, "–");
  const clockNote = el("span", {class: "num", "data-field": "outage_note"});
  const totals = el("span", {class: "soft num totals"});
  const curve = new UncertaintyPlot();
  const key = (ink, mark, words) =>
    el("span", {}, el("span", {class: "ink-" + ink, "aria-hidden": "true"}, mark), " " + words);
  const gps = card(
    "gps",
    "GPS",
    [clock, clockNote, totals],
    curve.note,
    curve.host,
    el(
      "p",
      {class: "keys soft"},
      key("s1", "━", "95 % so far"),
      key("s2", "╍", "as things are"),
      key("s4", "┅", "without aiding"),
      key("bad", "━ ━", "limit"),
    ),
  );
  const alarms = makeAlarms();
  const alignment = makeAlignment();
  const strip = makeStrip();
  const side = el(
    "div",
    {class: "side", tabindex: 0, role: "group", "aria-label": "State and position"},
    state,
    place,
    motion,
    alignment.root,
    gps,
  );
  const root = el("div", {class: "view overview"}, alarms.root, strip.root, side);

  function allowed() {
    for (const button of [setPosition, realign]) {
      button.disabled = !mayOrder();
      button.title = mayOrder() ? "" : "Needs the role operator";
    }
  }
  onSession(allowed);
  allowed();

  function showState(nav, alignment) {
    put(f.mode, units.words(nav.mode ?? "none"));
    put(f.phase, phaseWords(alignment));
    f.phase.className = isAligned(alignment) ? "good-text" : "caution-text";
    const rate = Number.isFinite(nav.rate_hz) ? `${nav.rate_hz.toFixed(0)} Hz` : "–";
    put(f.rate, Number.isFinite(nav.age_s) ? `${rate} · ${units.duration(nav.age_s)}` : "not heard");
    f.rate.title = "States a second, and the age of the newest";
  }

  function showPlace(nav, forecast) {
    put(f.lat, units.latitude(nav.lat_deg));
    put(f.lon, units.longitude(nav.lon_deg));
    put(f.h95, units.length(nav.horizontal_95_m, 2));
    put(f.v95, units.length(nav.vertical_95_m, 2));
    const next = nextLimit(forecast);
    const ahead = next && !next.never && !isPassed(next);
    put(limitLabel, next ? `${ahead ? "Passes" : "Limit"} ${units.length(next.limit, 0)}` : "Limit");
    put(f.limit, next ? limitWords(next) : "no forecast");
    f.limit.className = ahead ? "caution-text" : next && !next.never ? "bad-text" : "";
    const share = next && nav.horizontal_95_m > 0 ? Math.min(1, nav.horizontal_95_m / next.limit) : 0;
    if (reach.value !== share) reach.value = share;
  }

  function showMotion(nav, states) {
    const [north, east, down] = nav.velocity_N_m_s ?? [];
    const [roll, pitch, yaw] = nav.rpy_deg ?? [];
    const moves = [north, east, down].every(Number.isFinite);
    const course =
      moves && Math.hypot(north, east) > 0.05 ? units.bearing((Math.atan2(east, north) * 180) / Math.PI) : "–";
    put(f.heading, units.bearing(yaw));
    put(f.course, course);
    put(f.speed, moves ? units.speed(Math.hypot(north, east, down)) : "–");
    put(f.roll, units.degrees(roll));
    put(f.pitch, units.degrees(pitch));
    put(f.yaw_sigma, units.degrees(nav.rpy_sigma_deg?.[2], 2));
    put(f.depth, units.length(nav.depth_m));
    put(f.bottom, units.length(nav.altitude_above_bottom_m));
    put(f.alt, units.length(nav.alt_m));
    const of = Object.fromEntries(states.map(([name, value]) => [name, value]));
    const drift = Math.hypot(of.current_north_m_s, of.current_east_m_s);
    const set = (Math.atan2(of.current_east_m_s, of.current_north_m_s) * 180) / Math.PI;
    const doubt = units.fixed(units.toSpeed(Math.max(...states.map(([, , sigma]) => sigma))), 2);
    put(
      f.current,
      Number.isFinite(drift) ? `${units.speed(drift)} ± ${doubt} to ${units.bearing(set)}` : "not estimated",
    );
    attitude.show(roll, pitch, yaw);
  }

  function showGps(tick) {
    const gps = tick.status.gps;
    const never = !gps || gps.outage_s === null;
    put(clock, !gps ? "no monitor" : never ? "no fix yet" : gps.outage ? units.duration(gps.outage_s) : "✔ fix");
    const look = never
      ? "caution-text"
      : !gps.outage
        ? "good-text"
        : gps.severity === "notice"
          ? "caution-text"
          : "bad-text";
    clock.className = "big num " + look;
    put(clockNote, !never && gps.outage ? `▲ without GPS, ${gps.severity}` : "");
    const count = gps ? `${gps.count} outage${gps.count === 1 ? "" : "s"}` : "";
    put(
      totals,
      !gps
        ? ""
        : gps.count === 0
          ? count
          : `${count}, longest ${units.duration(gps.longest_s)}, in all ${units.duration(gps.total_s)}`,
    );
    curve.show(tick);
  }

  return {
    root,
    name: "Overview",
    key: "overview",
    everyMs: 100,
    shown: () => panel.showIn(root),
    keys: {f: panel.follow},
    update(tick) {
      const {status} = tick;
      const nav = status.navigation ?? {};
      root.classList.toggle("aligning", Boolean(status.alignment) && !isAligned(status.alignment));
      showState(nav, status.alignment);
      showPlace(nav, status.forecast);
      showMotion(nav, tick.current);
      alignment.update(status.alignment);
      showGps(tick);
      alarms.update(tick);
      strip.update(tick);
      if (performance.now() - mapAt < kMapMs) return;
      mapAt = performance.now();
      panel.update();
    },
  };
}

async function orderPosition() {
  const nav = store.tick?.status.navigation ?? {};
  const values = await ask(
    "Set position",
    "Navigation starts anew from this position. The vehicle must really be there.",
    "Set position",
    [
      ["Latitude [deg]", "lat_deg", nav.lat_deg],
      ["Longitude [deg]", "lon_deg", nav.lon_deg],
      ["Depth [m]", "depth_m", nav.depth_m],
      ["1 sigma [m]", "sigma_m", 10],
    ],
  );
  if (values) order({kind: "set_position", ...values});
}

async function orderRealign() {
  if (await ask("Realign", "Attitude is found again from the start. There is no navigation until it is.", "Realign"))
    order({kind: "realign"});
}
