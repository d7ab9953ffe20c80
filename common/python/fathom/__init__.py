"""Navigation for guidance software: states, health and routes of one vehicle of a fathom network.

    import fathom

    with fathom.Client(domain=0, vehicle="auv") as navigation:
        while state := navigation.wait_next(timeout_s=5.0):
            health = navigation.health()
            if health.ok: steer(state)
            else: hold(health.reason)

Positions are WGS-84 in radians, velocities north-east-down in m/s. q_NB turns body (forward-right-down) into
north-east-down. Times are int nanoseconds since the Unix epoch, UTC. Unknown values are NaN. Names carry frame and
unit as those of the C++ client do.

Vectors and matrices are arrays of numpy that cannot be written to, or tuples where numpy is not installed.
Values do not change: a newer state is another object.
"""
from ._native import (
    Alarm, AlignmentCondition, AlignmentPhase, AlignmentStatus, ClientSecurity, HealthLimits, MonitorStatus, NavHealth, NavMode,
    NavState, Presence, ReceiverOutage, Route, RouteWaypoint, SampleHeader, ScaledClock, Severity, WatchedItem, judge)
from ._native import __version__ as __version__
from .client import Client

__all__ = [
    "Alarm", "AlignmentCondition", "AlignmentPhase", "AlignmentStatus", "Client", "ClientSecurity", "HealthLimits",
    "MonitorStatus", "NavHealth", "NavMode", "NavState", "Presence", "ReceiverOutage", "Route", "RouteWaypoint", "SampleHeader",
    "ScaledClock", "Severity", "WatchedItem", "judge"]
