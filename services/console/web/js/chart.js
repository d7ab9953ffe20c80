// What lies on the map, on one canvas: metric grid, track, fixes, routes, marks, the vehicle and its ellipse. Thousands of
// points as elements of their own would be too many for a tablet.
import {colour} from "./prefs.js";
import {isOld, shapeOf} from "./routes.js";
import {store} from "./store.js";
import * as units from "./units.js";

const kEarthM = 6371000;
const kK95 = 2.4477; // of two dimensions, 95 %

/** Metres north and east of an origin, and back: flat earth, for display. */
export const metresOf = (origin, {lat, lng}) => ({
  north: ((lat - origin.lat) * Math.PI * kEarthM) / 180,
  east: ((lng - origin.lng) * Math.PI * kEarthM * Math.cos((origin.lat * Math.PI) / 180)) / 180,
});
export const degreesOf = (origin, {north, east}) =>
  L.latLng(
    origin.lat + (north / kEarthM) * (180 / Math.PI),
    origin.lng + (east / (kEarthM * Math.cos((origin.lat * Math.PI) / 180))) * (180 / Math.PI),
  );

/** The 95 % ellipse of a horizontal covariance [nn, ne, ee] as offsets in metres. */
export function ellipse([nn, ne, ee]) {
  const mean = (nn + ee) / 2;
  const split = Math.hypot((nn - ee) / 2, ne);
  const major = Math.sqrt(Math.max(0, mean + split)) * kK95;
  const minor = Math.sqrt(Math.max(0, mean - split)) * kK95;
  const turn = 0.5 * Math.atan2(2 * ne, nn - ee); // of the major axis from north
  return Array.from({length: 49}, (_, i) => {
    const a = (i / 48) * 2 * Math.PI;
    const along = major * Math.cos(a);
    const across = minor * Math.sin(a);
    return {
      north: along * Math.cos(turn) - across * Math.sin(turn),
      east: along * Math.sin(turn) + across * Math.cos(turn),
    };
  });
}

