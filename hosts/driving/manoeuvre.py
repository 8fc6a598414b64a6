"""A manoeuvre: inputs over time, start values and, for closed loops, a driver."""

import hashlib
from collections.abc import Collection
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value

INITIAL_SPEED = "initial.speed"
"""Parameter of a car that starts at a speed, m/s."""
ON_TIME = 1e-9
"""Tolerance of times of rows, s."""


@dataclass(frozen=True)
class Manoeuvre:
    """Inputs over time and start values of an FMU, up to a stop time; with a driver, the loop is closed."""

    name: str
    time: NDArray[np.float64]
    """Times of the rows, s, not decreasing, shape (n,); at a time that occurs twice the inputs jump."""
    inputs: dict[str, NDArray[np.float64]]
    """Values at `time` by variable name, each of shape (n,); linear in between."""
    stop_time: float
    """End of the run, s."""
    start: dict[str, Value] = field(default_factory=dict)
    """Start values of parameters (or inputs)."""
    driver: dict[str, str] = field(default_factory=dict)
    """Settings of the path-following driver; empty: open loop."""
    state: bytes | None = None
    """A state of the FMU that is restored before the first step."""
    state_time: float = 0.0
    """Time of this state, s; `time` counts from there."""
    held: frozenset[str] = frozenset()
    """Inputs that are constant from each row to the next."""
    find_throttle: bool = False
    """Whether the throttle that holds the initial speed in a straight line is determined before the run."""
    step: float | None = None
    """Communication step that the manoeuvre was recorded with, s; used if no other is given."""

    def initial(self, held: Collection[str] = ()) -> dict[str, float]:
        """Inputs before the first step: those at time 0, before a jump that the table begins with."""
        if len(self.time) > 1 and self.time[0] == self.time[1] == 0.0:
            return {name: float(values[0]) for name, values in self.inputs.items()}
        return self.at(0.0, held)

    def late_begin(self, acts: Collection[str] = ()) -> tuple[str, str] | None:
        """A note, subject and text, on a table that begins after 0 s, or None. `acts`: inputs of a driver."""
        first_row = [f"{name} at {values[0]:g}" for name, values in self.inputs.items() if name not in acts]
        if not first_row or self.time[0] <= ON_TIME:
            return None
        return "begin of the table", f"at {self.time[0]:g} s; before, its first row holds {', '.join(first_row)}"

    def at(self, t: float, held: Collection[str] = (), before: bool = False) -> dict[str, float]:
        """Inputs at time `t`, s; outside the table those of its first or last row.

        `held`: further inputs that are constant from row to row, such as integers; `before`: whether values at a jump
        are those before it.
        """
        if not self.inputs:
            return {}
        held, place = {*held, *self.held}, self._place(np.float64(t), before)
        return {name: float(_between(values, place, name in held)) for name, values in self.inputs.items()}

    def column(self, name: str, times: NDArray[np.float64], held: bool, before: bool = False) -> NDArray[np.float64]:
        """Values of one input at many times, see `at`. `times`: s, shape (n,). Result: shape (n,)."""
        return np.asarray(_between(self.inputs[name], self._place(times, before), held))

    def _place(self, times: Any, before: bool) -> tuple[Any, Any, Any]:
        """Rows on either side of times, and where these lie between them, 0 to 1."""
        # Times are sums with rounding errors, which must not hide a jump.
        shift = -ON_TIME if before else ON_TIME
        k = np.searchsorted(self.time, times + shift, side="left" if before else "right")
        lower, upper = np.maximum(k - 1, 0), np.minimum(k, len(self.time) - 1)
        interval = self.time[upper] - self.time[lower]
        passed = np.maximum(times - self.time[lower], 0.0) / np.where(interval > 0.0, interval, np.inf)
        return lower, upper, np.minimum(passed, 1.0)


def _between(values: NDArray[np.float64], place: tuple[Any, Any, Any], held: bool) -> Any:
    """Values at a place between two rows; those of the first if they are held."""
    lower, upper, fraction = place
    start, end = values[lower], values[upper]
    if held:
        return start
    with np.errstate(over="ignore", invalid="ignore"):  # the difference may overflow
        value = start + fraction * (end - start)
    return np.where(np.isfinite(value), value, (1.0 - fraction) * start + fraction * end)


def digest(manoeuvre: Manoeuvre) -> str:
    """A hash of the content of a manoeuvre, its table and its state included, without its name."""
    m = manoeuvre
    content = m.stop_time, m.start, m.driver, m.state_time, m.find_throttle, sorted(m.held), list(m.inputs)
    fields = (
        repr(content).encode(),
        m.time.tobytes(),
        m.state or b"",
        *(values.tobytes() for values in m.inputs.values()),
    )
    return hashlib.sha256(b"\n".join(fields)).hexdigest()


def with_names_of(manoeuvre: Manoeuvre, names: Collection[str]) -> Manoeuvre:
    """The manoeuvre with one name for each start value: of a key ``a | b`` the first name among `names`, else ``a``."""
    start = {}
    for key, value in manoeuvre.start.items():
        candidates = [name.strip() for name in key.split("|")]
        start[next((name for name in candidates if name in names), candidates[0])] = value
    return replace(manoeuvre, start=start)
