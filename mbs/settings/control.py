"""The tolerance of a run, checked, and how a run chose its steps with the error that it estimates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from mbs.common.checks import is_finite, shown

LEAST_TOLERANCE, MOST_TOLERANCE = 1e-11, 0.5
DEFAULT_TOLERANCE = 1e-3
"""Of runs in equal steps that are chosen; at most what a run begins with whose tolerance is that of sensors."""
ALLOWED = 3.0
"""A guess of the error up to so many tolerances passes without a warning: it may be too small by as much again."""


@dataclass(frozen=True)
class Control:
    """How `simulate` chose its steps."""

    tolerance: float
    """Accepted error of positions in parts of `length`."""
    length: float
    """Of the model, m."""
    method: str
    """Name of the method that made the run."""
    reason: str
    """Why this method; empty where the caller named it."""
    error: float
    """Guess of the largest error of positions over the run in parts of `length`: the distance from a coarser run
    times the ratio of their step errors, at least a tenth of the tolerance, as smaller guesses are unreliable. In
    nine of ten runs it is within ten times the error; what both runs miss is not in it, and where guides prescribe
    all motion it is 0. NaN where the step was given: nothing was compared."""
    h: float | None
    """The fixed step, s; None: steps under error control."""
    steps: int
    rejected: int
    failed: int
    """`steps`, `rejected`, `failed`: steps of the run that is shown; those that erred too much, and those that did not
    converge, were repeated."""
    forced: int
    """Steps that err more than their share of the tolerance and no less when they are shorter."""
    smallest: float
    largest: float
    """`smallest`, `largest`: accepted steps, s."""
    side_steps: int
    """Made for times between the steps, where no polynomial through the steps served."""
    runs: int
    """Whole runs that were made, those for the estimate and for the choice of the method included."""
    moved: float = math.nan
    """How far the coordinate that moves farthest moves, m; NaN where the step was given."""
    sensors: Mapping[str, float] = field(default_factory=dict)
    """Guessed errors of the sensors that were given a tolerance, in their units; `error` is then the largest of them
    over its tolerance, times `tolerance`."""

    @property
    def kept(self) -> bool:
        """Whether the guessed error is at most three times the tolerance, or there is none."""
        return not self.error > ALLOWED * self.tolerance

    def __str__(self) -> str:
        steps = (
            f"fixed steps of {self.h:.4g} s"
            if self.h is not None
            else f"{self.steps} steps of {self.smallest:.3g} to {self.largest:.3g} s ({self.rejected} rejected)"
        )
        reason = f" ({self.reason})" if self.reason else ""
        if math.isnan(self.error):
            return f"{self.method}{reason}: {steps}"
        if self.sensors:
            errors = ", ".join(f"{e:.0e} of {name!r}" for name, e in self.sensors.items())
            return f"{self.method}{reason}: {steps}; errors estimated from a coarser run: {errors}"
        of = f"of {self.tolerance:g} of the model's length of {self.length:.4g} m"
        if self.error <= self.tolerance:
            return f"{self.method}{reason}: {steps}; within the tolerance {of}, as a coarser run shows"
        return f"{self.method}{reason}: {steps}; error estimated from a coarser run: {self.error:.0e}, tolerance {of}"


@dataclass(frozen=True)
class Tolerance:
    """What a run may err by."""

    share: float
    """Of positions, in parts of the model's length."""
    sensors: Mapping[str, float] = field(default_factory=dict)
    """Of sensors, in their units; they decide in place of positions."""


def checked_tolerance(tolerance: object, units: Mapping[str, str], length: float) -> Tolerance:
    """The tolerance of a run, or one sentence: a number, or numbers by sensor.

    `units`: of the sensors that the System computes, by name; `length`: of the model, m.
    """
    if isinstance(tolerance, Mapping):
        return _of_sensors(tolerance, units, length)
    value = float(tolerance) if is_finite(tolerance) else math.nan  # type: ignore[arg-type]
    if LEAST_TOLERANCE <= value <= MOST_TOLERANCE:
        return Tolerance(value)
    what = "it is below what round-off leaves; " if 0.0 < value < LEAST_TOLERANCE else ""
    raise ValueError(
        f"The tolerance is {shown(tolerance)}; {what}it must be a number between {LEAST_TOLERANCE:g} and "
        f"{MOST_TOLERANCE:g}: the largest error of positions in parts of the model's length; or errors of sensors in "
        "their units, by name."
    )


def _of_sensors(given: Mapping[object, object], units: Mapping[str, str], length: float) -> Tolerance:
    for name, value in given.items():
        if name not in units:
            raise ValueError(f"A tolerance is given for {shown(name)}; the System computes no such sensor.")
        if not (is_finite(value) and float(value) > 0.0):  # type: ignore[arg-type]
            raise ValueError(f"The tolerance of {name!r} is {shown(value)}; it must be a number above 0.")
    if not given:
        raise ValueError("The tolerance names no sensor; give one error by name, or a number.")
    allowed = {str(name): float(value) for name, value in given.items()}  # type: ignore[arg-type]
    shares = [value / length for name, value in allowed.items() if units[name] == "m"]
    return Tolerance(min(max(min(shares, default=DEFAULT_TOLERANCE), LEAST_TOLERANCE), DEFAULT_TOLERANCE), allowed)
