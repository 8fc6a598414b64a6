"""Notices about steps: messages of the FMU and steps that reached a limit of iterations, limited in rate."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.simulator.clock import Clock
from hosts.simulator.driven_fmu import DrivenFmu, Notice
from hosts.simulator.step_times import TimesRecord

NOT_FINITE = "not finite"
"""Kind of what is said of a value that is not a number."""
_EVERY = 1.0
_WORTH = 1e-4
"""Of a residual that is left nothing is said up to here, m."""
_LIMIT = "solver.step_iterations"
_COUNT = "solver.capped_steps"
_RESIDUAL = "solver.capped_residual"


class Notices:
    """Collects them over a second of wall time.

    `times`: where steps that were cut short are counted, also those of which nothing is said.
    """

    def __init__(self, names: Sequence[str], clock: Clock, times: TimesRecord) -> None:
        self._clock, self._times, self._next = clock, times, 0.0
        self._capped = names.index(_COUNT) if _COUNT in names else -1
        self._residual = names.index(_RESIDUAL) if _RESIDUAL in names else -1
        self._before = 0.0
        self._steps, self._largest, self._messages = 0.0, 0.0, 0
        self._message = ""
        self._zeros: NDArray[np.float64] | None = np.zeros(len(names))

    def jumped(self, car: DrivenFmu) -> None:
        """The count of the FMU is another now."""
        if self._capped >= 0:
            self._before = float(car.values[self._capped])

    def of_step(self, car: DrivenFmu) -> list[Notice]:
        """What is to be said after this step; that a value is not a number, once."""
        if self._zeros is not None and np.dot(car.values, self._zeros) != 0.0:  # NaN, of an infinite one too
            self._zeros = None
            index = int(np.flatnonzero(~np.isfinite(car.values))[0])
            return [Notice(NOT_FINITE, f"The output '{car.names[index]}' is {car.values[index]} at {car.time:.9g} s.")]
        if self._capped >= 0:
            self._count(car)
        for message in car.messages():
            # The FMU's own words on its limit, however little was left, are in the count.
            if self._capped < 0 or _LIMIT not in message:
                self._messages, self._message = self._messages + 1, message
        worth = self._steps and (self._residual < 0 or self._largest > _WORTH)
        if not (worth or self._messages) or self._clock.now() < self._next:
            return []
        self._next = self._clock.now() + _EVERY
        messages = []
        if worth:
            residual = f"; it left up to {1e3 * self._largest:.3g} mm" if self._residual >= 0 else ""
            stopped = _number(self._steps, "inner step")
            messages.append(Notice("capped", f"The solver stopped {stopped} at the limit of iterations{residual}."))
            self._steps, self._largest = 0.0, 0.0
        if self._messages:
            suffix = f" (and {_number(self._messages - 1, 'message')} before it)" if self._messages > 1 else ""
            messages.append(Notice("told", f"{self._message}{suffix}"))
            self._messages = 0
        return messages

    def _count(self, car: DrivenFmu) -> None:
        count = float(car.values[self._capped])
        if count > self._before:
            residual = float(car.values[self._residual]) if self._residual >= 0 else 0.0
            self._steps, self._largest = self._steps + count - self._before, max(self._largest, residual)
            self._times.add("capped", count - self._before)
            self._times.raise_to("capped_largest", residual)
        self._before = count


def _number(count: float, what: str) -> str:
    return f"{count:g} {what}{'' if count == 1 else 's'}"
