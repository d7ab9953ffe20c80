// Each source: how it is, what fusion makes of it, and the switch.
import {card, el, put, reconcile, scroller, tableOf, verdictLook} from "./dom.js";
import {ask, mayOrder, order} from "./orders.js";
import {Plot, plotControls} from "./plot.js";
import {store} from "./store.js";
import * as units from "./units.js";

const kHead = [
  "Source",
  "Kind",
  "Presence",
  "Rate#",
  "Latency#",
  "Last used#",
  "Last verdict",
  "Used#",
  "Not used#",
  "Test ratio#",
  "Switch",
];
const kPresence = {
  present: ["✔", "good-text"],
  stale: ["▲", "caution-text"],
  missing: ["✖", "bad-text"],
  never_seen: ["○", "soft"],
};

export function makeSensors() {
  let chosen = null;
  const rows = el("tbody");
  const table = tableOf(kHead, rows);
  const plotCard = card("", "Test ratio", [plotControls(false)]);
  const title = plotCard.querySelector("h2");
  const plot = new Plot(plotCard, {
    name: "test ratio",
    unit: () => "limit 1",
    log: true,
    series: [
      {label: "used", colour: "s3", dash: 0, points: true},
      {label: "not used", colour: "s2", dash: 0, points: true},
      {label: "limit", colour: "bad", dash: 1},
    ],
    read: readRatios,
  });
  const reasons = el("tbody");
  const last = el("tbody");
  const side = card(
    "",
    "Verdicts",
    [],
    scroller(
      "Verdicts",
      tableOf(["Reason", "Count#"], reasons),
      tableOf(["UTC", "Model", "Verdict", "Ratio#"], last),
    ),
  );
  const root = el(
    "div",
    {class: "view sensors"},
    card("", "Sources", [], scroller("Sources", table)),
    el("div", {class: "below"}, plotCard, side),
  );

  const seriesOf = (sensor) => [...store.series.values()].filter((one) => one.sensor === sensor);

  function readRatios() {
    const points = [];
    for (const {table: verdicts} of seriesOf(chosen)) {
      for (let i = 0; i < verdicts.length; ++i)
        points.push([verdicts.columns[0][i] / 1000, verdicts.columns[1][i], verdicts.columns[2][i]]);
    }
    points.sort((a, b) => a[0] - b[0]);
    const floor = (ratio) => (ratio === null ? null : Math.max(ratio, 1e-4)); // a logarithm has no zero
    return [
      points.map((p) => p[0]),
      points.map((p) => (p[1] === 0 ? floor(p[2]) : null)),
      points.map((p) => (p[1] === 0 ? null : floor(p[2] ?? 1))),
      points.map(() => 1),
    ];
  }

  function choose(sensor) {
    chosen = sensor;
    for (const row of rows.children) row.setAttribute("aria-selected", String(row.dataset.key === chosen));
    title.textContent = `Test ratio of ${chosen}`;
    plot.name = `test ratio of ${chosen}`;
    plot.follow();
  }

  function makeRow(line) {
    const name = el("button", {type: "button", onclick: () => choose(line.name)}, line.name);
    const cells = kHead.slice(1, 10).map((head) => el("td", {class: head.endsWith("#") ? "n" : null}));
    const toggle = el("button", {type: "button", onclick: () => toggleSource(line.name)}, "Disable …");
    return el(
      "tr",
      {"data-source": line.name, "aria-selected": String(line.name === chosen)},
      el("td", {}, name),
      ...cells,
      el("td", {}, toggle),
    );
  }

  function updateRow(row, line) {
    const [, kind, presence, rate, latency, used, verdict, good, bad, ratio, last] = row.children;
    const source = line.source;
    const counts = source?.counts ?? [];
    const [mark, look] = kPresence[line.presence] ?? ["○", "soft"];
    put(kind, source?.kind ?? line.name);
    put(presence, `${mark} ${units.words(line.presence ?? "not watched")}`);
    presence.className = look;
    put(rate, Number.isFinite(line.rate_hz) ? `${line.rate_hz.toFixed(1)} Hz` : "–");
    put(latency, Number.isFinite(source?.latency_s) ? `${(source.latency_s * 1000).toFixed(0)} ms` : "–");
    put(
      used,
      !source || source.kind === "imu"
        ? "–"
        : source.since_used_s === null
          ? "never"
          : units.duration(source.since_used_s),
    );
    const [text, shade] = source ? verdictLook(source.last, source.kind) : ["–", ""];
    put(verdict, text);
    verdict.className = shade;
    put(good, String(counts[0] ?? "–"));
    put(bad, counts.length > 0 ? String(counts.slice(1).reduce((a, b) => a + b, 0)) : "–");
    put(ratio, Number.isFinite(source?.last_ratio) ? source.last_ratio.toPrecision(3) : "–");
    const button = last.firstChild;
    button.hidden = !source;
    button.disabled = !mayOrder();
    button.title = mayOrder() ? "" : "Needs the role operator";
    put(button, source?.last === "source_disabled" ? "Enable …" : "Disable …");
  }

  async function toggleSource(sensor) {
    const off = store.tick.sources.find((line) => line.sensor === sensor)?.last === "source_disabled";
    const kind = off ? "enable_source" : "disable_source";
    const text = off
      ? `Fusion will use ${sensor} again.`
      : `Fusion will use nothing of ${sensor} until it is enabled again.`;
    if (await ask(`${off ? "Enable" : "Disable"} ${sensor}`, text, off ? "Enable" : "Disable"))
      order({kind, target: sensor});
  }

  return {
    root,
    name: "Sensors",
    key: "sensors",
    everyMs: 500,
    update(tick) {
      const lines = new Map(tick.status.sensors.map((one) => [one.name, {...one}]));
      for (const source of tick.sources)
        lines.set(source.sensor, {name: source.sensor, ...lines.get(source.sensor), source});
      reconcile(rows, [...lines.values()], (line) => line.name, makeRow, updateRow);
      if (chosen === null && tick.sources.length > 0)
        choose((tick.sources.find((line) => line.kind === "gps") ?? tick.sources[0]).sensor);
      const source = tick.sources.find((line) => line.sensor === chosen);
      const counts = (source?.counts ?? [])
        .map((count, i) => ({name: store.kinds[i] ?? String(i), count}))
        .filter((one) => one.count > 0);
      reconcile(
        reasons,
        counts,
        (one) => one.name,
        () => el("tr", {}, el("td"), el("td", {class: "n"})),
        (row, one) => {
          put(row.children[0], verdictLook(one.name)[0]);
          put(row.children[1], String(one.count));
        },
      );
      showLast();
      plot.update();
    },
  };

  function showLast() {
    const recent = seriesOf(chosen)
      .flatMap(({model, table: verdicts}) => {
        const from = Math.max(0, verdicts.length - 12);
        return verdicts.columns[0]
          .slice(from)
          .map((t, i) => ({t, model, kind: verdicts.columns[1][from + i], ratio: verdicts.columns[2][from + i]}));
      })
      .sort((a, b) => b.t - a.t)
      .slice(0, 12);
    reconcile(
      last,
      recent,
      (one) => one.t + one.model,
      () => el("tr", {}, el("td", {class: "num"}), el("td"), el("td"), el("td", {class: "n"})),
      (row, one) => {
        put(row.children[0], new Date(one.t).toISOString().slice(11, 21));
        put(row.children[1], units.words(one.model));
        put(row.children[2], verdictLook(store.kinds[one.kind] ?? one.kind)[0]);
        put(row.children[3], one.ratio === null ? "–" : one.ratio.toPrecision(3));
      },
    );
  }
}
