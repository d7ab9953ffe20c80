// Where the vehicle is as far as this page knows, by the page's own clock, and what to say where that is not known.
import {store} from "../store.js";
import * as units from "../units.js";

const kOldS = 2; // an older position is a last known one

const given = (place) => place && typeof place.lat === "number" && typeof place.lng === "number";

/** {at, yaw, age_s, old} or null: as navigation says, else as it last said. */
export function vehicleNow(nowMs = performance.now()) {
  const nav = store.tick?.status.navigation;
  if (nav && given({lat: nav.lat_deg, lng: nav.lon_deg})) {
    const age_s = nav.age_s + (nowMs - store.tickAt) / 1000;
    return {at: {lat: nav.lat_deg, lng: nav.lon_deg}, yaw: nav.rpy_deg[2] ?? NaN, age_s, old: age_s > kOldS};
  }
  const lat = store.nav.column("lat_deg");
  const row = lat.findLastIndex((value) => value !== null);
  if (!store.tick || row < 0) return null;
  const [time, lon, yaw] = ["t", "lon_deg", "yaw_deg"].map((name) => store.nav.column(name)[row]);
  const age_s = (store.tick.utc_ms - time + nowMs - store.tickAt) / 1000;
  return {at: {lat: lat[row], lng: lon}, yaw: yaw ?? NaN, age_s, old: true};
}

/** The first place of anything that there is to see: the map begins there. */
export function knownPlace() {
  const row = store.nav.column("lat_deg").findIndex((value) => value !== null);
  const fix = store.fixes[0];
  const point = store.routes[0]?.points[0];
  const beacon = store.tick?.beacons?.[0];
  const mark = store.session.waypoints?.[0];
  const places = [
    row >= 0 && {lat: store.nav.column("lat_deg")[row], lng: store.nav.column("lon_deg")[row]},
    fix && {lat: fix.lat, lng: fix.lon},
    point && {lat: point[1], lng: point[2]},
    beacon && {lat: beacon.lat_deg, lng: beacon.lon_deg},
    mark && {lat: mark.lat_deg, lng: mark.lon_deg},
  ];
  return places.find(given) ?? null;
}

/** A sentence where the map does not show where the vehicle is; empty where it does. */
export function placeWords(nowMs = performance.now()) {
  const vehicle = vehicleNow(nowMs);
  if (vehicle?.old) return `Last known position, ${units.duration(vehicle.age_s)} old`;
  if (vehicle) return "";
  const nav = store.tick?.status.navigation;
  if (!store.tick) return "No position yet: the console has said nothing";
  if (!nav) return "No position yet: navigation is not heard";
  const phase = store.tick.status.alignment?.phase ?? "none";
  return phase === "aligned" || phase === "none"
    ? "No position yet: navigation has no first fix"
    : `No position yet: navigation is aligning, ${units.words(phase)}`;
}
