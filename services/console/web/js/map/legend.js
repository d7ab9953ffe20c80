// What the marks on the map mean. Only what there is at the moment is explained.
import {el, svg} from "../dom.js";
import {store} from "../store.js";
import {kOtherTrack, kTracks} from "./looks.js";

const used = (source) => () => store.fixes.some((fix) => fix.source === source && !(fix.verdict > 0));
const stroke = ({ink, dash}) =>
  svg(
    "svg",
    {viewBox: "0 0 28 8", class: "stroke ink-" + ink, "aria-hidden": "true"},
    svg("line", {
      x1: 0,
      x2: 28,
      y1: 4,
      y2: 4,
      stroke: "currentColor",
      "stroke-width": 3,
      "stroke-dasharray": dash.join(" ") || "none",
    }),
  );
const sign = (text, ink) => el("span", {class: "ink-" + ink, "aria-hidden": "true"}, text);

export function makeLegend() {
  const seen = new Set(); // the modes of the track
  const items = [];
  const root = el("div", {class: "legend"});
  const item = (mark, words, when) => {
    const node = el("span", {}, mark, " " + words);
    items.push({node, when});
    root.append(node);
  };
  item(sign("▲", "accent"), "vehicle", () => true);
  item(sign("◌", "caution"), "95 %", () => true);
  for (const [name, look] of Object.entries(kTracks)) item(stroke(look), look.words, () => seen.has(name));
  item(stroke(kOtherTrack), kOtherTrack.words, () => seen.has("none") || seen.has("aligning"));
  item(sign("○", "s3"), "GPS fix", used("gps"));
  item(sign("◇", "s2"), "USBL fix", used("usbl"));
  item(sign("△", "s4"), "told fix", used("fix"));
  item(sign("✕", "bad"), "refused", () => store.fixes.some((fix) => fix.verdict > 0));
  item(sign("⊕", "s5"), "beacon", () => (store.tick?.beacons ?? []).length > 0);
  item(sign("▣", "s4"), "steered to", () => store.routes.length > 0);
  item(sign("□", "s4"), "waypoint", () => store.routes.length > 0 || (store.session.waypoints ?? []).length > 0);
  item(sign("✓", "soft"), "passed", () => store.routes.some((route) => route.active > 0));
  return {
    root,
    update() {
      seen.clear();
      const lat = store.nav.column("lat_deg");
      const modes = store.nav.column("mode");
      modes.forEach((mode, i) => lat[i] !== null && seen.add(store.modes[mode]));
      for (const {node, when} of items) node.hidden = !when();
    },
  };
}
