// The map: Leaflet moves and zooms, the chart draws.
import {el, put, reconcile} from "./dom.js";
import {Chart, degreesOf, metresOf} from "./chart.js";
import {onPrefs} from "./prefs.js";
import {isOld, routeText} from "./routes.js";
import {store} from "./store.js";
import {tellFix} from "./fix.js";
import {mayOrder, onSession} from "./orders.js";
import {tileLayer} from "./tiles.js";
import * as units from "./units.js";

export function makeMap() {
  let map = null;
  let chart = null;
  let origin = null;
  let follow = true;
  let measuring = false;
  let measured = [];
  let telling = false;
  let tiles = null;
  const box = el("div", {class: "map", id: "map", role: "application", "aria-label": "Map"});
  const followButton = el(
    "button",
    {
      type: "button",
      "aria-pressed": "true",
      title: "Keep the vehicle in the middle (f)",
      onclick: () => setFollow(!follow),
    },
    "Follow",
  );
  const measureButton = el(
    "button",
    {
      type: "button",
      "aria-pressed": "false",
      title: "Distance between two clicks",
      onclick: () => setMeasuring(!measuring),
    },
    "Measure",
  );
  const fixButton = el(
    "button",
    {
      type: "button",
      "aria-pressed": "false",
      title: "Tell where the vehicle was: click there; the other mouse button does it at once",
      onclick: () => setTelling(!telling),
    },
    "Fix …",
  );
  const pointer = el("span", {class: "pointer", "data-field": "pointer"}, "–");
  const distance = el("span", {class: "num", "data-field": "distance", role: "status"});
  const routes = el("div", {
    class: "routes",
    "data-field": "routes",
    "aria-label": "Routes of guidance",
    role: "group",
    tabindex: 0,
    hidden: true,
  });
  const root = el(
    "div",
    {class: "view mapview"},
    el(
      "div",
      {class: "mapbar"},
      followButton,
      el("button", {type: "button", title: "Show the whole track", onclick: fit}, "Fit track"),
      measureButton,
      fixButton,
      distance,
      pointer,
    ),
    routes,
    box,
    el(
      "div",
      {class: "legend"},
      el("span", {}, "▲ vehicle"),
      el("span", {}, "— track, 10 min"),
      el("span", {}, "◌ 95 % ellipse"),
      el("span", {}, "○ GPS fix"),
      el("span", {}, "◇ USBL fix"),
      el("span", {}, "△ told fix"),
      el("span", {}, "✕ refused fix"),
      el("span", {}, "▣ waypoint steered to"),
      el("span", {}, "□ waypoint, mark"),
      el("span", {}, "✓ waypoint passed"),
    ),
  );

  function setFollow(value) {
    follow = value;
    followButton.setAttribute("aria-pressed", String(value));
    if (value) centre();
  }
  function setMeasuring(value) {
    measuring = value;
    measured = [];
    put(distance, value ? "click two points" : "");
    measureButton.setAttribute("aria-pressed", String(value));
    chart?.draw();
  }
  function setTelling(value) {
    telling = value;
    put(distance, value ? "click where the vehicle was" : "");
    fixButton.setAttribute("aria-pressed", String(value));
  }
  function tell(event) {
    setTelling(false);
    if (mayOrder()) tellFix(event.latlng.lat, event.latlng.lng);
  }
  function vehicle() {
    const nav = store.tick?.status.navigation;
    return nav && nav.lat_deg !== null ? L.latLng(nav.lat_deg, nav.lon_deg) : null;
  }
  function centre() {
    const at = vehicle();
    if (at) map?.setView(at, map.getZoom(), {animate: false});
  }
  function showRoutes() {
    routes.hidden = store.routes.length === 0;
    reconcile(
      routes,
      store.routes,
      (route) => route.publisher,
      (route) => el("p", {"data-route": route.publisher}),
      (line, route) => {
        put(line, routeText(route));
        line.className = isOld(route) ? "bad-text" : "";
      },
    );
  }
  function fit() {
    const lat = store.nav.column("lat_deg").filter((v) => v !== null);
    const lon = store.nav.column("lon_deg").filter((v) => v !== null);
    if (!map || lat.length === 0) return;
    setFollow(false);
    const range = (values) =>
      values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
    const [south, north] = range(lat);
    const [west, east] = range(lon);
    map.fitBounds(L.latLngBounds([south, west], [north, east]).pad(0.15), {animate: false, maxZoom: 20});
  }
  function choose(event) {
    if (telling) tell(event);
    if (!measuring) return;
    if (measured.length >= 2) measured = [];
    measured.push(event.latlng);
    if (measured.length === 2) {
      const {north, east} = metresOf(measured[0], measured[1]);
      put(
        distance,
        `${units.length(Math.hypot(north, east), 1)} at ${units.bearing((Math.atan2(east, north) * 180) / Math.PI)}`,
      );
    } else {
      put(distance, "click the second point");
    }
    chart.draw();
  }
  function point(event) {
    const local = origin ? metresOf(origin, event.latlng) : null;
    put(
      pointer,
      `${units.latitude(event.latlng.lat)} ${units.longitude(event.latlng.lng)}` +
        (local ? ` · ${units.length(local.north, 0)} N ${units.length(local.east, 0)} E of the first position` : ""),
    );
  }
  function useTiles() {
    if (!map || tiles || !store.session.tiles) return;
    tiles = tileLayer("/tiles/{z}/{x}/{y}.png", {maxZoom: 22, maxNativeZoom: 18}).addTo(map);
    chart.draw();
  }
  function begin() {
    map = L.map(box, {
      zoomControl: true,
      attributionControl: false,
      zoomSnap: 0.25,
      minZoom: 3,
      maxZoom: 22,
      keyboard: true,
      fadeAnimation: false,
      zoomAnimation: false,
    });
    map.setView(vehicle() ?? [0, 0], vehicle() ? 19 : 3);
    L.control.scale({imperial: units.lengthUnit() === "ft", metric: units.lengthUnit() === "m"}).addTo(map);
    chart = new Chart({origin: () => origin, grid: () => !tiles, measured: () => measured}).addTo(map);
    map.on("click", choose);
    map.on("contextmenu", tell);
    map.on("mousemove", point);
    map.on("dragstart", () => setFollow(false));
    useTiles();
  }
  onPrefs(() => chart?.draw());
  onSession(useTiles);
  onSession(() => {
    fixButton.hidden = !mayOrder();
  });
  fixButton.hidden = !mayOrder();

  return {
    root,
    name: "Map",
    key: "map",
    everyMs: 200,
    shown() {
      if (!map) begin();
      map.invalidateSize({animate: false});
    },
    keys: {f: () => setFollow(!follow)},
    update() {
      const lat = store.nav.column("lat_deg").findIndex((v) => v !== null);
      if (!origin && lat >= 0) {
        origin = L.latLng(store.nav.column("lat_deg")[lat], store.nav.column("lon_deg")[lat]);
        if (map.getZoom() < 10) map.setView(degreesOf(origin, {north: 0, east: 0}), 19, {animate: false});
      }
      if (follow) centre();
      showRoutes();
      chart.draw();
    },
  };
}
