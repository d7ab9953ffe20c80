// What one reads first: numbers, alarms, alignment, the GPS clock, and when each source was last used.
import {makeAttitude} from "./attitude.js";
import {card, el, field, put, reconcile, scroller, tableOf, verdictLook} from "./dom.js";
import {ForecastCurve} from "./forecast.js";
import {tellFix} from "./fix.js";
import {ask, mayOrder, onSession, order} from "./orders.js";
import {store} from "./store.js";
import * as units from "./units.js";

const kMarks = {critical: "✖ critical", warning: "▲ warning", notice: "● notice"};
const kLooks = {critical: "bad-text", warning: "caution-text", notice: "soft"};

export function makeOverview() {
  const numbers = el("dl", {class: "numbers"});
  const f = {};
  for (const [name, label] of [
    ["lat", "Latitude"],
    ["lon", "Longitude"],
    ["h95", "95 % horizontal"],
    ["v95", "95 % vertical"],
    ["depth", "Depth"],
    ["alt", "Altitude"],
    ["bottom", "Above bottom"],
    ["speed", "Speed"],
    ["course", "Course"],
    ["current", "Current"],
  ])
    f[name] = field(numbers, label, name);
  const attitude = makeAttitude();
  const angles = el("dl", {class: "numbers"});
  for (const [name, label] of [
    ["heading", "Heading"],
    ["roll", "Roll"],
    ["pitch", "Pitch"],
    ["yaw_sigma", "Heading ±1σ"],
    ["mode", "Mode"],
    ["rate", "Rate"],
    ["age", "Age"],
  ])
    f[name] = field(angles, label, name);
  const setPosition = el("button", {type: "button", onclick: orderPosition}, "Set position …");
  const fix = el("button", {type: "button", onclick: orderFix}, "Fix …");
  const realign = el("button", {type: "button", onclick: orderRealign}, "Realign …");
  const place = card(
    "place",
    "Position",
    [],
    scroller("Position", numbers),
    el("div", {class: "actions"}, fix, setPosition, realign),
  );
  const motion = card("motioncard", "Attitude", [], el("div", {class: "motion"}, attitude.root, angles));

  const list = el("div", {class: "scroll", "data-field": "alarms", tabindex: 0, role: "group", "aria-label": "Alarms"});
  const all = el(
    "button",
    {type: "button", class: "push", onclick: () => order({kind: "acknowledge_alarm", target: "*"})},
    "Acknowledge all",
  );
  const alarms = card("alarms", "Alarms", [all], list);

  const clock = el("span", {class: "big", "data-field": "outage"}, "–");
  const clockNote = el("span", {"data-field": "outage_note"});
  const totals = el("span", {class: "soft num"});
  const curve = new ForecastCurve();
  const gps = card(
    "gps",
    "GPS outage and forecast",
    [],
    el("div", {class: "outage"}, clock, clockNote, totals),
    curve.root,
  );

  const phase = el("strong", {"data-field": "phase"}, "–");
  const conditions = el("div", {class: "conditions"});
  const advice = el("p", {class: "soft"});
  const alignment = card("alignment", "Alignment", [], scroller("Alignment", el("p", {}, phase), conditions, advice));
  const ages = el("tbody");
  const sources = card(
    "sources",
    "Sources",
    [],
    scroller("Sources", tableOf(["Source", "Last verdict", "Used#", "Rate#"], ages)),
  );
  const root = el("div", {class: "view overview"}, place, gps, alarms, motion, alignment, sources);

  function allowed() {
    for (const button of [fix, setPosition, realign, all]) {
      button.disabled = !mayOrder();
      button.title = mayOrder() ? "" : "Needs the role operator";
    }
  }
  onSession(allowed);
  allowed();

  function showNumbers(tick) {
    const nav = tick.status.navigation ?? {};
    const [north, east, down] = nav.velocity_N_m_s ?? [];
    const [roll, pitch, yaw] = nav.rpy_deg ?? [];
    const course = Math.hypot(north, east) > 0.05 ? units.bearing((Math.atan2(east, north) * 180) / Math.PI) : "–";
    const current = Object.fromEntries(tick.current.map(([name, value]) => [name, value]));
    const drift = Math.hypot(current.current_north_m_s, current.current_east_m_s);
    const set = (Math.atan2(current.current_east_m_s, current.current_north_m_s) * 180) / Math.PI;
    put(f.lat, units.latitude(nav.lat_deg));
    put(f.lon, units.longitude(nav.lon_deg));
    put(f.h95, units.length(nav.horizontal_95_m, 2));
    put(f.v95, units.length(nav.vertical_95_m, 2));
    put(f.depth, units.length(nav.depth_m));
    put(f.alt, units.length(nav.alt_m));
    put(f.bottom, units.length(nav.altitude_above_bottom_m));
    put(f.speed, units.speed(Math.hypot(north, east, down)));
    put(f.course, course);
    const doubt = Math.max(...tick.current.map(([, , sigma]) => sigma));
    put(
      f.current,
      Number.isFinite(drift)
        ? `${units.speed(drift)} ± ${units.fixed(units.toSpeed(doubt), 2)} to ${units.bearing(set)}`
        : "not estimated",
    );
    put(f.heading, units.bearing(yaw));
    put(f.roll, units.degrees(roll));
    put(f.pitch, units.degrees(pitch));
    put(f.yaw_sigma, units.degrees(nav.rpy_sigma_deg?.[2], 2));
    put(f.mode, units.words(nav.mode ?? "none"));
    put(f.rate, nav.rate_hz === null || nav.rate_hz === undefined ? "–" : `${nav.rate_hz.toFixed(0)} Hz`);
    put(f.age, units.duration(nav.age_s));
    attitude.show(roll, pitch, yaw);
  }

  function showAlarms(tick) {
    const present = tick.status.alarms;
    all.hidden = !present.some((alarm) => !alarm.acknowledged);
    if (present.length === 0) {
      if (list.firstChild?.dataset?.key !== "none")
        list.replaceChildren(el("p", {class: "good-text", "data-key": "none"}, "✔ No alarm"));
      return;
    }
    reconcile(list, present, (alarm) => alarm.alarm, makeAlarm, updateAlarm);
  }

  function showGps(tick) {
    const gps = tick.status.gps;
    if (!gps) put(clock, "no monitor");
    else if (gps.outage_s === null) put(clock, "no fix yet");
    else put(clock, gps.outage ? units.duration(gps.outage_s) : "✔ fix");
    clock.className =
      "big " +
      (!gps || gps.outage_s === null
        ? "caution-text"
        : !gps.outage
          ? "good-text"
          : gps.severity === "notice"
            ? "caution-text"
            : "bad-text");
    put(clockNote, gps?.outage ? `▲ without GPS, ${gps.severity}` : "");
    put(
      totals,
      gps
        ? `${gps.count} outage${gps.count === 1 ? "" : "s"}, longest ${units.duration(gps.longest_s)}, in all ${units.duration(gps.total_s)}`
        : "",
    );
    curve.show(tick.status.forecast, tick.status.navigation?.horizontal_95_m);
  }

  function showAlignment(tick) {
    const status = tick.status.alignment;
    put(
      phase,
      status
        ? `${status.phase === "aligned" ? "✔" : "▲"} ${units.words(status.phase)} for ${units.duration(status.in_phase_s)}` +
            (status.time_to_aligned_s > 0 ? `, done in about ${units.duration(status.time_to_aligned_s)}` : "")
        : "not heard",
    );
    phase.className = status?.phase === "aligned" ? "good-text" : "caution-text";
    put(advice, status?.advice ?? "");
    reconcile(conditions, status?.conditions ?? [], (one) => one.name, makeCondition, updateCondition);
  }

  function showSources(tick) {
    const rates = new Map(tick.status.sensors.map((sensor) => [sensor.name, sensor]));
    reconcile(
      ages,
      tick.sources,
      (line) => line.sensor,
      (line) =>
        el(
          "tr",
          {"data-source": line.sensor},
          el("td", {}, line.sensor),
          el("td"),
          el("td", {class: "n"}),
          el("td", {class: "n"}),
        ),
      (row, line) => {
        const [, verdict, used, rate] = row.children;
        const [text, look] = verdictLook(line.last, line.kind);
        put(verdict, text);
        verdict.className = look;
        put(used, line.kind === "imu" ? "–" : line.since_used_s === null ? "never" : units.duration(line.since_used_s));
        const heard = rates.get(line.sensor)?.rate_hz;
        put(rate, Number.isFinite(heard) ? `${heard.toFixed(1)} Hz` : "–");
      },
    );
  }

  return {
    root,
    name: "Overview",
    key: "overview",
    everyMs: 100,
    update(tick) {
      showNumbers(tick);
      showAlarms(tick);
      showGps(tick);
      showAlignment(tick);
      showSources(tick);
    },
  };
}

