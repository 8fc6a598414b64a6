"""Record of a run under a tolerance: the method and steps that were chosen, and the estimated error."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from mbs.kernel.header.limits import MOST_PARTS

FINER = 0.5 * MOST_PARTS
"""Least ratio of the tolerances of two successive runs, largest number of further runs, and largest multiple of the
tolerance without a warning."""


@dataclass(frozen=True)
class Control:
    """Method, steps and estimated error of a run whose steps `simulate` chose."""

    tolerance: float
    """Accepted error of positions over `length`."""
    length: float
    """Length of the model, m."""
    method: str
    """Name of the method that made the run."""
    reason: str
    """Reason for this method; empty if the caller named it."""
    error: float
    """Estimate of the largest error of positions, relative to `length`: the distance from a coarser run times the ratio
    of their step errors. Errors that both runs have in common are not included. An estimate below a tenth of the
    tolerance is unreliable and raised to it. It is 0 if all motion is prescribed, and NaN if the step was given,
    as no runs were compared."""
    h: float | None
    """The fixed step, s; None if the steps were under error control."""
    steps: int
    """Accepted steps of the returned run."""
    rejected: int
    """Steps that were repeated because their error was too large."""
    failed: int
    """Steps that were repeated because they did not converge."""
    forced: int
    """Steps of the smallest length that were accepted although their error exceeded their part of the tolerance."""
    smallest: float
    """Smallest accepted step, s."""
    largest: float
    """Largest accepted step, s."""
    side_steps: int
    """Extra steps to output times at which the dense output was not accurate enough."""
    runs: int
    """Number of runs, including those for the estimate and for the choice of the method."""
    moved: float = math.nan
    """Largest displacement of a coordinate, m; NaN if the step was given."""
    sensors: Mapping[str, float] = field(default_factory=dict)
    """Estimated errors of the sensors with a tolerance, in their units, by name; `error` is then the largest ratio of
    error to tolerance, times `tolerance`."""

    @property
    def kept(self) -> bool:
        """Whether the estimated error is at most `FINER` times the tolerance, or there is no estimate."""
        return not self.error > FINER * self.tolerance

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
