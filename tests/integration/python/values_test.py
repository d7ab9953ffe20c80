"""Values, complaints and types, without a network."""
import ast
import copy
import enum
import inspect
import math
import os
import pickle
import typing
import unittest

import vehicle  # noqa: F401: numpy or not

import fathom
from fathom import _native


class ValuesTest(unittest.TestCase):
    def test_values_do_not_change_and_compare_by_what_they_say(self):
        point = fathom.RouteWaypoint(name="A", latitude_rad=0.5)
        self.assertEqual(point, fathom.RouteWaypoint(name="A", latitude_rad=0.5))  # NaN is as unknown as NaN
        self.assertNotEqual(point, fathom.RouteWaypoint(name="B", latitude_rad=0.5))
        self.assertNotEqual(point, fathom.RouteWaypoint(name="A", latitude_rad=0.5, depth_m=1.0))
        self.assertNotEqual(point, "A")
        with self.assertRaises(AttributeError):
            point.latitude_rad = 1.0
        self.assertEqual(repr(point), "RouteWaypoint(name='A', latitude_rad=0.5, longitude_rad=nan, depth_m=nan, speed_m_s=nan)")

    def test_values_travel_between_processes(self):
        state = fathom.NavState(header=fathom.SampleHeader(vehicle="auv", stamp_ns=2 ** 60 + 1), mode=fathom.NavMode.inertial,
                                q_NB=(1, 0, 0, 0), position_covariance_N_m2=((1, 2, 3), (4, 5, 6), (7, 8, 9)))
        route = fathom.Route(header=state.header, waypoints=[fathom.RouteWaypoint(name="A")])
        status = fathom.AlignmentStatus(advice="Turn.", conditions=[fathom.AlignmentCondition(name="pitch_rad", met=True)])
        for value in (state, route, status, fathom.Presence.stale):
            self.assertEqual(pickle.loads(pickle.dumps(value)), value)
            self.assertEqual(copy.deepcopy(value), value)
        self.assertNotEqual(status, fathom.AlignmentStatus(advice="Turn."))
        self.assertNotEqual(state, fathom.NavState(header=state.header))

    def test_complaints_name_what_was_expected(self):
        waypoint, route, state = fathom.RouteWaypoint, fathom.Route, fathom.NavState
        for call, kind, sentence in [
                (lambda: waypoint(latitude_rad="36"), TypeError, "RouteWaypoint.latitude_rad: expected a number, got str"),
                (lambda: waypoint(latitude_rad=10 ** 400), ValueError, "latitude_rad: expected a number that a float can hold"),
                (lambda: waypoint(lat=1), TypeError, "RouteWaypoint: has no lat, expected one of name, latitude_rad"),
                (lambda: waypoint("A"), TypeError, "RouteWaypoint: expected named values only"),
                (lambda: waypoint(name=1), TypeError, "RouteWaypoint.name: expected a str, got int"),
                (lambda: waypoint(name="x" * 32), ValueError, "RouteWaypoint.name: expected at most 31 bytes of UTF-8"),
                (lambda: waypoint(name="\udc80"), ValueError, "RouteWaypoint.name: expected text that UTF-8 can say"),
                (lambda: route(active=-1), ValueError, "Route.active: expected an int from 0 to 4294967295, got -1"),
                (lambda: route(active=1.5), TypeError, "Route.active: expected an int, got float"),
                (lambda: route(repeats=1), TypeError, "Route.repeats: expected True or False, got int"),
                (lambda: route(waypoints="AB"), TypeError, "Route.waypoints: expected a list of RouteWaypoint, got str"),
                (lambda: route(waypoints=[waypoint(), 1]), TypeError,
                 r"Route.waypoints\[1\]: expected a fathom.RouteWaypoint, got int"),
                (lambda: route(header=1), TypeError, "Route.header: expected a fathom.SampleHeader, got int"),
                (lambda: state(mode=4), TypeError, "NavState.mode: expected a fathom.NavMode, got int"),
                (lambda: state(mode=fathom.Severity.notice), TypeError, "NavState.mode: expected a fathom.NavMode, got Severity"),
                (lambda: state(q_NB=[1, 0, 0]), ValueError, "NavState.q_NB: expected 4 numbers, got"),
                (lambda: state(q_NB=[1, 0, 0, None]), TypeError, r"NavState.q_NB\[3\]: expected a number, got NoneType"),
                (lambda: state(position_covariance_N_m2=[1] * 9), ValueError, "expected 3 rows of 3 numbers"),
                (lambda: fathom.SampleHeader(stamp_ns=2 ** 63), ValueError, "stamp_ns: expected an int of 64 bits"),
                (lambda: fathom.SampleHeader(stamp_ns=1.7e18), TypeError, "SampleHeader.stamp_ns: expected an int, got float"),
                (lambda: fathom.AlignmentStatus(conditions=[fathom.AlignmentCondition()] * 13), ValueError,
                 "AlignmentStatus.conditions: expected at most 12 conditions"),
                (lambda: fathom.Client(domain=233), ValueError, "Client.domain: expected an int from 0 to 232, got 233"),
                (lambda: fathom.Client(domain="0"), TypeError, "Client.domain: expected an int, got str"),
                (lambda: fathom.Client(vehicle="x" * 32), ValueError, "Client.vehicle: expected at most 31 bytes of UTF-8"),
                (lambda: fathom.Client(interfaces="127.0.0.1"), TypeError, "Client.interfaces: expected a list of str, got str"),
                (lambda: fathom.Client(interfaces=[]), ValueError, "Client.interfaces: expected at least one IPv4 address"),
                (lambda: fathom.Client(interfaces=["lo"]), ValueError, r"Client.interfaces\[0\]: expected an IPv4 address .* got .lo."),
                (lambda: fathom.Client(interfaces=["203.0.113.9"]), RuntimeError, "this host has no such address"),
                (lambda: fathom.Client(peers=["127.0.0.1", "x"]), ValueError, r"Client.peers\[1\]: expected an IPv4 address"),
                (lambda: fathom.Client(discovery_servers=["10.0.0.1"]), ValueError,
                 r"Client.discovery_servers\[0\]: expected an IPv4 address and a port such as 192.168.2.1:11811, got '10.0.0.1'"),
                (lambda: fathom.Client(discovery_servers=["10.0.0.1:0"]), ValueError, "expected an IPv4 address and a port"),
                (lambda: fathom.Client(security=fathom.ClientSecurity(folder="/nowhere")), RuntimeError, "/nowhere: is no folder"),
                (lambda: fathom.Client(limits=0.5), TypeError, "Client.limits: expected a fathom.HealthLimits, got float"),
                (lambda: fathom.Client(clock=1), TypeError, "Client.clock: expected a fathom.ScaledClock or None, got int"),
                (lambda: fathom.Client(profiles_dir="/nowhere"), RuntimeError, "/nowhere"),
                (lambda: fathom.ScaledClock(0, 0), ValueError, "ScaledClock.rate: expected a number above 0"),
                (lambda: fathom.judge(1, 0.0), TypeError, "judge: state: expected a fathom.NavState or None, got int")]:
            with self.assertRaisesRegex(kind, sentence):
                call()
        with fathom.Client(domain=vehicle.DOMAIN) as navigation:
            for call, kind, sentence in [
                    (lambda: navigation.wait_next("1"), TypeError, "Client.wait_next: timeout_s: expected a number, got str"),
                    (lambda: navigation.wait_next(-1), ValueError, "Client.wait_next: timeout_s: expected seconds, 0 or more"),
                    (lambda: navigation.wait_next(math.nan), ValueError, "expected seconds, 0 or more"),
                    (lambda: navigation.on_nav_state(1), TypeError, "Client.on_nav_state: handler: expected something to call"),
                    (lambda: navigation.publish_route([]), TypeError,
                     "Client.publish_route: route: expected a fathom.Route, got list")]:
                with self.assertRaisesRegex(kind, sentence):
                    call()

    def test_a_scaled_clock_runs_as_fast_as_it_is_told(self):
        clock = fathom.ScaledClock(epoch_utc_ns=1_700_000_000_000_000_000, rate=10)
        with fathom.Client(domain=vehicle.DOMAIN, clock=clock):
            self.assertGreaterEqual(clock.utc_ns(), 1_700_000_000_000_000_000)

    def test_defaults_are_those_of_the_client_in_cpp(self):
        theirs = _native.ClientOptions()
        for name, parameter in inspect.signature(fathom.Client).parameters.items():
            if name not in ("security", "limits", "clock"):
                self.assertEqual(parameter.default, getattr(theirs, name), name)
            else:
                self.assertIsNone(parameter.default, name)
        self.assertEqual((theirs.security, theirs.limits), (fathom.ClientSecurity(), fathom.HealthLimits()))
        self.assertEqual(fathom.HealthLimits(), fathom.HealthLimits(
            max_age_s=0.5, max_horizontal_95_m=50.0, max_heading_sigma_rad=0.1, need_aligned=True))


