// What the map and the overview make of what is known, without a browser.
import assert from "node:assert/strict";
import test from "node:test";
import {snapshot, tick, web} from "./page.mjs";

const {store, takeSnapshot, takeTick} = await import(new URL("store.js", web));
const {circle, degreesOf, ellipse, horizontalRange, metresOf, runsOf} = await import(new URL("map/geometry.js", web));
const {knownPlace, placeWords, vehicleNow} = await import(new URL("map/place.js", web));
const {trackLook} = await import(new URL("map/looks.js", web));
const {isPassed, limitWords, nextLimit} = await import(new URL("uncertainty.js", web));
const {sensorState, serviceState} = await import(new URL("strip.js", web));
const units = await import(new URL("units.js", web));

const near = (a, b, by) => assert.ok(Math.abs(a - b) <= by, `${a} is not ${b}`);

test("metres and degrees are there and back", () => {
  const origin = {lat: 36.4, lng: 127.4};
  const back = metresOf(origin, degreesOf(origin, {north: 120, east: -45}));
  near(back.north, 120, 1e-6);
  near(back.east, -45, 1e-6);
});

test("the ellipse holds 95 % along each axis, turned as the covariance is", () => {
  const far = (points) => points.map(({north, east}) => Math.hypot(north, east));
  near(Math.max(...far(ellipse([9, 0, 4]))), 3 * 2.4477, 1e-3);
  near(Math.min(...far(ellipse([9, 0, 4]))), 2 * 2.4477, 1e-3);
  const [first] = ellipse([5, 4, 5]); // the major axis at 45 degrees
  near(first.north, first.east, 1e-9);
  near(Math.max(...far(circle(7))), 7, 1e-9);
});

test("a slant range reaches less far on the map the deeper the beacon is", () => {
  near(horizontalRange(50, 40, 10), 40, 1e-9);
  assert.equal(horizontalRange(50, null, 10), 50, "the beacon's depth is not told");
  assert.equal(horizontalRange(50, 40, undefined), 50, "the vehicle's is not known");
  assert.equal(horizontalRange(20, 40, 10), 0, "nearer than it can be");
});

test("a track is runs of one mode that touch, and a gap is none", () => {
  const lat = [1, 1, 1, null, 1, 1];
  const runs = runsOf(lat, [2, 2, 4, 4, 4, 5]);
  assert.deepEqual(runs, [
    {mode: 2, from: 0, to: 2},
    {mode: 4, from: 2, to: 2},
    {mode: 4, from: 4, to: 5},
    {mode: 5, from: 5, to: 5},
  ]);
  assert.deepEqual(runsOf([1, 1], []), [{mode: null, from: 0, to: 1}], "a console that does not tell modes");
  assert.notDeepEqual(trackLook("gps_aided").dash, trackLook("dead_reckoning").dash, "not by colour alone");
  assert.equal(trackLook(undefined).words, "not aligned");
});

const navigation = (more = {}) => ({
  mode: "gps_aided",
  lat_deg: 36.4,
  lon_deg: 127.4,
  age_s: 0.1,
  rpy_deg: [0, 0, 90],
  ...more,
});
const told = (number, status, more = {}) => tick(number, number * 100, {utc_ms: number * 100, status, ...more});
const fresh = (status, more) => {
  takeSnapshot(snapshot());
  store.tick = null;
  if (status) assert.ok(takeTick(told(1, status, more)));
};
const nothing = {nav: [], fixes: [], verdicts: []};

test("without any position the map says why, and has nowhere to begin", () => {
  fresh(null);
  assert.match(placeWords(), /^No position yet: the console/);
  fresh({navigation: null}, nothing);
  assert.equal(vehicleNow(), null);
  assert.equal(knownPlace(), null);
  assert.match(placeWords(), /^No position yet: navigation is not heard/);
  const none = navigation({lat_deg: null, lon_deg: null});
  fresh({navigation: none, alignment: {phase: "averaging"}}, nothing);
  assert.match(placeWords(), /^No position yet: navigation is aligning, averaging/);
  fresh({navigation: none, alignment: {phase: "aligned"}}, nothing);
  assert.match(placeWords(), /no first fix/);
  fresh({navigation: none}, {...nothing, fixes: [[100, 36.5, 127.5, 1, "gps", "gps", 1]]});
  assert.deepEqual(knownPlace(), {lat: 36.5, lng: 127.5}, "a fix is somewhere to begin");
  assert.match(placeWords(), /^No position yet/);
});

