"""Arbitrates between pages and devices that request values of the same input."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from threading import Lock

Wanted = Mapping[str, tuple[float, float]]
"""By input, the requested value and its largest change per second of simulated time."""

MOVED = 0.02
"""Change of a request with which a source takes over an input; smaller changes are noise of an axis."""
LET_GO = {
    "steering": 3.0,
    "throttle": 5.0,
    "brake": 8.0,
    "hand_brake": 8.0,
    "steering_wheel_angle_demand": 12.0,
    "steering_torque": 60.0,
}
"""Inputs that return to zero without a source, with their rates per second, as after the release of a key.

Others, such as the selector, keep their values.
"""


@dataclass
class _Input:
    """Requests of the sources for one input."""

    owner: str = ""
    sent: float | None = None
    requests: dict[str, float] = field(default_factory=dict)


class InputArbiter:
    """Arbitrates between pages and devices at the inputs of the car.

    Each input follows the source whose request last changed by more than `MOVED`. Several threads may call it.

    `car_want`: called with `Wanted`; `inputs`: inputs of the car; requests for others are ignored.
    """

    def __init__(self, car_want: Callable[[Wanted], None], inputs: Collection[str]) -> None:
        self._want = car_want
        self._inputs = {name: _Input() for name in inputs}
        self._lock = Lock()

    def want(self, source: str, values: Wanted) -> None:
        """Take the requests of a source, at any rate.

        `source`: such as ``page 1 keys`` or ``device Wheel``; `values`: value, and largest change per second of
        simulated time, infinite for a change at once.
        """
        with self._lock:
            passed = {}
            for name, (value, rate) in values.items():
                state = self._inputs.get(name)
                if state is None:
                    continue
                default = 0.0 if name in LET_GO else state.sent
                before = state.requests.get(source, default)
                if before is None or abs(value - before) > MOVED:
                    state.owner = source
                    state.requests[source] = value
                else:
                    state.requests.setdefault(source, value)
                if state.owner == source:
                    state.sent = value
                    passed[name] = (value, rate)
            if passed:
                self._want(passed)

    def gone(self, source: str) -> list[str]:
        """Remove a source and release its inputs.

        Returns inputs that return from other values to zero; another source takes them over with its next request.
        """
        with self._lock:
            released = {}
            for name, state in self._inputs.items():
                state.requests.pop(source, None)
                if state.owner != source:
                    continue
                state.owner = ""
                if name in LET_GO:
                    if state.sent:
                        released[name] = (0.0, LET_GO[name])
                    state.sent = 0.0
                state.requests.clear()
            if released:
                self._want(released)
            return list(released)
