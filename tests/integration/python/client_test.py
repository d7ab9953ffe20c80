"""A program in Python and a vehicle whose every value is known."""
import gc
import math
import sys
import threading
import time
import unittest
import weakref

from vehicle import DOMAIN, PATIENCE_S, WITH_NUMPY, WithVehicle, wait_until

import fathom

# As vehicle.cpp says them.
STATE = {
    "mode": fathom.NavMode.dead_reckoning, "alignment": fathom.AlignmentPhase.aligned, "latitude_rad": 0.635,
    "longitude_rad": 2.2235, "altitude_m": 18.5, "depth_m": 2.25, "altitude_above_bottom_m": 31.5,
    "velocity_N_m_s": (1.5, -0.5, 0.125), "q_NB": (0.965925826289068, 0.0, 0.0, 0.258819045102521),
    "rpy_rad": (0.01, -0.02, 0.523598775598299), "angular_rate_B_rad_s": (0.001, 0.002, 0.003),
    "specific_force_B_m_s2": (0.1, 0.2, -9.8),
    "position_covariance_N_m2": ((1.0, 0.1, 0.2), (0.1, 2.0, 0.3), (0.2, 0.3, 4.0)),
    "velocity_covariance_N_m2_s2": ((0.01, 0.001, 0.002), (0.001, 0.02, 0.003), (0.002, 0.003, 0.04)),
    "rpy_sigma_rad": (0.001, 0.002, 0.01), "gps_outage_s": 61.5, "dvl_outage_s": math.nan, "reset_counter": 7,
    "last_reset_delta_N_m": (0.5, -0.25, 0.0)}
ALIGNMENT = {
    "phase": fathom.AlignmentPhase.coarse, "in_phase_s": 12.5,
    "conditions": (
        {"name": "pitch_rad", "value": 0.02, "limit": 0.05, "held_s": 3.0, "needed_s": 5.0, "met": False},
        {"name": "speed_m_s", "value": 0.75, "limit": 1.0, "held_s": 6.0, "needed_s": 5.0, "met": True}),
    "rpy_sigma_rad": (0.01, 0.02, 0.3), "time_to_aligned_s": 40.0, "advice": "Go straight ahead."}
MONITOR = {
    "known": True, "healthy": False, "mode": fathom.NavMode.inertial, "alignment": fathom.AlignmentPhase.fine,
    "nav_state_age_s": 0.25, "gps_outage_active": True, "gps_outage_severity": fathom.Severity.critical,
    "gps_outage_since_ns": 1700000000123456789, "gps_outage_s": 61.5, "gps_outage_longest_s": 70.0,
    "gps_outage_total_s": 131.5, "gps_outage_count": 2, "alarms_active": 3, "alarms_unacknowledged": 1,
    "sensors": ({"name": "gps0", "presence": fathom.Presence.stale, "age_s": 61.5, "rate_hz": 0.0},
                {"name": "imu", "presence": fathom.Presence.present, "age_s": 0.01, "rate_hz": 100.0}),
    "services": ({"name": "fusion", "presence": fathom.Presence.present, "age_s": 0.5, "rate_hz": 1.0},),
    "receivers": ({"name": "gps0", "active": True, "severity": fathom.Severity.warning, "since_ns": 1700000000000000000,
                   "outage_s": 61.5, "longest_s": 70.0, "total_s": 131.5, "count": 2},)}
ALARM = {
    "alarm": "gps_outage", "severity": fathom.Severity.warning, "active": True, "acknowledged": False,
    "since_ns": 1700000000123456789, "cleared_ns": 0, "text": "No GPS for 61.5 s – 한국어.", "value": 61.5, "limit": 30.0}


def client(**options):
    return fathom.Client(domain=DOMAIN, **({"vehicle": "auv"} | options))


