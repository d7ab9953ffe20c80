// The filter's own account: innovations with their sigma, estimated errors with theirs, and uncertainty over time.
import {card, el} from "./dom.js";
import {Plot, plotControls} from "./plot.js";
import {onPrefs, prefs} from "./prefs.js";
import {store} from "./store.js";
import * as units from "./units.js";

const kComponents = {
  dvl: ["forward", "right", "down", "4th"],
  gps: ["north", "east", "down", "4th"],
  usbl: ["north", "east", "down", "4th"],
  fix: ["north", "east", "down", "4th"],
};

function refill(select, options, chosen) {
  if (select.children.length === options.length && [...select.children].every((child, i) => child.value === options[i]))
    return;
  select.replaceChildren(...options.map((value) => el("option", {value}, units.words(value))));
  if (options.includes(chosen)) select.value = chosen;
}

export function makeFilter() {
  let changed = "";
  const series = el("select", {"aria-label": "Aiding model"});
  const component = el("select", {"aria-label": "Component"});
  const group = el("select", {"aria-label": "Estimated states"});
  const innovationCard = card("", "Innovation ± 2σ", [series, component]);
  const stateCard = card("", "Estimated errors ± 1σ", [group]);
  const positionCard = card("", "σ of position", []);
  const attitudeCard = card("", "σ of attitude", []);

  const innovation = new Plot(innovationCard, {
    name: "innovation",
    unit: () => "",
    series: [
      {label: "used", colour: "s1", dash: 0, points: true},
      {label: "not used", colour: "bad", dash: 0, points: true},
      {label: "+2σ", colour: "s6", dash: 1},
      {label: "−2σ", colour: "s6", dash: 1},
    ],
    read: () => {
      const verdicts = store.series.get(series.value)?.table;
      if (!verdicts) return [[], [], [], [], []];
      const i = Number(component.value || 0);
      const values = verdicts.column("i" + i);
      const sigmas = verdicts.column("s" + i);
      const kinds = verdicts.column("kind");
      return [
        verdicts.columns[0].map((t) => t / 1000),
        values.map((v, k) => (kinds[k] === 0 ? v : null)),
        values.map((v, k) => (kinds[k] === 0 ? null : v)),
        sigmas.map((s) => (s === null ? null : 2 * s)),
        sigmas.map((s) => (s === null ? null : -2 * s)),
      ];
    },
  });
  const states = new Plot(stateCard, {
    name: "estimated errors",
    unit: () => members()[0]?.unit ?? "",
    series: [{label: "–", colour: "s1"}],
    read: readStates,
  });
  const navPlot = (card, name, unit, scale, columns) =>
    new Plot(card, {
      name,
      unit,
      series: columns.map(([label], i) => ({label, colour: "s" + (i + 1)})),
      read: () => [
        store.nav.columns[0].map((t) => t / 1000),
        ...columns.map(([, column]) => store.nav.column(column).map((v) => (v === null ? null : scale(v)))),
      ],
    });
  const position = navPlot(positionCard, "sigma of position", units.lengthUnit, units.toLength, [
    ["north", "s_north_m"],
    ["east", "s_east_m"],
    ["down", "s_down_m"],
    ["95 % horizontal", "h95_m"],
  ]);
  const attitude = navPlot(
    attitudeCard,
    "sigma of attitude",
    () => "deg",
    (v) => v,
    [
      ["roll", "s_roll_deg"],
      ["pitch", "s_pitch_deg"],
      ["heading", "s_yaw_deg"],
    ],
  );
  onPrefs(() => (changed = prefs.length));

  function members() {
    return store.detailNames
      .map((raw) => ({raw, ...units.stateName(raw)}))
      .filter((state) => state.group === group.value);
  }
  function readStates() {
    const time = store.detail.columns[0].map((t) => t / 1000);
    return [
      time,
      ...members().flatMap(({raw, scale}) => {
        const value = store.detail.column(raw);
        const sigma = store.detail.column("sigma of " + raw);
        return [
          value.map((v) => (v === null ? null : v * scale)),
          value.map((v, i) => (v === null ? null : (v + sigma[i]) * scale)),
          value.map((v, i) => (v === null ? null : (v - sigma[i]) * scale)),
        ];
      }),
    ];
  }
  function nameStates() {
    states.setSeries(
      members().flatMap(({name}, i) => [
        {label: name, colour: "s" + (i + 1), dash: 0, width: 2},
        {label: `${name} +σ`, colour: "s" + (i + 1), dash: 2, width: 1, quiet: true},
        {label: `${name} −σ`, colour: "s" + (i + 1), dash: 2, width: 1, quiet: true},
      ]),
    );
  }
  function nameComponents() {
    const chosen = store.series.get(series.value);
    const count = chosen?.dimensions ?? 0;
    const names = kComponents[chosen?.source] ?? [];
    if (component.children.length === count && component.dataset.of === series.value) return;
    component.dataset.of = series.value;
    component.replaceChildren(
      ...Array.from({length: count}, (_, i) =>
        el("option", {value: i}, count > 1 ? (names[i] ?? String(i + 1)) : "value"),
      ),
    );
  }
  series.addEventListener("change", () => {
    nameComponents();
    innovation.follow();
  });
  component.addEventListener("change", () => innovation.follow());
  group.addEventListener("change", nameStates);

  const root = el("div", {class: "view filter"}, plotControls(), innovationCard, stateCard, positionCard, attitudeCard);
  return {
    root,
    name: "Filter",
    key: "filter",
    everyMs: 500,
    update() {
      const judged = [...store.series.values()].filter((one) => one.dimensions > 0).map((one) => one.key);
      refill(series, judged, judged.includes(series.value) ? series.value : judged.find((key) => key.includes("dvl")));
      nameComponents();
      const groups = [...new Set(store.detailNames.map((raw) => units.stateName(raw).group))].filter(
        (name) => !["position", "velocity", "attitude"].includes(name),
      );
      const signature = store.detailNames.join() + groups.length;
      refill(
        group,
        groups,
        groups.find((name) => name.startsWith("gyro bias")),
      );
      if (changed !== signature) {
        changed = signature;
        nameStates();
      }
      for (const plot of [innovation, states, position, attitude]) plot.update();
    },
  };
}
