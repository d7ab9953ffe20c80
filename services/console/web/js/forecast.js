// The forecast as a curve: when the 95 % radius will pass each limit, and what it is now.
import {el, put} from "./dom.js";
import {colour, onPrefs} from "./prefs.js";
import * as units from "./units.js";

export class ForecastCurve {
  constructor() {
    this.host = el("div", {class: "curve", role: "img", "aria-label": "Forecast of the 95 % radius"});
    this.note = el("div", {class: "soft num", "data-field": "forecast"});
    this.root = el("div", {}, this.note, this.host);
    this.root.style.display = "contents";
    this.last = 0;
    onPrefs(() => this.clear());
    new ResizeObserver(() => this.clear()).observe(this.host);
  }
  clear() {
    this.plot?.destroy();
    this.plot = null;
    this.last = 0;
  }
  show(limits, now) {
    if (performance.now() - this.last < 1000) return;
    this.last = performance.now();
    const own = limits.filter((one) => one.without === "" && one.name.startsWith("horizontal"));
    const all = limits.filter((one) => one.without === "all" && one.name.startsWith("horizontal"));
    const text = own
      .map(
        (one) =>
          `${units.length(one.limit, 0)} ` +
          (one.never
            ? "never as things are"
            : one.time_to_limit_s > 0
              ? `in ${units.duration(one.time_to_limit_s)}`
              : "passed"),
      )
      .join(", ");
    put(
      this.note,
      own.length === 0
        ? "No forecast"
        : own.every((one) => one.never)
          ? "No limit is passed as things are"
          : "Passes " + text,
    );
    const points = (list) => {
      const known = list
        .filter((one) => Number.isFinite(one.time_to_limit_s) && one.time_to_limit_s > 0)
        .map((one) => [one.time_to_limit_s / 60, one.limit]);
      known.sort((a, b) => a[0] - b[0]);
      return known.length > 0 && Number.isFinite(now) ? [[0, now], ...known] : [];
    };
    this.draw(points(own), points(all));
  }
  draw(own, all) {
    const at = [...new Set([...own, ...all].map((point) => point[0]))].sort((a, b) => a - b);
    const values = (points) =>
      at.map((t) => {
        const found = points.find((point) => point[0] === t);
        return found ? units.toLength(found[1]) : undefined;
      });
    const data =
      at.length > 0
        ? [at, values(own), values(all)]
        : [
            [0, 1],
            [null, null],
            [null, null],
          ];
    if (this.host.clientWidth === 0) return;
    if (this.plot) {
      this.plot.setData(data);
      return;
    }
    const axis = {
      stroke: colour("soft"),
      grid: {stroke: colour("grid"), width: 1},
      font: "11px system-ui",
      labelFont: "11px system-ui",
    };
    const series = (label, stroke, dash) => ({
      label,
      stroke,
      dash,
      width: 2,
      spanGaps: true,
      points: {show: true, size: 6, fill: stroke},
    });
    this.plot = new uPlot(
      {
        width: this.host.clientWidth,
        height: Math.max(80, this.host.clientHeight - 22),
        scales: {x: {time: false}, y: {distr: 3}},
        cursor: {show: false},
        legend: {live: false},
        axes: [
          {...axis, size: 34, label: "minutes from now", labelSize: 14, labelGap: 0},
          {...axis, size: 50, label: `95 % [${units.lengthUnit()}]`, labelSize: 14, labelGap: 0},
        ],
        series: [
          {},
          series("as things are", colour("s2"), []),
          series("if all aiding were lost", colour("s4"), [4, 4]),
        ],
      },
      data,
      this.host,
    );
  }
}
