// The map: Leaflet moves and zooms, the chart draws, buttons and words lie around it. There is one of it in the page; the
// overview and the map view show the same one, so that place, zoom and a fix half told stay as they are.
import {el, put, reconcile} from "../dom.js";
import {mayOrder, onSession} from "../orders.js";
import {onPrefs} from "../prefs.js";
import {isOld, routeText} from "../routes.js";
import {store} from "../store.js";
import * as units from "../units.js";
import {Chart} from "./chart.js";
import {makeFixForm} from "./fix_form.js";
import {metresOf} from "./geometry.js";
import {makeLegend} from "./legend.js";
import {knownPlace, placeWords, vehicleNow} from "./place.js";
import {tileLayer} from "./tiles.js";

const kNear = 19; // zoom: some hundred metres across

export function makeMapPanel() {
  let map = null;
  let chart = null;
  let origin = null;
  let tiles = null;
  let scale = null;
  let measured = null; // two ends, while somebody measures
  let follow = true;

  const toggle = (text, title, act, pressed) =>
    el("button", {type: "button", "aria-pressed": pressed, title, onclick: act}, text);
  const followButton = toggle("Follow", "Keep the vehicle in the middle (f)", () => setFollow(!follow), "true");
  const fitButton = toggle("Fit track", "Show the whole track", fit);
  const measureButton = toggle("Measure", "Distance between two clicks", () => setMeasuring(!measured), "false");
  const fixButton = toggle("Fix …", "Tell where the vehicle was: click there on the map, or type it here", () =>
    form.isOpen() ? form.close() : form.open(vehicleNow()?.at ?? (origin && map.getCenter())),
  );
  const distance = el("span", {class: "num", "data-field": "distance", role: "status"});
  const routes = el("div", {
    class: "routes",
    "data-field": "routes",
    "aria-label": "Routes of guidance",
    role: "group",
    hidden: true,
  });
  const pointer = el("p", {class: "overlay pointer num", "data-field": "pointer", hidden: true}, "–");
  const words = el("p", {class: "overlay words", "data-field": "place", role: "status"});
  const box = el("div", {class: "map", id: "map", role: "application", "aria-label": "Map"});
  const north = el("p", {class: "overlay north", title: "North is up"}, el("span", {"aria-hidden": "true"}, "▲"), "N");
  const legend = makeLegend();
  const form = makeFixForm(() => {
    fixButton.setAttribute("aria-pressed", String(form.isOpen()));
    chart?.draw();
  });
  const root = el(
    "section",
    {class: "card mappanel", "aria-label": "Map"},
    el("div", {class: "mapbar"}, followButton, fitButton, measureButton, fixButton, distance, routes),
    el("div", {class: "mapbox"}, box, north, el("div", {class: "above"}, words, form.verdict), form.root, pointer),
    legend.root,
  );

  root.addEventListener("keydown", (event) => event.key === "Escape" && form.close());

  function setFollow(value) {
    follow = value;
    followButton.setAttribute("aria-pressed", String(value));
    if (value) centre();
  }
  function setMeasuring(value) {
    measured = value ? [] : null;
    put(distance, value ? "click two points" : "");
    measureButton.setAttribute("aria-pressed", String(value));
    box.classList.toggle("measuring", value);
    chart?.draw();
  }
  /** The map stands still while somebody points at it. */
  function centre() {
    const vehicle = vehicleNow();
    if (vehicle && map && !form.isOpen() && !measured) map.setView(vehicle.at, map.getZoom(), {animate: false});
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
  function choose({latlng, containerPoint}) {
    if (measured) measure(latlng);
    else if (mayOrder()) form.open(latlng, containerPoint.x > map.getSize().x / 2);
  }
  function measure(latlng) {
    if (measured.length >= 2) measured = [];
    measured.push(latlng);
    if (measured.length === 2) {
      const {north, east} = metresOf(...measured);
      const bearing = units.bearing((Math.atan2(east, north) * 180) / Math.PI);
      put(distance, `${units.length(Math.hypot(north, east), 1)} at ${bearing}`);
    } else {
      put(distance, "click the second point");
    }
    chart.draw();
  }
  function point({latlng}) {
    const local = origin ? metresOf(origin, latlng) : null;
    const metres = local ? ` · ${units.length(local.north, 0)} N ${units.length(local.east, 0)} E` : "";
    pointer.hidden = false;
    put(pointer, `${units.latitude(latlng.lat)} ${units.longitude(latlng.lng)}${metres}`);
  }
  function showRoutes() {
    routes.hidden = store.routes.length === 0;
    const make = (route) => el("p", {"data-route": route.publisher});
    reconcile(
      routes,
      store.routes,
      (route) => route.publisher,
      make,
      (line, route) => {
        put(line, routeText(route));
        line.className = isOld(route) ? "bad-text" : "";
      },
    );
  }
  /** What is known of the place, also while nothing comes from the console. */
  function say() {
    const text = placeWords();
    put(words, text);
    words.hidden = text === "";
    words.classList.toggle("middle", !origin);
    box.classList.toggle("nowhere", !origin);
    chart?.draw();
  }
  function useTiles() {
    if (!map || tiles || !store.session.tiles) return;
    tiles = tileLayer("/tiles/{z}/{x}/{y}.png", {maxZoom: 22, maxNativeZoom: 18}).addTo(map);
    chart.draw();
  }
  function drawScale() {
    if (!map) return;
    scale?.remove();
    scale = L.control.scale({imperial: units.lengthUnit() === "ft", metric: units.lengthUnit() === "m"}).addTo(map);
    chart?.draw();
  }
  function begin() {
    map = L.map(box, {
      attributionControl: false,
      zoomSnap: 0.25,
      minZoom: 3,
      maxZoom: 22,
      doubleClickZoom: false, // a click places a fix
      fadeAnimation: false,
      zoomAnimation: false,
    });
    map.setView([0, 0], 3);
    drawScale();
    chart = new Chart({
      origin: () => origin,
      grid: () => !tiles,
      measured: () => measured ?? [],
      candidate: form.candidate,
      vehicle: vehicleNow,
    }).addTo(map);
    map.on("click contextmenu", choose);
    map.on("mousemove", point);
    map.on("mouseout", () => (pointer.hidden = true));
    map.on("dragstart", () => setFollow(false));
    // The corner that is seen stays where it is: what somebody points at must not move away.
    new ResizeObserver(() => map.invalidateSize({animate: false, pan: false})).observe(box);
    useTiles();
    setInterval(say, 500);
  }
  function allow() {
    fixButton.hidden = !mayOrder();
    box.classList.toggle("tells", mayOrder());
    if (!mayOrder()) form.close();
  }
  onPrefs(drawScale);
  onSession(useTiles);
  onSession(allow);
  allow();

  return {
    root,
    follow: () => setFollow(!follow),
    /** Into another place of the page. */
    showIn(place) {
      place.prepend(root);
      if (!map) begin();
      map.invalidateSize({animate: false, pan: false});
      if (follow) centre();
    },
    update() {
      if (!origin) {
        const place = knownPlace();
        if (place) {
          origin = place;
          map.setView(origin, kNear, {animate: false});
        }
      }
      if (follow) centre();
      showRoutes();
      legend.update();
      form.update();
      say();
    },
  };
}
