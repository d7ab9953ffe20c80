// uPlot with what an operator needs: linked cursors, zoom, pan, pause, CSV, PNG, and the theme's colours.
import {el} from "./dom.js";
import {colour, onPrefs} from "./prefs.js";

const linked = uPlot.sync("fathom");
const plots = new Set();
let spanS = 180;
let paused = false;

export const isPaused = () => paused;
export function setPaused(value) {
  paused = value;
  for (const button of document.querySelectorAll("[data-pause]")) {
    button.setAttribute("aria-pressed", String(paused));
    button.textContent = paused ? "Go on" : "Pause";
  }
  if (!paused) for (const plot of plots) plot.follow();
}
export function setSpan(seconds) {
  spanS = seconds;
  for (const plot of plots) plot.follow();
}

const kDashes = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 5], [1, 4]];

function save(name, blob) {
  const link = el("a", {href: URL.createObjectURL(blob), download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** `series`: [{label, colour: "s1", dash: 0, points}], without the time. `read()`: [seconds[], ...values[]]. */
export class Plot {
  constructor(box, {name, unit = () => "", series, read, log = false}) {
    Object.assign(this, {name, unit, series, read, log, live: true, window: null});
    this.host = el("div", {class: "plot", role: "img", "aria-label": "Plot: " + name});
    const tool = (text, title, act) =>
      el("button", {type: "button", title: `${title}: ${name}`, "aria-label": `${title}: ${name}`, onclick: act}, text);
    this.bar = el(
      "div",
      {class: "plotbar push"},
      tool("−", "Zoom out", () => this.zoom(2)),
      tool("+", "Zoom in", () => this.zoom(0.5)),
      tool("◀", "Earlier", () => this.pan(-0.5)),
      tool("▶", "Later", () => this.pan(0.5)),
      tool("Live", "Back to live", () => this.follow()),
      tool("CSV", "Save as CSV", () => this.csv()),
      tool("PNG", "Save as PNG", () => this.png()),
    );
    box.querySelector(".head").append(this.bar);
    box.append(this.host);
    plots.add(this);
    new ResizeObserver(() => this.resize()).observe(this.host);
    onPrefs(() => this.rebuild());
  }

  options() {
    const ink = colour("soft");
    const axis = {
      stroke: ink,
      grid: {stroke: colour("grid"), width: 1},
      ticks: {stroke: colour("grid")},
      font: "12px system-ui",
      labelFont: "12px system-ui",
    };
    return {
      width: Math.max(200, this.host.clientWidth),
      height: Math.max(90, this.host.clientHeight - 24),
      tzDate: (t) => uPlot.tzDate(new Date(t * 1000), "Etc/UTC"),
      cursor: {sync: {key: linked.key}, drag: {x: true, y: false, setScale: true}},
      scales: {
        x: {time: true},
        y: this.log
          ? {distr: 3, range: (u, low, high) => [Math.min(low ?? 0.01, 0.01) / 2, Math.max(high ?? 1, 1) * 3]}
          : {range: (u, low, high) => uPlot.rangeNum(low ?? 0, high ?? 1, 0.1, true)},
      },
      axes: [
        {
          ...axis,
          size: 28,
          space: 75,
          values: (u, splits) => splits.map((t) => new Date(t * 1000).toISOString().slice(11, 19)),
        },
        {...axis, size: 62, label: this.unit(), labelSize: 16, labelGap: 0},
      ],
      series: [
        {value: (u, t) => (t === null || t === undefined ? "–" : new Date(t * 1000).toISOString().slice(11, 21))},
        ...this.series.map((one, i) => ({
          label: one.label,
          class: one.quiet ? "quiet" : undefined,
          stroke: colour(one.colour),
          width: one.width ?? 1.6,
          dash: kDashes[one.dash ?? i % kDashes.length],
          spanGaps: false,
          points: {show: one.points ?? false, size: 5},
          paths: one.points === true ? () => null : undefined,
          value: (u, v) => (v === null || v === undefined ? "–" : Number(v.toPrecision(4)).toString()),
        })),
      ],
      hooks: {
        setSelect: [
          (u) => {
            if (u.select.width > 2) this.live = false;
          },
        ],
      },
    };
  }

  rebuild() {
    this.drawn?.destroy();
    this.drawn = null;
    this.update(true);
  }
  setSeries(series) {
    this.series = series;
    this.rebuild();
  }
  resize() {
    if (this.drawn && this.host.clientWidth > 0)
      this.drawn.setSize({
        width: Math.max(200, this.host.clientWidth),
        height: Math.max(90, this.host.clientHeight - 24),
      });
  }
  visible() {
    return this.host.offsetParent !== null && this.host.clientWidth > 0;
  }
  /** Called by its view, some times a second. A plot in pause or unseen costs nothing. */
  update(force = false) {
    if (!this.visible() || (paused && !force && this.drawn)) return;
    const data = this.read();
    if (!this.drawn) this.drawn = new uPlot(this.options(), data, this.host);
    else this.drawn.setData(data, false);
    const newest = data[0][data[0].length - 1] ?? Date.now() / 1000;
    if (this.live) this.drawn.setScale("x", {min: newest - spanS, max: newest});
    else this.drawn.redraw();
  }
  follow() {
    this.live = true;
    this.update(true);
  }
  scale(min, max) {
    this.live = false;
    this.drawn?.setScale("x", {min, max});
  }
  zoom(factor) {
    if (!this.drawn) return;
    const {min, max} = this.drawn.scales.x;
    const half = ((max - min) * factor) / 2;
    this.scale((min + max) / 2 - half, (min + max) / 2 + half);
  }
  pan(share) {
    if (!this.drawn) return;
    const {min, max} = this.drawn.scales.x;
    this.scale(min + share * (max - min), max + share * (max - min));
  }
  csv() {
    const data = this.drawn?.data ?? this.read();
    const lines = [["utc", ...this.series.map((one) => `"${one.label} ${this.unit()}"`)].join(",")];
    for (let i = 0; i < data[0].length; ++i) {
      lines.push(
        [new Date(data[0][i] * 1000).toISOString(), ...data.slice(1).map((column) => column[i] ?? "")].join(","),
      );
    }
    save(this.name.replace(/\W+/g, "_") + ".csv", new Blob([lines.join("\n") + "\n"], {type: "text/csv"}));
  }
  png() {
    if (!this.drawn) return;
    const from = this.drawn.ctx.canvas;
    const canvas = el("canvas", {width: String(from.width), height: String(from.height + 24)});
    const context = canvas.getContext("2d");
    context.fillStyle = colour("card");
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.fillStyle = colour("ink");
    context.font = "14px system-ui";
    context.fillText(`${this.name} [${this.unit()}]: ${this.series.map((one) => one.label).join(", ")}`, 8, 16);
    context.drawImage(from, 0, 24);
    canvas.toBlob((blob) => save(this.name.replace(/\W+/g, "_") + ".png", blob));
  }
}

/** The buttons above a view's plots. */
export function plotControls(hint = true) {
  const span = el(
    "select",
    {"aria-label": "Time shown", onchange: () => setSpan(Number(span.value))},
    ...[
      [60, "1 min"],
      [180, "3 min"],
      [600, "10 min"],
    ].map(([value, text]) => el("option", {value, selected: value === spanS}, text)),
  );
  return el(
    "div",
    {class: "plotbar"},
    el(
      "button",
      {
        type: "button",
        "data-pause": "",
        "aria-pressed": "false",
        title: "Pause (p)",
        onclick: () => setPaused(!paused),
      },
      "Pause",
    ),
    span,
    hint ? el("span", {class: "soft"}, "drag across a plot to zoom; cursors are linked") : null,
  );
}
