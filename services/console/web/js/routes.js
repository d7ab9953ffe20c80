// Where guidance means to go: which waypoints lie behind, which leg is steered, and how old all that is.
import {store} from "./store.js";
import {duration} from "./units.js";

const kOldS = 3; // three of a publisher's periods, as the service counts

/** Seconds since it was last said; goes on while the console itself is silent. */
export const ageOf = (route, nowMs = performance.now()) => route.age_s + (nowMs - store.routesAt) / 1000;
export const isOld = (route, nowMs = performance.now()) => route.old || ageOf(route, nowMs) > kOldS;

/** What people call a waypoint. */
export const waypointName = (route, i) => route.points[i][0] || String(route.first_number + i);

/** A route as points and legs, each "passed", "active" or "ahead". Places are [latitude, longitude] in degrees. */
export function shapeOf(route) {
  const state = (i) => (i < route.active ? "passed" : i === route.active ? "active" : "ahead");
  const points = route.points.map(([, lat, lon], i) => ({at: [lat, lon], name: waypointName(route, i), state: state(i)}));
  const begun = route.leg_start.every((value) => value !== null);
  const legs = [];
  points.forEach((to, i) => {
    const before = i > 0 ? points[i - 1].at : null;
    const from = i === route.active && begun ? route.leg_start : before;
    if (from) legs.push({from, to: to.at, state: to.state});
  });
  // The way back to the first one, where it is not being steered already.
  const whole = points.length === (route.mission_count || points.length);
  if (route.repeats && whole && points.length > 1 && route.active > 0)
    legs.push({from: points[points.length - 1].at, to: points[0].at, state: "ahead"});
  return {points, legs};
}

/** One line for people: whose route, how far, and whether it can be believed. */
export function routeText(route, nowMs = performance.now()) {
  const all = route.mission_count || route.points.length;
  const done = route.active >= route.points.length;
  const number = route.first_number + route.active;
  const name = done ? "" : route.points[route.active][0];
  const where = done ? `all ${all} waypoints passed` : `to waypoint ${number} of ${all}${name ? `, ${name}` : ""}`;
  const age = duration(ageOf(route, nowMs));
  return `${route.publisher}: ${where}` + (isOld(route, nowMs) ? ` · ✖ old, last heard ${age} ago` : ` · ${age} old`);
}
