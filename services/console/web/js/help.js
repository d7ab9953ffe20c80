import {el} from "./dom.js";

const kKeys = [
  ["1 … 5", "views"],
  ["p or space", "pause or go on with the plots"],
  ["t", "day or night"],
  ["u", "metres and degrees, or feet, knots and minutes"],
  ["f", "follow the vehicle on the map"],
  ["?", "this help"],
  ["Esc", "close"],
];

export function help() {
  if (document.querySelector("dialog[open]")) return;
  const dialog = el(
    "dialog",
    {"aria-label": "Help on keys", onclose: () => dialog.remove()},
    el("h2", {}, "Keys"),
    el(
      "table",
      {},
      el(
        "tbody",
        {},
        ...kKeys.map(([key, what]) => el("tr", {}, el("td", {}, el("kbd", {}, key)), el("td", {}, what))),
      ),
    ),
    el(
      "p",
      {},
      "On the map: drag to move. An operator clicks where the vehicle was to tell a fix; a second click sends it.",
    ),
    el(
      "p",
      {},
      "On a plot: drag to zoom, the buttons above it to move, to save as CSV or PNG, and to come back to live.",
    ),
    el("form", {method: "dialog", class: "row"}, el("button", {class: "primary"}, "Close")),
  );
  document.body.append(dialog);
  dialog.showModal();
}
