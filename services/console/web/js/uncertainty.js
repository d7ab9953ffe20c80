// How certain the position was, is, and will be: the 95 % radius of the last minutes, and the forecast with its limit.
import {el, put} from "./dom.js";
import {colour, onPrefs} from "./prefs.js";
import {store} from "./store.js";
import * as units from "./units.js";

const kPastMin = 10;
const kFutureMin = 30; // what lies further ahead is said in words
const kEveryMs = 1000;
const kStride = 5; // rows of the history

const horizontal = (forecast, without) =>
  forecast
    .filter((one) => one.without === without && one.name.startsWith("horizontal"))
    .sort((a, b) => a.limit - b.limit);

/** The limit that is passed next, else the one passed last; undefined without a forecast. */
export function nextLimit(forecast) {
  const own = horizontal(forecast, "").filter(isKnown);
  return own.find((one) => !isPassed(one)) ?? own.at(-1);
}

const isKnown = (one) => one.never || Number.isFinite(one.time_to_limit_s);
export const isPassed = (one) => !one.never && one.time_to_limit_s <= 0;

/** When. */
export function limitWords(one) {
  if (one.never) return "not reached";
  return isPassed(one) ? "✖ passed" : `in ${units.duration(one.time_to_limit_s)}`;
}

export class UncertaintyPlot {
  constructor() {
    this.host = el("div", {
      class: "curve",
      role: "img",
      "aria-label": "95 % radius of the last minutes and its forecast",
    });
    this.none = el("p", {class: "soft none"}, "Nothing to draw yet");
    this.note = el("p", {class: "soft num note", "data-field": "forecast"});
    this.host.append(this.none);
    this.last = 0;
    onPrefs(() => this.clear());
    new ResizeObserver(() => this.clear()).observe(this.host);
  }
  clear() {
    this.plot?.destroy();
    this.plot = null;
    this.last = 0;
  }
  show({utc_ms, status: {forecast, navigation}}) {
    if (performance.now() - this.last < kEveryMs) return;
    this.last = performance.now();
    const own = horizontal(forecast, "").filter(isKnown);
    const text = own.map((one) => `${units.length(one.limit, 0)} ${limitWords(one)}`).join(", ");
    put(this.note, own.every((one) => one.never) ? "" : "Passes " + text);
    const past = this.past(utc_ms);
    const now = navigation?.horizontal_95_m;
    const ahead = (list) => {
      const known = list
        .filter((one) => Number.isFinite(one.time_to_limit_s) && one.time_to_limit_s > 0)
        .map((one) => [one.time_to_limit_s / 60, units.toLength(one.limit)]);
      known.sort((a, b) => a[0] - b[0]);
      return known.length > 0 && now > 0 ? [[0, units.toLength(now)], ...known] : [];
    };
    const next = nextLimit(forecast);
    this.none.hidden = past.length > 1;
    this.draw(past, ahead(own), ahead(horizontal(forecast, "all")), next ? units.toLength(next.limit) : null);
  }
  past(utc_ms) {
    const times = store.nav.column("t");
    const values = store.nav.column("h95_m");
    const out = [];
    for (let i = times.length - 1; i >= 0; i -= kStride) {
      const minutes = (times[i] - utc_ms) / 60000;
      if (minutes >= -kPastMin && values[i] > 0) out.push([minutes, units.toLength(values[i])]);
    }
    return out.reverse();
  }
  draw(past, own, all, limit) {
    if (past.length < 2) return this.clear();
    if (this.host.clientWidth === 0 || this.host.clientHeight === 0) return;
    const known = [...past, ...own, ...all];
    const first = Math.min(0, ...known.map(([t]) => t));
    const last = Math.min(kFutureMin, Math.max(first + 0.5, ...known.map(([t]) => t)));
    const edge =
      limit === null
        ? []
        : [
            [first, limit],
            [last, limit],
          ];
    const at = [...new Set([...known, ...edge].map(([t]) => t))].sort((a, b) => a - b);
    const column = (points) => {
      const values = new Map(points);
      return at.map((t) => values.get(t));
    };
    this.range = [first, last];
    const data = [at, column(past), column(own), column(all), column(edge)];
    if (this.plot) this.plot.setData(data);
    else this.plot = new uPlot(this.options(), data, this.host);
  }
  options() {
    const axis = {
      stroke: colour("soft"),
      grid: {stroke: colour("grid"), width: 1},
      ticks: {stroke: colour("grid"), size: 4},
      font: "11px system-ui",
    };
    const series = (ink, width, dash) => ({stroke: colour(ink), width, dash, spanGaps: true, points: {show: false}});
    const minutes = (t) => (t === 0 ? "now" : `${t > 0 ? "+" : "−"}${Math.abs(Math.round(t * 10) / 10)} min`);
    return {
      width: this.host.clientWidth,
      height: this.host.clientHeight,
      padding: [6, 14, 0, 0],
      scales: {
        x: {time: false, range: () => this.range},
        y: {distr: 3, range: (u, low, high) => [(low ?? 0.1) / 1.3, (high ?? 1) * 1.3]},
      },
      cursor: {show: false},
      legend: {show: false},
      axes: [
        {...axis, size: 22, gap: 2, space: 64, values: (u, splits) => splits.map(minutes)},
        {
          ...axis,
          size: 52,
          gap: 3,
          space: 22,
          values: (u, splits) =>
            splits.map((value) => (value === null ? null : `${Number(value.toPrecision(2))} ${units.lengthUnit()}`)),
        },
      ],
      series: [{}, series("s1", 2, []), series("s2", 2, [7, 4]), series("s4", 2, [2, 3]), series("bad", 1.5, [12, 4])],
    };
  }
}