function makeAlarm(alarm) {
  return el(
    "div",
    {class: "alarm", "data-alarm": alarm.alarm},
    el("span", {class: "severity"}),
    el("div", {}, el("p"), el("p", {class: "kind"})),
    el(
      "button",
      {
        type: "button",
        "aria-label": "Acknowledge " + alarm.alarm,
        onclick: () => order({kind: "acknowledge_alarm", target: alarm.alarm}),
      },
      "Acknowledge",
    ),
  );
}

function updateAlarm(node, alarm) {
  const [severity, what, button] = node.children;
  node.classList.toggle("over", !alarm.active);
  put(severity, alarm.active ? kMarks[alarm.severity] : "○ over");
  severity.className = "severity " + (alarm.active ? kLooks[alarm.severity] : "soft");
  put(what.children[0], alarm.text);
  put(
    what.children[1],
    `${alarm.alarm} · since ${alarm.since_utc?.slice(11, 19) ?? "–"}` + (alarm.acknowledged ? " · seen" : ""),
  );
  button.hidden = alarm.acknowledged;
  button.disabled = !mayOrder();
}

function makeCondition() {
  return el("div", {class: "condition"}, el("span"), el("span"), el("progress", {max: 1}), el("small", {class: "soft"}));
}

function updateCondition(node, one) {
  const {group, name, unit, scale} = units.stateName(one.name);
  const label = group === name ? group : `${group} ${name}`;
  const [state, text, bar, help] = node.children;
  put(state, one.met ? "✔ met" : "… waiting");
  state.className = one.met ? "good-text" : "caution-text";
  const shown = unit === "‰" ? ["", 1] : [unit, scale];
  const limit = one.limit === null ? "" : ` of ${units.fixed(one.limit * shown[1], 2)}`;
  put(text, `${label} ${units.fixed(one.value * shown[1], 2)}${limit} ${shown[0]}`);
  bar.setAttribute("aria-label", label);
  put(help, one.help ?? "");
  bar.value = one.needed_s > 0 ? Math.min(1, one.held_s / one.needed_s) : one.met ? 1 : 0;
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

function orderFix() {
  const nav = store.tick?.status.navigation ?? {};
  tellFix(nav.lat_deg ?? 0, nav.lon_deg ?? 0);
}

async function orderRealign() {
  if (await ask("Realign", "Attitude is found again from the start. There is no navigation until it is.", "Realign"))
    order({kind: "realign"});
}
