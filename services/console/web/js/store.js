// Everything the page knows. Histories are columns of numbers, cut to ten minutes: the page's memory is bounded.

const kSpanMs = 600000;
const kSlack = 400; // rows beyond the span before they are cut, so that cutting is rare

/** The newest row of time t, or -1. Rows may be a minute out of order. */
function newestAt(length, timeOf, t, also = () => true) {
  if (length === 0 || t > timeOf(length - 1)) return -1;
  for (let i = length - 1; i >= 0 && timeOf(i) >= t - 60000; --i) if (timeOf(i) === t && also(i)) return i;
  return -1;
}

/** A table kept as columns; the first one is the time in ms. */
export class Table {
  constructor(names) {
    this.names = names;
    this.columns = names.map(() => []);
  }
  /** In place of the newest row of the same time, when there is one. */
  put(row) {
    const times = this.columns[0];
    const at = newestAt(times.length, (i) => times[i], row[0]);
    if (at < 0) return this.push(row);
    for (let i = 0; i < this.columns.length; ++i) this.columns[i][at] = row[i] ?? null;
  }
  push(row) {
    for (let i = 0; i < this.columns.length; ++i) this.columns[i].push(row[i] ?? null);
    this.cut();
  }
  cut() {
    const times = this.columns[0];
    const limit = times[times.length - 1] - kSpanMs;
    if (times.length < kSlack || times[kSlack] > limit) return;
    let old = 0;
    while (old < times.length && times[old] < limit) ++old;
    for (const column of this.columns) column.splice(0, old);
  }
  column(name) {
    return this.columns[this.names.indexOf(name)] ?? [];
  }
  get length() {
    return this.columns[0].length;
  }
}

export const store = {
  tick: null, // the newest tick event
  tickAt: 0, // performance.now() of its arrival
  tickNumber: -1,
  services: [],
  routes: [], // of guidance, by publisher
  routesAt: 0, // performance.now() of their arrival
  kinds: [], // of verdicts
  modes: [], // of navigation
  nav: new Table(["t"]),
  fixes: [],
  series: new Map(), // "sensor model" -> {sensor, model, source, table, dimensions}
  detailNames: [],
  detail: new Table(["t"]),
  session: {role: "nobody", orders: false, name: "", tiles: false, waypoints: [], vehicle: ""},
};

const kVerdictColumns = [
  "t",
  "kind",
  "ratio",
  "latency",
  "i0",
  "s0",
  "i1",
  "s1",
  "i2",
  "s2",
  "i3",
  "s3",
  "i4",
  "s4",
  "i5",
  "s5",
];

function takeVerdicts(list) {
  for (const {sensor, model, source, rows} of list) {
    const key = `${sensor} ${model}`;
    let series = store.series.get(key);
    if (!series) {
      series = {key, sensor, model, source, table: new Table(kVerdictColumns), dimensions: 0};
      store.series.set(key, series);
    }
    for (const row of rows) {
      series.table.put(row); // a measurement may be judged again
      series.dimensions = Math.max(series.dimensions, (row.length - 4) / 2);
    }
  }
}

function takeFixes(rows) {
  for (const [t, lat, lon, sigma, source, sensor, verdict] of rows) {
    const fix = {t, lat, lon, sigma, source, sensor, verdict};
    const at = newestAt(store.fixes.length, (i) => store.fixes[i].t, t, (i) => store.fixes[i].sensor === sensor);
    if (at < 0) store.fixes.push(fix);
    else store.fixes[at] = fix; // judged again
  }
  const newest = store.fixes[store.fixes.length - 1]?.t ?? 0;
  if (store.fixes.length > kSlack && store.fixes[kSlack].t < newest - kSpanMs) {
    store.fixes = store.fixes.filter((fix) => fix.t >= newest - kSpanMs);
  }
}

function nameDetail(names) {
  store.detailNames = names;
  store.detail = new Table(["t", ...names.flatMap((name) => [name, "sigma of " + name])]);
}

/** The history: all that was there before is replaced by it. */
export function takeSnapshot(event) {
  store.kinds = event.verdict_kinds;
  store.modes = event.nav_modes ?? [];
  store.nav = new Table(["t", ...event.nav_columns]);
  for (const row of event.nav) store.nav.push(row);
  store.fixes = [];
  takeFixes(event.fixes);
  store.series = new Map();
  takeVerdicts(event.verdicts);
  nameDetail(event.detail_names);
  for (const row of event.detail) store.detail.push(row);
  store.tickNumber = event.tick;
}

/** False for a tick that the snapshot holds already. */
export function takeTick(event) {
  if (event.tick <= store.tickNumber) return false;
  store.tickNumber = event.tick;
  store.tick = event;
  store.tickAt = performance.now();
  if (event.services.length > 0) store.services = event.services;
  if (event.routes) {
    store.routes = event.routes;
    store.routesAt = store.tickAt;
  }
  for (const row of event.nav) store.nav.push(row);
  takeFixes(event.fixes);
  takeVerdicts(event.verdicts);
  if (event.detail_names) nameDetail(event.detail_names);
  if (event.detail.length > 0) store.detail.push(event.detail[0]);
  return true;
}