class TypesTest(unittest.TestCase):
    def test_everything_is_documented(self):
        for name in fathom.__all__:
            thing = getattr(fathom, name)
            self.assertEqual(thing.__module__ if name not in ("Client", "judge") else "fathom", "fathom", name)
            self.assertTrue(thing.__doc__, name)
            if inspect.isclass(thing) and not issubclass(thing, enum.Enum):
                for member, value in vars(thing).items():
                    if not member.startswith("_"):
                        self.assertTrue(value.__doc__, f"{name}.{member}")

    def test_the_type_hints_are_there_and_says_what_the_module_has(self):
        folder = os.path.dirname(fathom.__file__)
        self.assertTrue(os.path.exists(f"{folder}/py.typed"))
        with open(f"{folder}/_native.pyi", encoding="utf-8") as file:
            tree = ast.parse(file.read())
        said = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(said), {name for name in vars(_native) if not name.startswith("_")})
        for name, node in said.items():
            if isinstance(node, ast.ClassDef) and not issubclass(getattr(_native, name), enum.Enum):
                members = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
                theirs = {member for member in vars(getattr(_native, name)) if not member.startswith("_")}
                self.assertEqual(members - {"__init__"}, theirs, name)
        state = {one.name: one for one in said["NavState"].body if isinstance(one, ast.FunctionDef)}
        self.assertEqual(ast.unparse(state["velocity_N_m_s"].returns), "Array")
        self.assertEqual(ast.get_docstring(state["velocity_N_m_s"]), "Velocity over ground, north-east-down, m/s.")
        self.assertEqual(ast.unparse(state["header"].returns), "SampleHeader")

    def test_the_version_is_that_of_the_project(self):
        with open(f"{vehicle.SOURCE}/CMakeLists.txt", encoding="utf-8") as file:
            self.assertIn(f"project(fathom VERSION {fathom.__version__} ", file.read())

    def test_annotations_of_the_client_are_types(self):
        hints = typing.get_type_hints(fathom.Client.wait_next)
        self.assertEqual(hints["return"], typing.Optional[fathom.NavState])


if __name__ == "__main__":
    unittest.main()
