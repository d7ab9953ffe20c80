// What lies on the map, on one canvas: metric grid, track, fixes, ranges, routes, marks, the vehicle and its ellipse.
// Thousands of points as elements of their own would be too many for a tablet.
import {colour} from "../prefs.js";
import {isOld, shapeOf} from "../routes.js";
import {store} from "../store.js";
import * as units from "../units.js";
import {circle, degreesOf, ellipse, horizontalRange, metresOf, runsOf} from "./geometry.js";
import {fixInk, trackLook} from "./looks.js";

const kFont = "12px system-ui, 'DejaVu Sans', sans-serif";
const kOldRangeS = 10; // a beacon that was not heard for longer is drawn faintly

/** `options`: origin(), grid(), measured(), candidate(), vehicle(): {at, old} or null. */
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
  /** Once a picture of the browser, however often it is asked for. */
  draw() {
    this.waiting ??= requestAnimationFrame(() => {
      this.waiting = null;
      if (this.canvas.checkVisibility()) this.paint();
    });
  },
  paint() {
    const size = this.map.getSize();
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(size.x * ratio), Math.round(size.y * ratio)];
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.canvas.style.width = size.x + "px";
      this.canvas.style.height = size.y + "px";
    }
    L.DomUtil.setPosition(this.canvas, this.map.containerPointToLayerPoint([0, 0]));
    const c = this.canvas.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, size.x, size.y);
    c.font = kFont;
    this.c = c;
    this.inks = new Map(); // of this picture: asking the style for each of a thousand fixes would be slow
    const origin = this.options.origin();
    if (origin) {
      if (this.options.grid()) this.grid(origin, size);
      this.ranges();
      this.track();
      this.fixes();
      this.routes();
      this.marks();
      this.vehicle();
    }
    this.measure();
    this.candidate();
  },
  ink(name) {
    if (!this.inks.has(name)) this.inks.set(name, colour(name));
    return this.inks.get(name);
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
  ringAround(at, offsets, stroke, width, dash) {
    const points = offsets.map((offset) => this.map.latLngToContainerPoint(degreesOf(at, offset)));
    this.line(points, stroke, width, dash);
  },
  /** Words on a ground of their own, so that lines behind them do not cross them out. */
  words(text, x, y, ink = "ink") {
    const {c} = this;
    c.fillStyle = this.ink("map");
    c.globalAlpha = 0.75;
    c.fillRect(x - 2, y - 11, c.measureText(text).width + 4, 15);
    c.globalAlpha = 1;
    c.fillStyle = this.ink(ink);
    c.fillText(text, x, y);
  },
  /** East along the upper edge, north along the left one; nothing under the zoom buttons, the scale or the arrow of north. */
  grid(origin, size) {
    const bounds = this.map.getBounds();
    const from = metresOf(origin, bounds.getSouthWest());
    const to = metresOf(origin, bounds.getNorthEast());
    const wanted = units.toLength(((to.east - from.east) / size.x) * 110);
    const power = 10 ** Math.floor(Math.log10(Math.max(wanted, 0.1)));
    const nice = [1, 2, 5, 10].map((k) => k * power).find((step) => step >= wanted) ?? 10 * power;
    const step = nice / units.toLength(1);
    const label = (value) => `${Math.round((value / step) * nice * 10) / 10}`;
    for (let east = Math.ceil(from.east / step) * step; east <= to.east; east += step) {
      const {x} = this.map.latLngToContainerPoint(degreesOf(origin, {north: from.north, east}));
      const ends = [
        {x, y: 0},
        {x, y: size.y},
      ];
      this.line(ends, this.ink("grid"), Math.abs(east) < step / 2 ? 2 : 1);
      if (x > 50 && x < size.x - 120) this.words(`${label(east)} ${units.lengthUnit()} E`, x + 4, 14, "soft");
    }
    for (let north = Math.ceil(from.north / step) * step; north <= to.north; north += step) {
      const {y} = this.map.latLngToContainerPoint(degreesOf(origin, {north, east: from.east}));
      const ends = [
        {x: 0, y},
        {x: size.x, y},
      ];
      this.line(ends, this.ink("grid"), Math.abs(north) < step / 2 ? 2 : 1);
      if (y > 105 && y < size.y - 45) this.words(`${label(north)} ${units.lengthUnit()} N`, 6, y - 4, "soft");
    }
  },
  track() {
    const lat = store.nav.column("lat_deg");
    const lon = store.nav.column("lon_deg");
    for (const {mode, from, to} of runsOf(lat, store.nav.column("mode"))) {
      const points = [];
      for (let i = from; i <= to; ++i) points.push(this.point(lat[i], lon[i]));
      const {ink, dash} = trackLook(store.modes[mode]);
      this.line(points, this.ink(ink), 2.5, dash);
    }
  },
  /** Shape says the source, a cross says that it was refused: colour only repeats it. */
  fixes() {
    const size = this.map.getSize();
    for (const fix of store.fixes) {
      const p = this.point(fix.lat, fix.lon);
      if (p.x < -9 || p.y < -9 || p.x > size.x + 9 || p.y > size.y + 9) continue;
      const refused = fix.verdict !== null && fix.verdict !== 0;
      const r = {usbl: 6, fix: 7}[fix.source] ?? 3.5;
      this.mark(p, refused ? "cross" : fix.source, r, refused ? "bad" : fixInk(fix.source));
    }
  },
  mark(p, shape, r, ink) {
    const {c} = this;
    const corners = {
      usbl: [
        [0, -r],
        [r, 0],
        [0, r],
        [-r, 0],
      ],
      fix: [
        [0, -r],
        [r, r],
        [-r, r],
      ],
    }[shape];
    c.beginPath();
    if (shape === "cross") {
      c.moveTo(p.x - r, p.y - r);
      c.lineTo(p.x + r, p.y + r);
      c.moveTo(p.x + r, p.y - r);
      c.lineTo(p.x - r, p.y + r);
    } else if (corners) {
      corners.forEach(([x, y], i) => (i === 0 ? c.moveTo(p.x + x, p.y + y) : c.lineTo(p.x + x, p.y + y)));
      c.closePath();
    } else {
      c.arc(p.x, p.y, r, 0, 2 * Math.PI);
    }
    c.lineWidth = 2;
    c.strokeStyle = this.ink(ink);
    c.stroke();
  },
  /** Beacons as crosses in a ring, and how far away the vehicle was heard. */
  ranges() {
    const {c} = this;
    const depth = store.tick?.status.navigation?.depth_m ?? null;
    for (const beacon of store.tick?.beacons ?? []) {
      const at = {lat: beacon.lat_deg, lng: beacon.lon_deg};
      const refused = beacon.verdict !== null && beacon.verdict !== 0;
      const old = beacon.age_s > kOldRangeS;
      const ink = this.ink(old ? "soft" : refused ? "bad" : "s5");
      const far = horizontalRange(beacon.range_m, beacon.depth_m, depth);
      this.ringAround(at, circle(far), ink, 1.5, refused ? [2, 5] : [10, 5]);
      const p = this.point(at.lat, at.lng);
      c.beginPath();
      c.arc(p.x, p.y, 7, 0, 2 * Math.PI);
      c.moveTo(p.x - 4, p.y);
      c.lineTo(p.x + 4, p.y);
      c.moveTo(p.x, p.y - 4);
      c.lineTo(p.x, p.y + 4);
      c.strokeStyle = ink;
      c.lineWidth = 2;
      c.stroke();
      const state = old ? ` · old, ${units.duration(beacon.age_s)}` : refused ? " · ✕ refused" : "";
      this.words(`beacon ${beacon.name} · ${units.length(beacon.range_m)}${state}`, p.x + 12, p.y - 8);
    }
  },
  /** Of guidance: the leg that is steered is thick, what is behind thin, what is ahead or old dashed. */
  routes() {
    const {c} = this;
    for (const route of store.routes) {
      const old = isOld(route);
      const {points, legs} = shapeOf(route);
      for (const {from, to, state} of legs) {
        const ink = this.ink(old || state === "passed" ? "soft" : "s4");
        const dash = old ? [2, 6] : state === "ahead" ? [8, 6] : [];
        this.line([this.point(...from), this.point(...to)], ink, state === "active" ? 4 : 1.5, dash);
      }
      for (const {at, name, state} of points) {
        const p = this.point(...at);
        const r = state === "passed" ? 3 : 6;
        c.strokeStyle = this.ink(old || state === "passed" ? "soft" : "s4");
        c.lineWidth = 2;
        c.strokeRect(p.x - r, p.y - r, 2 * r, 2 * r);
        if (state === "active") c.strokeRect(p.x - r - 4, p.y - r - 4, 2 * r + 8, 2 * r + 8);
        this.words(state === "passed" ? `✓ ${name}` : name, p.x + 14, p.y - 8, state === "passed" ? "soft" : "ink");
      }
      if (!old || points.length === 0) continue;
      const p = this.point(...points[Math.min(route.active, points.length - 1)].at);
      this.words(`✖ old · ${route.publisher}`, p.x + 14, p.y + 20, "soft");
    }
  },
  /** Of the configuration. */
  marks() {
    const {c} = this;
    for (const {name, lat_deg, lon_deg} of store.session.waypoints ?? []) {
      const p = this.point(lat_deg, lon_deg);
      c.strokeStyle = this.ink("s4");
      c.lineWidth = 2;
      c.strokeRect(p.x - 5, p.y - 5, 10, 10);
      this.words(name, p.x + 10, p.y + 4);
    }
  },
  /** Filled where navigation says that it is, hollow where it was last known to be. */
  vehicle() {
    const vehicle = this.options.vehicle();
    if (!vehicle) return;
    const {at, old, yaw} = vehicle;
    const covariance = store.tick.horizontal_covariance_m2;
    if (!old && covariance.length === 3 && covariance.every(Number.isFinite))
      this.ringAround(at, ellipse(covariance), this.ink("caution"), 2, [6, 4]);
    const {c} = this;
    const p = this.point(at.lat, at.lng);
    c.save();
    c.translate(p.x, p.y);
    c.beginPath();
    if (Number.isFinite(yaw)) {
      c.rotate((yaw * Math.PI) / 180);
      c.moveTo(0, -16);
      c.lineTo(9, 11);
      c.lineTo(0, 6);
      c.lineTo(-9, 11);
      c.closePath();
    } else {
      c.arc(0, 0, 8, 0, 2 * Math.PI);
    }
    c.fillStyle = this.ink(old ? "map" : "accent");
    c.strokeStyle = this.ink(old ? "bad" : "card");
    c.lineWidth = 2;
    c.fill();
    c.stroke();
    c.restore();
  },
  measure() {
    const ends = this.options.measured();
    const points = ends.map((end) => this.map.latLngToContainerPoint(end));
    this.line(points, this.ink("s4"), 2, [3, 3]);
    for (const p of points) {
      this.c.beginPath();
      this.c.arc(p.x, p.y, 4, 0, 2 * Math.PI);
      this.c.fillStyle = this.ink("s4");
      this.c.fill();
    }
  },
  /** The place of a fix that is about to be told, with its 1 sigma. */
  candidate() {
    const told = this.options.candidate();
    if (!told) return;
    const at = {lat: told.lat_deg, lng: told.lon_deg};
    if (told.sigma_m > 0) this.ringAround(at, circle(told.sigma_m), this.ink("s4"), 1.5, [4, 4]);
    const p = this.point(at.lat, at.lng);
    this.mark(p, "fix", 9, "s4");
    this.line(
      [
        {x: p.x - 16, y: p.y},
        {x: p.x + 16, y: p.y},
      ],
      this.ink("s4"),
      1,
    );
    this.line(
      [
        {x: p.x, y: p.y - 16},
        {x: p.x, y: p.y + 16},
      ],
      this.ink("s4"),
      1,
    );
  },
});
