"""What a run with a tolerance, or without a step, was asked for and did."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mbs.common.checks import is_finite, shown

LEAST_TOLERANCE, MOST_TOLERANCE = 1e-11, 0.5
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
    """Guess of the largest error of positions over the run in parts of `length`: its distance from a coarser run, times
    what its steps err over what those of the other do. In nine of ten random mechanisms it is within ten times the
    error; what both runs miss is not in it, and where guides prescribe all motion it is 0. NaN where the step was
    given: nothing was compared."""
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
        said = f"{self.error:.0e}" if self.error > 0.0 else "none seen"
        return (
            f"{self.method}{reason}: {steps}; error guessed from a coarser run: {said} of the model's length of "
            f"{self.length:.4g} m, tolerance {self.tolerance:g}"
        )


def checked_tolerance(tolerance: object) -> float:
    """The tolerance as a number, or one sentence."""
    value = float(tolerance) if is_finite(tolerance) else math.nan  # type: ignore[arg-type]
    if LEAST_TOLERANCE <= value <= MOST_TOLERANCE:
        return value
    what = "it is below what round-off leaves; " if 0.0 < value < LEAST_TOLERANCE else ""
    raise ValueError(
        f"The tolerance is {shown(tolerance)}; {what}it must be a number between {LEAST_TOLERANCE:g} and "
        f"{MOST_TOLERANCE:g}: the largest error of positions in parts of the model's length."
    )
