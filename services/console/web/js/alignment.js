// What alignment waits for, condition by condition. There is nothing to see of it once the vehicle is aligned.
import {card, el, put, reconcile, scroller} from "./dom.js";
import * as units from "./units.js";

export const isAligned = (status) => status?.phase === "aligned";

/** A mark and the phase. */
export const phaseWords = (status) =>
  status ? `${isAligned(status) ? "✔" : "▲"} ${units.words(status.phase)}` : "not heard";

export function makeAlignment() {
  const since = el("strong", {class: "caution-text num"});
  const conditions = el("div", {class: "conditions"});
  const advice = el("p", {class: "soft"});
  const root = card("alignment", "Alignment", [since], scroller("Alignment", conditions, advice));
  return {
    root,
    update(status) {
      root.hidden = !status || isAligned(status);
      if (root.hidden) return;
      const left = status.time_to_aligned_s > 0 ? `, ${units.duration(status.time_to_aligned_s)} to go` : "";
      put(since, `for ${units.duration(status.in_phase_s)}${left}`);
      put(advice, status.advice ?? "");
      reconcile(conditions, status.conditions, (one) => one.name, makeCondition, updateCondition);
    },
  };
}

function makeCondition() {
  return el(
    "div",
    {class: "condition"},
    el("span"),
    el("span"),
    el("progress", {max: 1}),
    el("small", {class: "soft"}),
  );
}

function updateCondition(node, one) {
  const {group, name, unit, scale} = units.stateName(one.name);
  const label = group === name ? group : `${group} ${name}`;
  const [state, text, bar, help] = node.children;
  put(state, one.met ? "✔" : "…");
  state.title = one.met ? "met" : "not yet met";
  state.className = one.met ? "good-text" : "caution-text";
  const shown = unit === "‰" ? ["", 1] : [unit, scale];
  const limit = one.limit === null ? "" : ` of ${units.fixed(one.limit * shown[1], 2)}`;
  put(text, `${label} ${units.fixed(one.value * shown[1], 2)}${limit} ${shown[0]}`);
  bar.setAttribute("aria-label", label);
  put(help, one.help ?? "");
  bar.value = one.needed_s > 0 ? Math.min(1, one.held_s / one.needed_s) : one.met ? 1 : 0;
}
