// Before the first paint: the theme of last time, else the system's. A night screen must not flash white.
(() => {
  const kept = localStorage.getItem("fathom.theme");
  const system = matchMedia("(prefers-color-scheme: dark)").matches ? "night" : "day";
  document.documentElement.dataset.theme = kept === "day" || kept === "night" ? kept : system;
})();