export const Chart = L.Layer.extend({
  initialize(options) {
    L.setOptions(this, options);
  },
  onAdd(map) {
    this.map = map;
    this.canvas = L.DomUtil.create("canvas", "leaflet-zoom-hide", map.getPane("overlayPane"));
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "Track, fixes and uncertainty of the vehicle");
    map.on("moveend zoomend resize viewreset move", this.draw, this);
    this.draw();
  },
  onRemove(map) {
    map.off("moveend zoomend resize viewreset move", this.draw, this);
    this.canvas.remove();
  },
  draw() {
    const size = this.map.getSize();
    const ratio = window.devicePixelRatio || 1;
    if (this.canvas.width !== size.x * ratio || this.canvas.height !== size.y * ratio) {
      this.canvas.width = size.x * ratio;
      this.canvas.height = size.y * ratio;
      this.canvas.style.width = size.x + "px";
      this.canvas.style.height = size.y + "px";
    }
    L.DomUtil.setPosition(this.canvas, this.map.containerPointToLayerPoint([0, 0]));
    const c = this.canvas.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, size.x, size.y);
    this.c = c;
    if (this.options.origin()) {
      if (this.options.grid()) this.grid(size);
      this.track();
      this.fixes();
      this.routes();
      this.marks();
      this.vehicle();
    }
    this.measure();
  },
  point(lat, lng) {
    return this.map.latLngToContainerPoint([lat, lng]);
  },
  line(points, stroke, width, dash = []) {
    const {c} = this;
    c.beginPath();
    points.forEach((p, i) => (i === 0 ? c.moveTo(p.x, p.y) : c.lineTo(p.x, p.y)));
    c.strokeStyle = stroke;
    c.lineWidth = width;
    c.setLineDash(dash);
    c.stroke();
    c.setLineDash([]);
  },
  grid(size) {
    const origin = this.options.origin();
    const bounds = this.map.getBounds();
    const from = metresOf(origin, bounds.getSouthWest());
    const to = metresOf(origin, bounds.getNorthEast());
    const wanted = units.toLength(((to.east - from.east) / size.x) * 110);
    const power = 10 ** Math.floor(Math.log10(Math.max(wanted, 0.1)));
    const nice = [1, 2, 5, 10].map((k) => k * power).find((step) => step >= wanted) ?? 10 * power;
    const step = nice / units.toLength(1);
    const {c} = this;
    c.font = "11px system-ui";
    c.fillStyle = colour("soft");
    const label = (value) => `${Math.round((value / step) * nice * 10) / 10}`;
    for (let east = Math.ceil(from.east / step) * step; east <= to.east; east += step) {
      const p = this.map.latLngToContainerPoint(degreesOf(origin, {north: from.north, east}));
      this.line(
        [
          {x: p.x, y: 0},
          {x: p.x, y: size.y},
        ],
        colour("grid"),
        Math.abs(east) < step / 2 ? 2 : 1,
      );
      c.fillText(`${label(east)} ${units.lengthUnit()} E`, p.x + 3, size.y - 28);
    }
    for (let north = Math.ceil(from.north / step) * step; north <= to.north; north += step) {
      const p = this.map.latLngToContainerPoint(degreesOf(origin, {north, east: from.east}));
      this.line(
        [
          {x: 0, y: p.y},
          {x: size.x, y: p.y},
        ],
        colour("grid"),
        Math.abs(north) < step / 2 ? 2 : 1,
      );
      c.fillText(`${label(north)} ${units.lengthUnit()} N`, 48, p.y - 3);
    }
  },
  track() {
    const lat = store.nav.column("lat_deg");
    const lon = store.nav.column("lon_deg");
    const points = [];
    for (let i = 0; i < lat.length; ++i)
      if (lat[i] !== null && lon[i] !== null) points.push(this.point(lat[i], lon[i]));
    this.line(points, colour("track"), 2);
  },
  /** Shape says the source, a cross says that it was refused: colour only repeats it. */
  fixes() {
    const {c} = this;
    for (const fix of store.fixes) {
      const p = this.point(fix.lat, fix.lon);
      const refused = fix.verdict !== null && fix.verdict !== 0;
      const r = {usbl: 6, fix: 7}[fix.source] ?? 3.5;
      c.beginPath();
      c.lineWidth = 2;
      c.strokeStyle = refused ? colour("bad") : colour({usbl: "s2", fix: "s1"}[fix.source] ?? "s3");
      if (refused) {
        c.moveTo(p.x - r, p.y - r);
        c.lineTo(p.x + r, p.y + r);
        c.moveTo(p.x + r, p.y - r);
        c.lineTo(p.x - r, p.y + r);
      } else if (fix.source === "usbl") {
        c.moveTo(p.x, p.y - r);
        c.lineTo(p.x + r, p.y);
        c.lineTo(p.x, p.y + r);
        c.lineTo(p.x - r, p.y);
        c.closePath();
      } else if (fix.source === "fix") {
        c.moveTo(p.x, p.y - r);
        c.lineTo(p.x + r, p.y + r);
        c.lineTo(p.x - r, p.y + r);
        c.closePath();
      } else {
        c.arc(p.x, p.y, r, 0, 2 * Math.PI);
      }
      c.stroke();
    }
  },
  /** Of guidance: the leg that is steered is thick, what is behind thin, what is ahead or old dashed. */
  routes() {
    const {c} = this;
    c.font = "12px system-ui";
    for (const route of store.routes) {
      const old = isOld(route);
      const {points, legs} = shapeOf(route);
      for (const {from, to, state} of legs) {
        const ink = colour(old || state === "passed" ? "soft" : "s4");
        const dash = old ? [2, 6] : state === "ahead" ? [8, 6] : [];
        this.line([this.point(...from), this.point(...to)], ink, state === "active" ? 4 : 1.5, dash);
      }
      for (const {at, name, state} of points) {
        const p = this.point(...at);
        const r = state === "passed" ? 3 : 6;
        c.strokeStyle = colour(old || state === "passed" ? "soft" : "s4");
        c.lineWidth = 2;
        c.strokeRect(p.x - r, p.y - r, 2 * r, 2 * r);
        if (state === "active") c.strokeRect(p.x - r - 4, p.y - r - 4, 2 * r + 8, 2 * r + 8);
        c.fillStyle = colour(state === "passed" ? "soft" : "ink");
        c.fillText(state === "passed" ? `✓ ${name}` : name, p.x + 13, p.y - 6);
      }
      const at = points[Math.min(route.active, points.length - 1)];
      const p = this.point(...at.at);
      c.fillStyle = colour("soft");
      c.fillText(old ? `✖ old · ${route.publisher}` : route.publisher, p.x + 13, p.y + 19);
    }
  },
  /** Of the configuration. */
  marks() {
    const {c} = this;
    c.font = "12px system-ui";
    for (const {name, lat_deg, lon_deg} of store.session.waypoints ?? []) {
      const p = this.point(lat_deg, lon_deg);
      c.strokeStyle = colour("s4");
      c.fillStyle = colour("ink");
      c.lineWidth = 2;
      c.strokeRect(p.x - 5, p.y - 5, 10, 10);
      c.fillText(name, p.x + 9, p.y + 4);
    }
  },
  vehicle() {
    const nav = store.tick?.status.navigation;
    if (!nav || nav.lat_deg === null) return;
    const at = L.latLng(nav.lat_deg, nav.lon_deg);
    const covariance = store.tick.horizontal_covariance_m2;
    if (covariance.length === 3 && covariance.every(Number.isFinite)) {
      const ring = ellipse(covariance).map((offset) => this.map.latLngToContainerPoint(degreesOf(at, offset)));
      this.line(ring, colour("caution"), 2, [6, 4]);
    }
    const {c} = this;
    const p = this.point(nav.lat_deg, nav.lon_deg);
    c.save();
    c.translate(p.x, p.y);
    c.rotate((((nav.rpy_deg[2] ?? 0) % 360) * Math.PI) / 180);
    c.beginPath();
    c.moveTo(0, -14);
    c.lineTo(8, 10);
    c.lineTo(0, 5);
    c.lineTo(-8, 10);
    c.closePath();
    c.fillStyle = colour("accent");
    c.strokeStyle = colour("card");
    c.lineWidth = 2;
    c.fill();
    c.stroke();
    c.restore();
  },
  measure() {
    const ends = this.options.measured();
    if (ends.length === 0) return;
    const points = ends.map((end) => this.map.latLngToContainerPoint(end));
    this.line(points, colour("s4"), 2, [3, 3]);
    for (const p of points) {
      this.c.beginPath();
      this.c.arc(p.x, p.y, 4, 0, 2 * Math.PI);
      this.c.fillStyle = colour("s4");
      this.c.fill();
    }
  },
});
