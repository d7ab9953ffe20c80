// The overview's layout, measured in the page as an operator's eye would: what is largest, what overlaps, what is empty.
import {check, kShots, until, view} from "./stage.mjs";

/** The window's sizes that the overview is made for. */
export const kSizes = [
  {width: 1280, height: 720},
  {width: 1920, height: 1080},
];
/** Of a panel's height: no empty band may be higher; of its width: none may be wider. Two lines of text are no panel to fill. */
const kMostEmpty = {height: 0.4, width: 0.5, linesPx: 64};
/** Of the window: the map has at least this much of it. */
const kLeastMap = 0.25;

/** Runs in the page: what is not as it should be, a sentence each. */
function measure({most, leastMap}) {
  const faults = [];
  const area = ({width, height}) => width * height;
  const seen = (node) => node.checkVisibility({visibilityProperty: true}) && area(node.getBoundingClientRect()) > 0;
  const shown = document.querySelector(".view:not([hidden])");
  const panels = [...shown.querySelectorAll(".card")].filter(seen);
  const name = (panel) => panel.getAttribute("aria-label");
  const map = shown.querySelector(".leaflet-container");

  const main = document.getElementById("main");
  const scrolls = [document.documentElement, main, ...panels, shown.querySelector(".side")].filter(Boolean);
  for (const node of scrolls) {
    const over = [node.scrollWidth - node.clientWidth, node.scrollHeight - node.clientHeight];
    if (over.some((pixels) => pixels > 1)) faults.push(`${node.className || node.tagName} scrolls by ${over} pixels`);
  }

  if (!map) faults.push("there is no map");
  else {
    const size = area(map.getBoundingClientRect());
    const window = innerWidth * innerHeight;
    if (size < leastMap * window) faults.push(`the map has ${Math.round((100 * size) / window)} % of the window`);
    for (const panel of panels) {
      const other = area(panel.getBoundingClientRect());
      if (!panel.contains(map) && other >= size) faults.push(`${name(panel)} is larger than the map`);
    }
  }

  const overlap = (a, b) => ({
    width: Math.min(a.right, b.right) - Math.max(a.left, b.left),
    height: Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top),
  });
  const meet = (a, b, by) => {
    const {width, height} = overlap(a, b);
    return width > by && height > by;
  };
  const inWindow = {left: 0, top: 0, right: innerWidth, bottom: innerHeight};
  const whole = (rect) =>
    rect.left >= -1 && rect.top >= -1 && rect.right <= inWindow.right + 1 && rect.bottom <= inWindow.bottom + 1;
  panels.forEach((panel, i) => {
    const rect = panel.getBoundingClientRect();
    if (!whole(rect)) faults.push(`${name(panel)} leaves the window`);
    for (const other of panels.slice(i + 1))
      if (meet(rect, other.getBoundingClientRect(), 1)) faults.push(`${name(panel)} overlaps ${name(other)}`);
  });

  /** What a panel shows: words, and drawings as a whole. */
  const drawings = "svg, canvas, progress, button, input";
  function content(panel) {
    const words = [];
    const walker = document.createTreeWalker(panel, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const node = walker.currentNode;
      if (!node.data.trim() || !seen(node.parentElement) || node.parentElement.closest(".leaflet-container")) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      for (const rect of range.getClientRects()) words.push({rect, text: node.data.trim()});
    }
    const things = [...panel.querySelectorAll(drawings)]
      .filter(seen)
      .map((node) => ({rect: node.getBoundingClientRect()}));
    return {words, things};
  }
  /** The longest stretch from `from` to `to` that none of the intervals covers. */
  function gap(intervals, from, to) {
    let end = from;
    let longest = 0;
    for (const [low, high] of [...intervals].sort((a, b) => a[0] - b[0])) {
      longest = Math.max(longest, low - end);
      end = Math.max(end, high);
    }
    return Math.max(longest, to - end);
  }
  for (const panel of panels) {
    const {words, things} = content(panel);
    const rect = panel.getBoundingClientRect();
    for (const [i, {rect: one, text}] of words.entries()) {
      if (one.left < rect.left || one.right > rect.right + 1) faults.push(`"${text}" leaves ${name(panel)}`);
      for (const other of words.slice(i + 1))
        if (meet(one, other.rect, 3)) faults.push(`"${text}" lies over "${other.text}" in ${name(panel)}`);
    }
    if (rect.height <= most.linesPx || panel.contains(map)) continue;
    const all = [...words, ...things].map((one) => one.rect);
    const high =
      gap(
        all.map(({top, bottom}) => [top, bottom]),
        rect.top,
        rect.bottom,
      ) / rect.height;
    const wide =
      gap(
        all.map(({left, right}) => [left, right]),
        rect.left,
        rect.right,
      ) / rect.width;
    if (high > most.height)
      faults.push(`${name(panel)} has an empty band over ${Math.round(100 * high)} % of its height`);
    if (wide > most.width)
      faults.push(`${name(panel)} has an empty band over ${Math.round(100 * wide)} % of its width`);
  }
  return faults;
}

/** Where nothing is known there is nothing to fill a panel with. */
export const kMayBeEmpty = {height: 1, width: 1, linesPx: 0};

export const layoutFaults = (page, most = kMostEmpty) => page.evaluate(measure, {most, leastMap: kLeastMap});

/** In both sizes, by day and by night, with a picture of each. */
export async function overviewFits(page, state, most = kMostEmpty) {
  const before = page.viewportSize();
  await view(page, "overview");
  for (const _ of [0, 1]) {
    for (const size of kSizes) {
      await page.setViewportSize(size);
      const theme = await page.evaluate(() => document.documentElement.dataset.theme);
      const at = `${size.width}x${size.height}, ${theme}, ${state}`;
      // What is asked again is only what may change by itself within a moment, as an alarm that comes.
      let faults = [];
      await until(
        `a layout without faults at ${at}`,
        async () => (faults = await layoutFaults(page, most)).length === 0,
        20000,
      ).catch(() => {});
      await page.screenshot({path: `${kShots}/overview-${state}-${size.width}x${size.height}-${theme}.png`});
      check(faults.length === 0, `the overview at ${at}:\n  ${faults.join("\n  ")}`);
    }
    await page.keyboard.press("t");
  }
  await page.setViewportSize(before);
}
