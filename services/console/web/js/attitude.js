// The horizon as pilots know it, and a compass needle. SVG, so that it follows the theme by itself.
import {svg} from "./dom.js";

export function makeAttitude() {
  const marks = [-30, -20, -10, 10, 20, 30].map((deg) =>
    svg("line", {x1: -12, x2: 12, y1: -deg, y2: -deg, stroke: "var(--ink)", "stroke-width": 1}),
  );
  const world = svg(
    "g",
    {},
    svg("rect", {x: -200, y: -300, width: 400, height: 300, fill: "var(--sky)"}),
    svg("rect", {x: -200, y: 0, width: 400, height: 300, fill: "var(--sea)"}),
    svg("line", {x1: -200, x2: 200, y1: 0, y2: 0, stroke: "var(--ink)", "stroke-width": 1.5}),
    ...marks,
  );
  const clip = svg("clipPath", {id: "horizon"}, svg("circle", {cx: 0, cy: 0, r: 58}));
  const needle = svg("path", {d: "M0 -58 L6 -46 L-6 -46 Z", fill: "var(--bad)"});
  const north = svg(
    "g",
    {},
    needle,
    svg("text", {x: 0, y: -60, "text-anchor": "middle", "font-size": 11, fill: "var(--ink)"}, "N"),
  );
  const root = svg(
    "svg",
    {viewBox: "-73 -73 146 146", role: "img", "aria-label": "Attitude"},
    clip,
    svg("g", {"clip-path": "url(#horizon)"}, world),
    svg("circle", {cx: 0, cy: 0, r: 58, fill: "none", stroke: "var(--line)", "stroke-width": 2}),
    svg("path", {d: "M-30 0 H-10 M10 0 H30 M0 -2 V2", stroke: "var(--caution)", "stroke-width": 3, fill: "none"}),
    north,
  );
  return {
    root,
    show(roll, pitch, yaw) {
      const flat = [roll, pitch].every(Number.isFinite);
      root.style.opacity = flat ? "1" : "0.25";
      if (!flat) return;
      // One degree is one unit; the world turns against the vehicle.
      world.setAttribute("transform", `rotate(${-roll}) translate(0 ${pitch})`);
      north.setAttribute("transform", `rotate(${-yaw})`);
      root.setAttribute(
        "aria-label",
        `Attitude: roll ${roll.toFixed(1)}, pitch ${pitch.toFixed(1)}, heading ${yaw.toFixed(1)} degrees`,
      );
    },
  };
}
