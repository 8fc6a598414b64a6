"""Arbitrates between the sources of each input: pages and devices request values, and one of them moves the input."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from threading import Lock

Wanted = Mapping[str, tuple[float, float]]
"""Inputs with the value that is wanted and the largest change per simulated second."""

MOVED = 0.02
"""A source that moves an input by more than this has the word there; less is noise of an axis."""
LET_GO = {
    "steering": 3.0,
    "throttle": 5.0,
    "brake": 8.0,
    "hand_brake": 8.0,
    "steering_wheel_angle_demand": 12.0,
    "steering_torque": 60.0,
}
"""Inputs that go to zero when nobody holds them, and their rates per second, which are those of a key that is let go.
Others, such as the selector, stay."""


@dataclass
class _Input:
    """Requests of the sources for one input."""

    owner: str = ""
    sent: float | None = None
    seen: dict[str, float] = field(default_factory=dict)


class InputArbiter:
    """Arbitrates between pages and devices at the inputs of the car.

    For each input the source that moved last, by more than `MOVED`, moves it. May be called from several threads.

    `car_want`: takes inputs as of `Wanted`; those that nobody wants stay as they are; `inputs`: of the car; requests
    for others are ignored.
    """

    def __init__(self, car_want: Callable[[Wanted], None], inputs: Collection[str]) -> None:
        self._want = car_want
        self._inputs = {name: _Input() for name in inputs}
        self._lock = Lock()

    def want(self, source: str, values: Wanted) -> None:
        """A source says what it wants; it may say so as often as it likes.

        `source`: such as ``page 1 keys`` or ``device Wheel``; `values`: value, and largest change per simulated second;
        infinite: at once.
        """
        with self._lock:
            passed = {}
            for name, (value, rate) in values.items():
                state = self._inputs.get(name)
                if state is None:
                    continue
                default = 0.0 if name in LET_GO else state.sent
                before = state.seen.get(source, default)
                if before is None or abs(value - before) > MOVED:
                    state.owner = source
                    state.seen[source] = value
                else:
                    state.seen.setdefault(source, value)
                if state.owner == source:
                    state.sent = value
                    passed[name] = (value, rate)
            if passed:
                self._want(passed)

    def gone(self, source: str) -> list[str]:
        """A source is no longer there: what it held is let go.

        Returns inputs that it held away from zero and that go back; another source takes them when it says again what
        it wants.
        """
        with self._lock:
            free = {}
            for name, state in self._inputs.items():
                state.seen.pop(source, None)
                if state.owner != source:
                    continue
                state.owner = ""
                if name in LET_GO:
                    if state.sent:
                        free[name] = (0.0, LET_GO[name])
                    state.sent = 0.0
                state.seen.clear()
            if free:
                self._want(free)
            return list(free)
