// The parts of the console's page that need no browser: what it keeps, and how it writes numbers.
import assert from "node:assert/strict";
import test from "node:test";
import {snapshot, tick, web} from "./page.mjs";

const {store, takeSnapshot, takeTick, Table} = await import(new URL("store.js", web));
const {ageOf, isOld, routeText, shapeOf} = await import(new URL("routes.js", web));
const units = await import(new URL("units.js", web));
const {setPref} = await import(new URL("prefs.js", web));

test("twelve hours take no more memory than ten minutes", () => {
  takeSnapshot(snapshot());
  let most = 0;
  for (let i = 1; i <= 12 * 3600 * 5; ++i) {
    takeTick(tick(i, i * 200));
    most = Math.max(most, store.nav.length, store.fixes.length, store.detail.length);
  }
  assert.ok(most <= 3000 + 401, `${most} rows at most`);
  assert.ok(store.series.get("dvl dvl_velocity").table.length <= 3401);
  assert.equal(store.series.get("dvl dvl_velocity").dimensions, 2);
});

test("a tick that the snapshot holds already is left out", () => {
  takeSnapshot(snapshot(10));
  assert.equal(takeTick(tick(10, 1000)), false);
  assert.equal(takeTick(tick(11, 1200)), true);
  assert.equal(store.nav.length, 1);
});

test("what is judged again takes the place of what was said before", () => {
  takeSnapshot(snapshot());
  takeTick(tick(1, 1000));
  takeTick(tick(2, 2000));
  const again = tick(3, 1000, {nav: []});
  again.verdicts[0].rows[0][1] = 1;
  again.fixes[0][6] = 1;
  takeTick(again);
  assert.deepEqual(store.series.get("dvl dvl_velocity").table.column("kind"), [1, 0]);
  assert.deepEqual(
    store.fixes.map((fix) => fix.verdict),
    [1, 0],
  );
});

test("other states begin anew", () => {
  takeSnapshot(snapshot());
  takeTick(tick(1, 1000));
  takeTick(tick(2, 3000, {detail_names: ["a", "b"], detail: [[3000, 1, 2, 3, 4]]}));
  assert.equal(store.detail.length, 1);
  assert.deepEqual(store.detail.column("b"), [3]);
});

test("a table without such a column has an empty one", () => assert.deepEqual(new Table(["t"]).column("x"), []));

const route = (more = {}) => ({
  publisher: "guidance",
  age_s: 0.4,
  old: false,
  active: 1,
  repeats: false,
  first_number: 1,
  mission_count: 3,
  leg_start: [36.4, 127.4],
  points: [
    ["", 36.41, 127.4, 0, 1],
    ["Buoy", 36.42, 127.41, 5, 1],
    ["", 36.43, 127.42, 5, 1],
  ],
  ...more,
});

test("a route has passed, active and coming legs", () => {
  const {points, legs} = shapeOf(route());
  assert.deepEqual(points.map(({name, state}) => [name, state]), [["1", "passed"], ["Buoy", "active"], ["3", "ahead"]]);
  assert.deepEqual(legs, [
    {from: [36.4, 127.4], to: [36.42, 127.41], state: "active"},
    {from: [36.42, 127.41], to: [36.43, 127.42], state: "ahead"},
  ]);
  const unknownStart = shapeOf(route({leg_start: [null, null]})).legs;
  assert.deepEqual(unknownStart[0], {from: [36.41, 127.4], to: [36.42, 127.41], state: "active"});
  assert.equal(shapeOf(route({active: 0, leg_start: [null, null]})).legs.length, 2, "nobody knows where it began");
  assert.equal(shapeOf(route({active: 0})).legs[0].state, "active", "the first leg begins where guidance took over");
  const round = shapeOf(route({repeats: true})).legs;
  assert.deepEqual(round.at(-1), {from: [36.43, 127.42], to: [36.41, 127.4], state: "ahead"});
  const part = shapeOf(route({repeats: true, mission_count: 100, first_number: 50}));
  assert.equal(part.legs.length, 2, "a part of a mission does not close");
  assert.equal(part.points[0].name, "50");
  assert.ok(shapeOf(route({active: 3})).points.every(({state}) => state === "passed"));
});

test("a route that nobody repeats grows old, also while the console is silent", () => {
  takeSnapshot(snapshot());
  takeTick(tick(1, 1000, {routes: [route()]}));
  assert.equal(store.routes.length, 1);
  assert.match(routeText(store.routes[0], store.routesAt), /^guidance: to waypoint 2 of 3, Buoy · 0\.4 s old$/);
  takeTick(tick(2, 1100));
  assert.equal(store.routes.length, 1, "a tick without routes changes none");
  assert.ok(!isOld(store.routes[0], store.routesAt + 2000));
  assert.ok(isOld(store.routes[0], store.routesAt + 3000));
  assert.ok(Math.abs(ageOf(store.routes[0], store.routesAt + 3000) - 3.4) < 1e-9);
  assert.match(routeText(store.routes[0], store.routesAt + 3000), /✖ old, last heard 3\.4 s ago$/);
  assert.match(routeText(route({old: true, active: 3}), store.routesAt), /all 3 waypoints passed · ✖ old/);
  takeTick(tick(3, 1200, {routes: []}));
  assert.equal(store.routes.length, 0);
});

test("numbers in the units that were chosen", () => {
  assert.equal(units.length(10), "10.0 m");
  assert.equal(units.speed(1), "1.00 m/s");
  assert.equal(units.length(null), "–");
  assert.equal(units.fixed(-0.001), "0.0");
  assert.equal(units.latitude(-36.4), "-36.400000°");
  setPref("length", "ft");
  setPref("speed", "kn");
  setPref("angle", "dms");
  assert.equal(units.length(10), "32.8 ft");
  assert.equal(units.speed(1), "1.94 kn");
  assert.equal(units.latitude(-36.5), "36° 30′ 00.00″ S");
  assert.equal(units.longitude(127.999999999), "128° 00′ 00.00″ E");
  assert.equal(units.latitude(0), "0° 00′ 00.00″ N");
});

test("bearings lie between 0 and 360", () => {
  assert.equal(units.bearing(-10), "350.0°");
  assert.equal(units.bearing(359.96), "000.0°");
  assert.equal(units.bearing(7.31), "007.3°");
});

test("durations read as the service writes them", () => {
  assert.equal(units.duration(12.34), "12.3 s");
  assert.equal(units.duration(252.4), "4 min 12 s");
  assert.equal(units.duration(7385), "2 h 03 min");
});

test("states are grouped and get the units that people know", () => {
  const {group, name, unit} = units.stateName("gyro_bias_x_rad_s");
  assert.deepEqual([group, name, unit], ["gyro bias", "x", "deg/h"]);
  assert.equal(units.stateName("current_north_m_s").unit, "m/s");
  assert.equal(units.stateName("dvl_scale").unit, "‰");
});
