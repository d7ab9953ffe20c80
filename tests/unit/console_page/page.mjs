// What the tests of the page share: what its modules ask a browser for, and messages of a console.

globalThis.localStorage = {getItem: () => null, setItem: () => {}};
globalThis.matchMedia = () => ({matches: false, addEventListener: () => {}});
globalThis.document = {documentElement: {dataset: {}}};
globalThis.getComputedStyle = () => ({getPropertyValue: () => ""});

export const web = new URL("../../../services/console/web/js/", import.meta.url);

export const snapshot = (tick = 0) => ({
  tick,
  nav_columns: ["lat_deg", "lon_deg"],
  verdict_kinds: ["used", "rejected"],
  nav: [],
  fixes: [],
  verdicts: [],
  detail_names: ["gyro_bias_x_rad_s"],
  detail: [],
});
export const tick = (number, ms, more = {}) => ({
  tick: number,
  nav: [[ms, 36.4, 127.4]],
  fixes: [[ms, 36.4, 127.4, 1, "gps", "gps", 0]],
  verdicts: [{index: 0, sensor: "dvl", model: "dvl_velocity", source: "dvl", rows: [[ms, 0, 0.1, 0.2, 1, 2, 3, 4]]}],
  services: [],
  detail: [[ms, 1, 2]],
  ...more,
});
