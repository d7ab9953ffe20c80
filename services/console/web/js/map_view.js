// The map alone, over the whole width.
import {el} from "./dom.js";

export function makeMap(panel) {
  const root = el("div", {class: "view mapview"});
  return {
    root,
    name: "Map",
    key: "map",
    everyMs: 200,
    shown: () => panel.showIn(root),
    keys: {f: panel.follow},
    update: panel.update,
  };
}
