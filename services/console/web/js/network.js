// Services and what they say about the vehicle network.
import {card, el, put, reconcile, scroller, tableOf} from "./dom.js";
import {store} from "./store.js";
import * as units from "./units.js";

const kHead = ["Service", "State", "Heard#", "Up for#", "Restarts#", "Process", "Version", "QoS mismatches#", "Lost#"];
const kStates = {
  healthy: ["✔", "good-text"],
  degraded: ["✖", "bad-text"],
  starting: ["…", "caution-text"],
  stopping: ["…", "caution-text"],
};

export function makeNetwork() {
  const rows = el("tbody");
  const table = tableOf(kHead, rows);
  const counters = el("tbody");
  let chosen = null;
  const side = card(
    "",
    "Counters",
    [],
    scroller("Counters", tableOf(["Counter", "Value#"], counters)),
  );
  const sideTitle = side.querySelector("h2");
  const root = el("div", {class: "view network"}, card("", "Services", [], scroller("Services", table)), side);

  const make = (line) =>
    el(
      "tr",
      {"data-service": line.name},
      el("td", {}, el("button", {type: "button", onclick: () => (chosen = line.name)}, units.words(line.name))),
      ...kHead.slice(1).map((head) => el("td", {class: head.endsWith("#") ? "n" : null})),
    );

  function update(row, line) {
    const more = store.services.find((one) => one.name === line.name);
    const count = (name) => more?.counters.find(([key]) => key === name)?.[1] ?? 0;
    const silent = line.age_s > 3;
    const [mark, look] = silent ? ["✖", "bad-text"] : (kStates[line.state] ?? ["○", "soft"]);
    const [, state, heard, up, restarts, process, version, qos, lost] = row.children;
    put(state, `${mark} ${silent ? "silent" : units.words(line.state)}` + (line.text ? `: ${line.text}` : ""));
    state.className = look;
    put(heard, units.duration(line.age_s));
    put(up, more ? units.duration((store.tick.utc_ms - more.started_ms) / 1000) : "–");
    put(restarts, String(more?.restarts ?? "–"));
    put(process, line.pid ? `${line.pid} on ${line.host}` : "–");
    put(version, line.version ?? "–");
    version.title = "configuration " + (line.config_hash ?? "unknown");
    put(qos, more ? (count("bus_incompatible_qos") > 0 ? "✖ " : "") + count("bus_incompatible_qos") : "–");
    qos.className = count("bus_incompatible_qos") > 0 ? "n bad-text" : "n";
    put(lost, more ? String(count("bus_sample_lost") + count("bus_write_failed")) : "–");
  }

  return {
    root,
    name: "Network",
    key: "network",
    everyMs: 500,
    update(tick) {
      reconcile(rows, tick.status.services, (line) => line.name, make, update);
      chosen ??=
        tick.status.services.find((line) => line.name === "fusion")?.name ?? tick.status.services[0]?.name ?? null;
      put(sideTitle, chosen ? `Figures of ${units.words(chosen)}` : "Counters");
      const more = store.services.find((one) => one.name === chosen);
      const rates = (more?.rates ?? []).map(([name, hz]) => [
        `${name} rate`,
        hz === null ? "–" : `${hz.toFixed(1)} Hz`,
      ]);
      reconcile(
        counters,
        [...rates, ...(more?.counters ?? [])],
        ([name]) => name,
        () => el("tr", {}, el("td"), el("td", {class: "n"})),
        (row, [name, value]) => {
          put(row.children[0], units.words(name));
          put(row.children[1], String(value));
        },
      );
    },
  };
}
