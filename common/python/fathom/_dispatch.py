"""Calls the handlers of a client, on a thread of Python, and ends it in every way that a program may end."""
from __future__ import annotations

import atexit
import threading
from collections.abc import Callable
from typing import Any

from . import _native

_EXIT_S = 2.0  # how long the end of the interpreter waits for a handler that is running


class Dispatch:
    """Refers to the client's core and not to the client: a client that nobody uses any more can be collected."""

    def __init__(self, core: _native.Core) -> None:
        self._core = core
        self._hear = {"nav_state": core.hear_states, "alarm": core.hear_alarms}
        self._changed = threading.Condition()  # guards what follows; not held while a handler runs
        self._handlers: dict[str, Callable[[Any], object]] = {}
        self._call: object | None = None  # the one that is under way
        self._thread: threading.Thread | None = None
        atexit.register(self._at_exit)

    def handle(self, topic: str, handler: Callable[[Any], object] | None) -> None:
        if handler is not None and not callable(handler):
            raise TypeError(f"Client.on_{topic}: handler: expected something to call, or None, got {type(handler).__name__}")
        with self._changed:
            self._hear[topic](handler is not None)
            if handler is None:
                self._handlers.pop(topic, None)
            else:
                self._handlers[topic] = handler
                if self._thread is None:
                    self._thread = threading.Thread(target=self._run, name="fathom", daemon=True)
                    self._thread.start()
            call = self._call
            if call is not None and threading.current_thread() is not self._thread:
                self._changed.wait_for(lambda: self._call is not call)

    def _run(self) -> None:
        while (event := self._core.next_event()) is not None:
            self._pass_on(*event)
            del event  # a thread that waits keeps nothing alive

    def _pass_on(self, topic: str, value: object) -> None:
        with self._changed:
            handler = self._handlers.get(topic)
            if handler is None:
                return
            self._call = object()
        try:
            handler(value)
        except BaseException as error:  # the next state is handled whatever this one did
            _native.report(error, handler)
        finally:
            with self._changed:
                self._call = None
                self._changed.notify_all()

    def close(self) -> None:
        """Returns when no handler runs any more, unless it is called from one."""
        self.abandon()
        thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def abandon(self) -> None:
        """Does not wait for the handlers: the collector calls this anywhere, and may hold what they wait for."""
        atexit.unregister(self._at_exit)
        self._core.close()

    def _at_exit(self) -> None:
        self._core.close_at_exit()
        if self._thread is not None:
            self._thread.join(_EXIT_S)
