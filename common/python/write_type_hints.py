"""Writes _native.pyi: the types of what is compiled, as the compiled module itself names them.

Usage: write_type_hints.py FOLDER-OF-THE-MODULE OUT
"""
import enum
import inspect
import sys

HEAD = '''"""Written by write_type_hints.py of the compiled module."""
import enum
from collections.abc import Sequence
from typing import Any

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str
Array = NDArray[numpy.float64]  # without numpy: a tuple, of 3 rows where it is a matrix
'''
TAIL = '''

class ScaledClock:
{scaled_clock}
    def __init__(self, epoch_utc_ns: int, rate: float) -> None: ...
    def utc_ns(self) -> int:
        """{utc_ns}"""


def judge(state: NavState | None, age_s: float, limits: HealthLimits | None = ...) -> NavHealth:
{judge}


class Core:
    def __init__(self, options: ClientOptions, clock: ScaledClock | None) -> None: ...
    def latest(self) -> NavState | None: ...
    def age_s(self) -> float: ...
    def health(self) -> NavHealth: ...
    def alignment(self) -> AlignmentStatus | None: ...
    def monitor(self) -> MonitorStatus | None: ...
    def publish_route(self, route: Route) -> None: ...
    def wait_next(self, timeout_s: float) -> NavState | None: ...
    def order(self, kind: str, target: str | None, latitude_rad: float | None, longitude_rad: float | None,
              depth_m: float | None, sigma_m: float | None, confirmed: bool, timeout_s: float) -> None: ...
    def tell_fix(self, latitude_rad: float, longitude_rad: float, sigma_m: float, depth_m: float | None,
                 stamp_ns: int | None, source: str, timeout_s: float) -> None: ...
    def hear_states(self, wanted: bool) -> None: ...
    def hear_alarms(self, wanted: bool) -> None: ...
    def next_event(self) -> tuple[str, Any] | None: ...
    def close(self) -> None: ...
    def close_at_exit(self) -> None: ...


def report(exception: BaseException, where: object) -> None: ...
'''


def given(kind):
    """What the constructor takes for what the property gives."""
    if kind == "Array":
        return "ArrayLike"
    return kind.replace("tuple[", "Sequence[").replace(", ...]", "]")


def doc(text, indent):
    pad = " " * indent
    lines = inspect.cleandoc(text).split("\n")
    if len(lines) == 1:
        return f'{pad}"""{lines[0]}"""'
    return "\n".join([f'{pad}"""{lines[0]}'] + [(pad + line).rstrip() for line in lines[1:]] + [f'{pad}"""'])


def hints_of_enum(kind):
    return [f"\n\nclass {kind.__name__}(enum.Enum):", doc(kind.__doc__, 4)] + [f"    {one.name} = {one.value}" for one in kind]


def hints_of_value(kind):
    out = [f"\n\nclass {kind.__name__}:", doc(kind.__doc__, 4)]
    fields = kind.__annotations__
    words = ", ".join(f"{name}: {given(what)} = ..." for name, what in fields.items())
    out.append(f"    def __init__(self, *, {words}) -> None: ...")
    for name, what in fields.items():
        out += ["    @property", f"    def {name}(self) -> {what}:", doc(getattr(kind, name).__doc__, 8)]
    return out


def main():
    sys.path.insert(0, sys.argv[1])
    import _native
    kinds = [kind for kind in vars(_native).values() if inspect.isclass(kind)]
    lines = [HEAD.rstrip("\n")]
    for kind in kinds:
        if issubclass(kind, enum.Enum):
            lines += hints_of_enum(kind)
        elif kind.__dict__.get("__annotations__"):
            lines += hints_of_value(kind)
    tail = TAIL.format(scaled_clock=doc(_native.ScaledClock.__doc__, 4), utc_ns=_native.ScaledClock.utc_ns.__doc__,
                       judge=doc(_native.judge.__doc__, 4))
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + tail)


if __name__ == "__main__":
    main()
