// Sensors and services, one word each: which of them is not as it should be.
import {el, put, reconcile, verdictLook} from "./dom.js";
import * as units from "./units.js";

const kSilentS = 3;
const kNarrow = 17; // letters that fit into one column

/** What fusion made of a sensor last, and whether the monitor hears it: [mark, word, look]. */
export function sensorState(line, watched) {
  const hertz = Number.isFinite(watched?.rate_hz)
    ? `${watched.rate_hz.toFixed(watched.rate_hz < 9.95 ? 1 : 0)} Hz`
    : "";
  const told = line?.kind === "fix"; // now and then: silence says nothing
  if (!told && watched?.presence === "missing") return ["✖", "missing", "bad-text"];
  if (!told && watched?.presence === "stale") return ["▲", `silent ${units.duration(watched.age_s)}`, "caution-text"];
  if (!line) return watched?.presence === "present" ? ["✔", hertz, "good-text"] : ["○", "never heard", "soft"];
  if (line.kind === "imu") return ["✔", hertz, "good-text"];
  const [text, look] = verdictLook(line.last, line.kind);
  const [mark, ...words] = text.split(" ");
  if (line.last === "not_aligned") return ["…", "waiting", "soft"]; // as all of them are until it is
  if (line.last === "source_disabled") return [mark, "off", look];
  return line.last === "used" ? [mark, told ? "used" : hertz, look] : [mark, words.join(" "), look];
}

/** [mark, word, look] of a service; no word where all is well. */
export function serviceState({state, age_s}) {
  if (age_s > kSilentS || age_s === null) return ["✖", "silent", "bad-text"];
  if (state === "healthy") return ["✔", "", "good-text"];
  if (state === "starting" || state === "stopping") return ["…", state, "caution-text"];
  return ["✖", units.words(state), "bad-text"];
}

export function makeStrip() {
  const line = (title) => {
    const list = el("ul", {class: "chips"});
    return {list, root: el("div", {class: "line"}, el("div", {class: "title"}, el("h2", {}, title)), list)};
  };
  const sensors = line("Sensors");
  const services = line("Services");
  const root = el(
    "section",
    {class: "card lines strip", "aria-label": "Sensors and services", tabindex: 0},
    sensors.root,
    services.root,
  );
  const make = (key) => (item) => el("li", {[key]: item.name}, el("span"), el("span", {class: "name"}), el("span"));
  function show(node, name, [mark, word, look], title) {
    const [sign, label, state] = node.children;
    put(sign, mark);
    put(label, name);
    put(state, word);
    sign.className = look;
    state.className = "state num " + look;
    if (node.title !== title) node.title = title;
    node.classList.toggle("wide", name.length + word.length > kNarrow);
  }

  function showSensors(tick) {
    const watched = new Map(tick.status.sensors.map((sensor) => [sensor.name, sensor]));
    const lines = new Map(tick.sources.map((source) => [source.sensor, source]));
    const names = [...new Set([...watched.keys(), ...lines.keys()])].sort();
    const items = names.map((name) => ({name}));
    if (items.length === 0) items.push({name: ""});
    reconcile(
      sensors.list,
      items,
      (item) => item.name,
      make("data-sensor"),
      (node, {name}) => {
        if (name === "") return show(node, "none heard", ["○", "", "soft"], "");
        const [one, other] = [lines.get(name), watched.get(name)];
        const used =
          one && one.kind !== "imu" && one.since_used_s !== null
            ? `last used ${units.duration(one.since_used_s)} ago`
            : "";
        show(node, units.words(name), sensorState(one, other), used);
      },
    );
  }
  function showServices({status}) {
    const items = [...status.services].sort((a, b) => a.name.localeCompare(b.name));
    reconcile(
      services.list,
      items,
      (item) => item.name,
      make("data-service-chip"),
      (node, service) => show(node, units.words(service.name), serviceState(service), service.text ?? ""),
    );
  }
  return {
    root,
    update(tick) {
      showSensors(tick);
      showServices(tick);
    },
  };
}
