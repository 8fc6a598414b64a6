"""Notices about steps: messages of the FMU and steps at the limit of iterations, at most one per second."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.simulator.clock import Clock
from hosts.simulator.driven_fmu import DrivenFmu, Notice
from hosts.simulator.step_times import TimesRecord

NOT_FINITE = "not finite"
"""Kind of the notice of a value that is not finite."""
_PERIOD = 1.0
_MIN_RESIDUAL = 1e-4
"""Residual up to which there is no notice, m."""
_ITERATION_LIMIT = "solver.step_iterations"
_COUNT = "solver.capped_steps"
_RESIDUAL = "solver.capped_residual"


class Notices:
    """Collects notices over a second of wall time.

    `times`: counts all steps at the limit of iterations, also those without a notice.
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
        """Take the present count of the FMU after a rewind or new start."""
        if self._capped >= 0:
            self._before = float(car.values[self._capped])

    def of_step(self, car: DrivenFmu) -> list[Notice]:
        """Notices after a step; the one of a value that is not finite comes once."""
        if self._zeros is not None and np.dot(car.values, self._zeros) != 0.0:  # NaN, also from infinite values
            self._zeros = None
            index = int(np.flatnonzero(~np.isfinite(car.values))[0])
            return [Notice(NOT_FINITE, f"The output '{car.names[index]}' is {car.values[index]} at {car.time:.9g} s.")]
        if self._capped >= 0:
            self._count(car)
        for message in car.messages():
            # Messages on the limit of iterations are in the count.
            if self._capped < 0 or _ITERATION_LIMIT not in message:
                self._messages, self._message = self._messages + 1, message
        is_reported = self._steps and (self._residual < 0 or self._largest > _MIN_RESIDUAL)
        if not (is_reported or self._messages) or self._clock.now() < self._next:
            return []
        self._next = self._clock.now() + _PERIOD
        notices = []
        if is_reported:
            residual = f"; it left up to {1e3 * self._largest:.3g} mm" if self._residual >= 0 else ""
            stopped = _count_text(self._steps, "inner step")
            notices.append(Notice("capped", f"The solver stopped {stopped} at the limit of iterations{residual}."))
            self._steps, self._largest = 0.0, 0.0
        if self._messages:
            suffix = f" (and {_count_text(self._messages - 1, 'message')} before it)" if self._messages > 1 else ""
            notices.append(Notice("told", f"{self._message}{suffix}"))
            self._messages = 0
        return notices

    def _count(self, car: DrivenFmu) -> None:
        count = float(car.values[self._capped])
        if count > self._before:
            residual = float(car.values[self._residual]) if self._residual >= 0 else 0.0
            self._steps, self._largest = self._steps + count - self._before, max(self._largest, residual)
            self._times.add("capped", count - self._before)
            self._times.raise_to("capped_largest", residual)
        self._before = count


def _count_text(count: float, noun: str) -> str:
    return f"{count:g} {noun}{'' if count == 1 else 's'}"