class ClientTest(WithVehicle):
    def assert_says(self, value, expected, where=""):
        if isinstance(expected, dict):
            self.assertEqual(set(type(value).__annotations__) - {"header"}, set(expected), where)
            for name, one in expected.items():
                self.assert_says(getattr(value, name), one, f"{where}.{name}")
        elif isinstance(expected, tuple):
            self.assertEqual(len(value), len(expected), where)
            for i, one in enumerate(expected):
                self.assert_says(value[i], one, f"{where}[{i}]")
        elif isinstance(expected, float) and math.isnan(expected):
            self.assertTrue(math.isnan(value), where)
        else:
            self.assertEqual(value, expected, where)
            if not isinstance(expected, float):
                self.assertIs(type(value), type(expected), where)

    def test_states_are_those_that_were_published(self):
        with client() as navigation:
            self.assertIsNone(navigation.latest())
            self.assertTrue(math.isnan(navigation.age_s()))
            state = navigation.wait_next(PATIENCE_S)
            self.assert_says(state, STATE, "NavState")
            self.assertEqual((state.header.vehicle, state.header.sensor), ("auv", "fusion"))
            self.assertEqual(state.header.received_ns, state.header.stamp_ns + 1234)
            newer = navigation.wait_next(PATIENCE_S)
            self.assertGreater(newer.header.sequence, state.header.sequence)
            self.assertGreaterEqual(navigation.latest().header.sequence, newer.header.sequence)
            self.assertGreaterEqual(navigation.age_s(), 0.0)

    def test_arrays_are_those_of_numpy_where_it_is_and_cannot_be_written(self):
        state = fathom.NavState(velocity_N_m_s=[1, 2, 3])
        if WITH_NUMPY:
            import numpy
            self.assertIsInstance(state.velocity_N_m_s, numpy.ndarray)
            self.assertEqual(state.velocity_N_m_s.dtype, numpy.float64)
            self.assertEqual(state.position_covariance_N_m2.shape, (3, 3))
            with self.assertRaises(ValueError):
                state.velocity_N_m_s[0] = 9.0
            again = fathom.NavState(velocity_N_m_s=numpy.array([1, 2, 3], "f4"), position_covariance_N_m2=numpy.eye(3))
            self.assertEqual(again.position_covariance_N_m2[2, 2], 1.0)
            self.assertEqual(fathom.NavState(latitude_rad=numpy.float64(0.5), reset_counter=numpy.int32(4)),
                             fathom.NavState(latitude_rad=0.5, reset_counter=4))
        else:
            self.assertNotIn("numpy", [name for name, module in sys.modules.items() if module is not None])
            self.assertEqual(state.velocity_N_m_s, (1.0, 2.0, 3.0))
            self.assertIs(type(state.position_covariance_N_m2[0]), tuple)

    def test_a_handler_is_called_replaced_and_taken_away(self):
        with client() as navigation:
            heard, after = [], []
            navigation.on_nav_state(heard.append)
            self.assertTrue(wait_until(lambda: len(heard) >= 20))
            self.assert_says(heard[0], STATE, "NavState")
            sequences = [state.header.sequence for state in heard]
            self.assertEqual(sequences, sorted(set(sequences)))
            navigation.on_nav_state(lambda state: after.append(state) or navigation.on_nav_state(after.append))
            seen = len(heard)
            self.assertTrue(wait_until(lambda: len(after) >= 5))
            self.assertEqual(len(heard), seen, "a handler that was replaced is not called again")
            navigation.on_nav_state(None)
            seen, newest = len(after), navigation.latest().header.sequence
            self.assertTrue(wait_until(lambda: navigation.latest().header.sequence > newest + 5))
            self.assertEqual(len(after), seen)

    def test_taking_a_handler_away_waits_for_the_call_that_is_under_way(self):
        with client() as navigation:
            for take_away in (lambda: navigation.on_nav_state(None), lambda: navigation.on_nav_state(lambda _: None),
                              navigation.close):
                entered, left = [], []

                def handler(state):
                    entered.append(state)
                    time.sleep(0.3)
                    left.append(state)

                navigation.on_nav_state(handler)
                self.assertTrue(wait_until(lambda: entered))
                take_away()
                seen = len(entered)
                self.assertEqual(len(left), seen)
                time.sleep(0.1)
                self.assertEqual(len(entered), seen)

    def test_a_handler_that_takes_long_holds_up_neither_the_bus_nor_itself_with_old_states(self):
        with client() as navigation:
            entered, go_on, heard = threading.Event(), threading.Event(), []

            def handler(state):
                heard.append(state.header.sequence)
                entered.set()
                go_on.wait(PATIENCE_S)

            navigation.on_nav_state(handler)
            self.assertTrue(entered.wait(PATIENCE_S))
            self.assertTrue(wait_until(lambda: navigation.latest().header.sequence > heard[0] + 60))
            self.assertTrue(navigation.health().fresh)
            go_on.set()
            self.assertTrue(wait_until(lambda: len(heard) > 1))
            self.assertGreater(heard[1], heard[0] + 20, "of more than 32 that wait the oldest go")

    def test_statuses_and_alarms(self):
        with client() as navigation:
            alarms = []
            navigation.on_alarm(alarms.append)
            self.assertIsNone(navigation.monitor())
            self.assertIsNone(navigation.alignment())

            def all_heard():
                self.vehicle.say("statuses")
                return alarms and navigation.monitor() and navigation.alignment()

            self.assertTrue(wait_until(all_heard))
            self.assert_says(alarms[0], ALARM, "Alarm")
            self.assert_says(navigation.monitor(), MONITOR, "MonitorStatus")
            self.assert_says(navigation.alignment(), ALIGNMENT, "AlignmentStatus")

    def test_health_is_the_one_judgement(self):
        with client() as navigation, client(vehicle="another") as nobody, client(
                limits=fathom.HealthLimits(max_horizontal_95_m=1.0)) as strict:
            self.assertTrue(wait_until(lambda: navigation.health().ok and strict.latest() is not None))
            health = navigation.health()
            self.assertEqual((health.reason, health.mode), ("", fathom.NavMode.dead_reckoning))
            self.assertEqual(health.heading_sigma_rad, 0.01)
            self.assertEqual(fathom.judge(navigation.latest(), health.age_s), health)
            self.assertTrue(strict.health().heard and not strict.health().ok)
            self.assertIn("certain only to", strict.health().reason)
            self.assertEqual(nobody.health().reason, "No navigation state has been received.")
            self.assertEqual(fathom.judge(None, math.nan), nobody.health())
            self.vehicle.say("states off")
            try:
                self.assertTrue(wait_until(lambda: not navigation.health().fresh))
                self.assertIn("s old (limit 0.50 s)", navigation.health().reason)
                navigation.wait_next(0.0)
                self.assertIsNone(navigation.wait_next(0.2), "nothing newer came")
            finally:
                self.vehicle.say("states on")

    def test_orders_are_heard_by_the_vehicle(self):
        with client(name="planner") as navigation:
            self.assertIsNotNone(navigation.wait_next(PATIENCE_S))
            navigation.set_position(0.63, 2.25, 5.0, 10.0, confirmed=True, timeout_s=PATIENCE_S)
            self.assertEqual(self.vehicle.told.get(timeout=PATIENCE_S),
                             ["order", "auv", "planner", "set_position", "-", "0.63", "2.25", "5", "10", "1"])
            for name in ("enable_source", "disable_source", "acknowledge_alarm"):
                getattr(navigation, name)("gps", timeout_s=PATIENCE_S)
                self.assertEqual(self.vehicle.told.get(timeout=PATIENCE_S)[3:5], [name, "gps"])
            navigation.realign()
            self.assertEqual(self.vehicle.told.get(timeout=PATIENCE_S)[3:5], ["realign", "-"])
            then_ns = navigation.latest().header.stamp_ns - 600 * 10**9
            navigation.tell_fix(0.63, 2.25, 20.0, stamp_ns=then_ns, source="ship", timeout_s=PATIENCE_S)
            told = self.vehicle.told.get(timeout=PATIENCE_S)
            self.assertEqual(told[:7], ["fix", "auv", "ship", "0.63", "2.25", "20", "nan"])
            self.assertAlmostEqual(float(told[7]), 600.0, delta=PATIENCE_S)
            for wrong, words in (((36.4, 2.25, 5.0, 10.0), "latitude_rad is 36.4"), ((0.63, 2.25, 5.0, 0.0), "sigma_m is 0")):
                with self.assertRaisesRegex(ValueError, words):
                    navigation.set_position(*wrong)
            with self.assertRaisesRegex(TypeError, "Client.disable_source: name"):
                navigation.disable_source(5)
            with self.assertRaisesRegex(ValueError, "target is empty"):
                navigation.disable_source("")

    def test_an_order_that_nobody_takes_is_an_error(self):
        with fathom.Client(domain=DOMAIN + 5, vehicle="auv") as navigation:
            with self.assertRaisesRegex(RuntimeError, "nobody takes orders"):
                navigation.realign(timeout_s=0.3)

    def test_a_route_is_seen_by_the_vehicle(self):
        with client(name="python_guidance") as navigation:
            self.assertIsNotNone(navigation.wait_next(PATIENCE_S))  # whose route it is, is known then
            navigation.publish_route(fathom.Route(active=1, repeats=True, mission_count=5, waypoints=[
                fathom.RouteWaypoint(name="A", latitude_rad=0.63, longitude_rad=2.22),
                fathom.RouteWaypoint(name="turn", latitude_rad=0.64, longitude_rad=2.23, depth_m=5.0, speed_m_s=1.5)]))
            self.assertEqual(self.vehicle.routes.get(timeout=PATIENCE_S), [
                "route", "auv", "python_guidance", "1", "1", "5", "A", "0.63", "2.2200000000000002", "nan", "nan", "turn",
                "0.64000000000000001", "2.23", "5", "1.5"])
            navigation.publish_route(fathom.Route())
            nothing = ["route", "auv", "python_guidance", "0", "0", "0"]
            self.assertTrue(wait_until(lambda: self.vehicle.routes.get(timeout=PATIENCE_S) == nothing))
            with self.assertRaisesRegex(ValueError, "its active is not usable, expected the active waypoint among those given"):
                navigation.publish_route(fathom.Route(active=1))

    def test_what_a_handler_raises_is_reported_and_the_calls_go_on(self):
        told, hook = [], sys.unraisablehook
        sys.unraisablehook = lambda args: told.append((args.exc_type, str(args.exc_value), args.object, args.exc_traceback))
        try:
            with client() as navigation:
                errors = iter([ZeroDivisionError("first"), SystemExit("second"), KeyboardInterrupt("third")])
                heard = []

                def handler(state):
                    for error in errors:
                        raise error
                    heard.append(state)

                navigation.on_nav_state(handler)
                self.assertTrue(wait_until(lambda: len(heard) >= 3))
        finally:
            sys.unraisablehook = hook
        self.assertEqual([one[:3] for one in told], [(ZeroDivisionError, "first", handler), (SystemExit, "second", handler),
                                                     (KeyboardInterrupt, "third", handler)])
        self.assertIsNotNone(told[0][3])

    def test_a_waiting_call_lets_other_threads_run_and_ends_with_the_client(self):
        navigation = client(vehicle="another")
        entering, returned = threading.Event(), []

        def wait():
            entering.set()
            returned.append(navigation.wait_next(math.inf))

        thread = threading.Thread(target=wait, daemon=True)
        thread.start()
        self.assertTrue(entering.wait(PATIENCE_S))
        self.assertTrue(thread.is_alive())  # and this thread runs
        self.assertFalse(returned)
        navigation.close()
        thread.join(PATIENCE_S)
        self.assertEqual(returned, [None])

    def test_a_closed_client_says_so(self):
        navigation = client()
        heard = []
        navigation.on_nav_state(lambda state: (navigation.close(), heard.append(state)))  # from a handler as well
        self.assertTrue(wait_until(lambda: heard))
        navigation.close()
        for call in (navigation.latest, navigation.health, navigation.age_s, lambda: navigation.wait_next(0.0),
                     lambda: navigation.on_nav_state(print), lambda: navigation.publish_route(fathom.Route())):
            with self.assertRaisesRegex(RuntimeError, "Client: is closed"):
                call()
        self.assertEqual(len(heard), 1)

    def test_a_client_that_nobody_refers_to_is_collected_with_its_thread(self):
        navigation, heard = client(), []
        navigation.on_nav_state(heard.append)
        self.assertTrue(wait_until(lambda: heard))
        gone = weakref.ref(navigation)
        del navigation
        gc.collect()
        self.assertIsNone(gone())
        self.assertTrue(wait_until(lambda: not [one for one in threading.enumerate() if one.name == "fathom"]))
        seen = len(heard)
        with client() as another:
            for _ in range(5):
                self.assertIsNotNone(another.wait_next(PATIENCE_S))
        self.assertEqual(len(heard), seen)


if __name__ == "__main__":
    unittest.main()
