// What a person chose, kept in this browser only.

const kept = (key, fallback) => localStorage.getItem("fathom." + key) ?? fallback;
const listeners = [];

export const prefs = {
  length: kept("length", "m"),
  angle: kept("angle", "deg"),
  speed: kept("speed", "m/s"),
};

export function onPrefs(listener) {
  listeners.push(listener);
}

function changed() {
  for (const listener of listeners) listener();
}

export function setPref(key, value) {
  prefs[key] = value;
  localStorage.setItem("fathom." + key, value);
  changed();
}

export const theme = () => document.documentElement.dataset.theme;

/** Once somebody has pressed the button, the system's preference no longer counts. */
export function toggleTheme() {
  const next = theme() === "night" ? "day" : "night";
  localStorage.setItem("fathom.theme", next);
  document.documentElement.dataset.theme = next;
  changed();
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => {
  if (localStorage.getItem("fathom.theme")) return;
  document.documentElement.dataset.theme = event.matches ? "night" : "day";
  changed();
});

/** A colour of the present theme. */
export const colour = (name) =>
  getComputedStyle(document.documentElement)
    .getPropertyValue("--" + name)
    .trim();
