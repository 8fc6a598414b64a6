"""Record of a run under a tolerance: the method and steps that were chosen, and the estimated error."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

ALLOWED = 3.0
"""Estimated errors up to this multiple of the tolerance pass without a warning: they may be too small by as much."""


@dataclass(frozen=True)
class Control:
    """Method, steps and estimated error of a run whose steps `simulate` chose."""

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
