"""The client of fathom's navigation, for guidance software."""
from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Sequence
from types import TracebackType

from . import _native
from ._dispatch import Dispatch
from ._native import AlignmentStatus, Alarm, ClientSecurity, HealthLimits, MonitorStatus, NavHealth, NavState, Route, ScaledClock


class Client:
    """Receives the navigation state of one vehicle, and says what guidance makes of it.

    All functions may be called from any thread, also from a handler. The client ends with `with`, with close(), when
    nothing refers to it any more, or with the interpreter. A handler that refers to the client keeps it alive.
    """

    def __init__(self, *, domain: int = 0, vehicle: str = "", name: str = "guidance", interfaces: Sequence[str] = ("127.0.0.1",),
                 peers: Sequence[str] = ("127.0.0.1",), discovery_servers: Sequence[str] = (),
                 profiles_dir: str | os.PathLike[str] = "", security: ClientSecurity | None = None,
                 limits: HealthLimits | None = None, clock: ScaledClock | None = None) -> None:
        """Joins the vehicle network. Raises RuntimeError, naming what is missing.

        domain: DDS domain, 0 to 232.
        vehicle: its name; empty: the first vehicle heard, and only that one from then on.
        name: how this program shows up on the vehicle network.
        interfaces: addresses bound, nothing else is.
        peers: addresses asked for discovery besides multicast.
        discovery_servers: "address:port" of discovery servers, where the vehicle uses them; peers are not used then.
        profiles_dir: folder of the QoS XML; empty: $FATHOM_DDS_DIR, else the one that came with the package.
        security: credentials for a protected network; none: $FATHOM_SECURITY_DIR, else not protected.
        limits: what health() holds the state against.
        clock: for accelerated simulations; none: the host's.
        """
        options = _native.ClientOptions(
            domain=domain, vehicle=vehicle, name=name, interfaces=interfaces, peers=peers, discovery_servers=discovery_servers,
            profiles_dir=os.fspath(profiles_dir), package_profiles_dir=os.path.join(os.path.dirname(__file__), "dds"),
            security=ClientSecurity() if security is None else security, limits=HealthLimits() if limits is None else limits)
        self._core = _native.Core(options, clock)
        self._dispatch = Dispatch(self._core)
        self._finalizer = weakref.finalize(self, self._dispatch.abandon)
        self._finalizer.atexit = False  # Dispatch sees to that, since it may have to wait for a handler

    def on_nav_state(self, handler: Callable[[NavState], object] | None) -> None:
        """Has `handler` called with each navigation state, on a thread of the client, one at a time: be quick.

        Replaces the handler before; None ends the calls. No call to the old handler begins once this has returned,
        unless it is called from within a handler: it waits for one that is under way. States and alarms share the thread. Up to 32 states wait for a
        handler that is slow; of more, the oldest are left out, as header.sequence shows. What a handler raises goes
        to sys.unraisablehook, and the calls go on.

        header.sensor says which fusion service a state is from: several may stand by for each other.
        """
        self._dispatch.handle("nav_state", handler)

    def on_alarm(self, handler: Callable[[Alarm], object] | None) -> None:
        """Likewise for alarms of the monitor: raised, escalated, cleared, acknowledged, and every few seconds again."""
        self._dispatch.handle("alarm", handler)

    def latest(self) -> NavState | None:
        """The newest state, however old; None before the first one."""
        return self._core.latest()

    def age_s(self) -> float:
        """Seconds since a state with a new stamp last arrived; NaN before the first one.

        By a clock that no correction of UTC moves; in vehicle time where `clock` is accelerated.
        """
        return self._core.age_s()

    def wait_next(self, timeout_s: float) -> NavState | None:
        """Waits until a state newer than the last one returned arrives, at most so many seconds of the host.

        None: none came, or the client was closed meanwhile. Ctrl-C interrupts it.
        """
        return self._core.wait_next(timeout_s)

    def health(self) -> NavHealth:
        """Whether guidance may rely on the navigation state now; `reason` says why not, in one sentence."""
        return self._core.health()

    def alignment(self) -> AlignmentStatus | None:
        """What alignment waits for and what would help; None before the first status."""
        return self._core.alignment()

    def monitor(self) -> MonitorStatus | None:
        """The monitor's view of the vehicle; None before the first one."""
        return self._core.monitor()

    def publish_route(self, route: Route) -> None:
        """Shows people the waypoints that this program follows.

        At once, and again each second until the next call or the end of the client. May be called at any rate; what
        changed goes out ten times a second. The header is filled in here; a route without waypoints says that it
        follows nothing. Does not wait for the network. Raises ValueError for a route that nobody could draw, naming
        what is wrong and what was expected, and RuntimeError when the network did not take the one before.
        """
        self._core.publish_route(route)

    def set_position(self, latitude_rad: float, longitude_rad: float, depth_m: float, sigma_m: float, *,
                     confirmed: bool = False, timeout_s: float = 5.0) -> None:
        """Orders navigation to be at a position, with one sigma of north and of east.

        One that is further away than navigation can believe is held for 60 s, until it is ordered once more with
        `confirmed`. Here and below: waits at most `timeout_s` of the host for somebody who takes orders, and raises
        RuntimeError when there is nobody, or on a protected network when this identity may not order.
        """
        self._core.order("set_position", None, latitude_rad, longitude_rad, depth_m, sigma_m, confirmed, timeout_s)

    def realign(self, *, timeout_s: float = 5.0) -> None:
        """Orders a new alignment."""
        self._core.order("realign", None, None, None, None, None, False, timeout_s)

    def enable_source(self, name: str, *, timeout_s: float = 5.0) -> None:
        """Orders that a sensor is used."""
        self._core.order("enable_source", name, None, None, None, None, False, timeout_s)

    def disable_source(self, name: str, *, timeout_s: float = 5.0) -> None:
        """Orders that a sensor is not used."""
        self._core.order("disable_source", name, None, None, None, None, False, timeout_s)

    def acknowledge_alarm(self, name: str = "*", *, timeout_s: float = 5.0) -> None:
        """Acknowledges an alarm; "*": all."""
        self._core.order("acknowledge_alarm", name, None, None, None, None, False, timeout_s)

    def tell_fix(self, latitude_rad: float, longitude_rad: float, sigma_m: float, *, depth_m: float | None = None,
                 stamp_ns: int | None = None, source: str = "", timeout_s: float = 5.0) -> None:
        """Tells a position, which navigation judges like any other measurement.

        stamp_ns: when the vehicle was there, up to two hours ago, by its own clock; none: now.
        sigma_m: one sigma of north, and of east.
        source: who says so; empty: the client's name.
        """
        self._core.tell_fix(latitude_rad, longitude_rad, sigma_m, depth_m, stamp_ns, source, timeout_s)

    def close(self) -> None:
        """Leaves the vehicle network. No handler runs any more when it returns, unless it is called from one."""
        self._finalizer.detach()
        self._dispatch.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()