test("a position grows old while nobody says it again, and stays on the map", () => {
  fresh({navigation: navigation()});
  assert.equal(placeWords(store.tickAt), "");
  const now = vehicleNow(store.tickAt);
  assert.deepEqual([now.at, now.yaw, now.old], [{lat: 36.4, lng: 127.4}, 90, false]);
  assert.ok(vehicleNow(store.tickAt + 3000).old, "the console is silent");
  assert.match(placeWords(store.tickAt + 3000), /^Last known position, 3\.1 s old$/);
  takeTick(told(11, {navigation: navigation({lat_deg: null, lon_deg: null})}, nothing));
  assert.deepEqual(vehicleNow(store.tickAt).at, {lat: 36.4, lng: 127.4}, "navigation began anew");
  assert.match(placeWords(store.tickAt), /^Last known position, 1\.0 s old$/);
});

test("the limit that is passed next, and when", () => {
  const limit = (metres, seconds, more = {}) => ({
    name: "horizontal",
    without: "",
    limit: metres,
    time_to_limit_s: seconds,
    never: false,
    ...more,
  });
  const forecast = [limit(100, 300), limit(10, 65), limit(10, 5, {without: "all"})];
  assert.equal(nextLimit(forecast).limit, 10);
  assert.equal(limitWords(nextLimit(forecast)), "in 65.0 s");
  const later = [limit(10, 0), limit(100, 240)];
  assert.equal(nextLimit(later).limit, 100);
  assert.ok(isPassed(later[0]));
  assert.equal(limitWords(nextLimit([limit(10, 0)])), "✖ passed");
  assert.equal(limitWords(nextLimit([limit(10, null, {never: true})])), "not reached");
  assert.equal(nextLimit([limit(10, null)]), undefined, "not known is neither passed nor to come");
  assert.equal(nextLimit([]), undefined);
});

test("a sensor and a service say in a word how they are", () => {
  const heard = {presence: "present", rate_hz: 4.96};
  const line = (last, kind = "dvl") => ({kind, last});
  assert.deepEqual(sensorState(line("used"), heard), ["✔", "5.0 Hz", "good-text"]);
  assert.deepEqual(sensorState(line("used"), {presence: "missing"}), ["✖", "missing", "bad-text"]);
  assert.equal(sensorState(line("used"), {presence: "stale", age_s: 3})[1], "silent 3.0 s");
  assert.deepEqual(sensorState(line("out_of_range"), heard), ["✖", "out of range", "bad-text"]);
  assert.deepEqual(sensorState(line("source_disabled"), heard), ["○", "off", "soft"]);
  assert.deepEqual(sensorState(line("used", "fix"), {presence: "missing"}), ["✔", "used", "good-text"]);
  assert.deepEqual(sensorState(undefined, {presence: "missing"})[0], "✖");
  assert.deepEqual(serviceState({state: "healthy", age_s: 0.4}), ["✔", "", "good-text"]);
  assert.deepEqual(serviceState({state: "healthy", age_s: 4}), ["✖", "silent", "bad-text"]);
  assert.deepEqual(serviceState({state: "missing", age_s: null}), ["✖", "silent", "bad-text"]);
  assert.deepEqual(serviceState({state: "degraded", age_s: 0.4}), ["✖", "degraded", "bad-text"]);
});

test("a time of day is one of the last two hours, over midnight as well", () => {
  const at = (text) => Date.parse(`2026-01-02T${text}Z`);
  assert.equal(units.secondsSince("09:05:00", at("09:06:30")), 90);
  assert.equal(units.secondsSince("9:05:00", at("09:05:00")), 0);
  assert.equal(units.secondsSince("23:59:50", at("00:00:10")), 20);
  assert.equal(units.secondsSince("09:05:20", at("09:05:00")), 0, "a watch that is ahead");
  assert.equal(units.secondsSince("06:00:00", at("09:00:00")), null, "too old");
  assert.equal(units.secondsSince("10:00:00", at("09:00:00")), null, "still to come");
  for (const text of ["", "25:00:00", "09:60:00", "nine", "09:05"])
    assert.equal(units.secondsSince(text, at("09:06:00")), null, text);
});
