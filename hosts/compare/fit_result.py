"""What a fit has found, and how good it is."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hosts.compare.fit_unknowns import Unknown


@dataclass(frozen=True)
class FittedUnknown:
    """An unknown that was sought."""

    unknown: Unknown
    value: float
    half_width: float
    """Of its 95 % confidence interval; infinite where the log does not determine it."""
    bound: str = ""
    """``lower`` or ``upper`` where it lies at this bound, else empty."""
    without: float = math.nan
    """What is left of parts that are left out where it keeps its start value, over what is left with it; to first
    order."""
    folds: list[float] = field(default_factory=list)
    """Its values where one of four folds of the log is not fitted, to first order; empty where the log is too short."""


@dataclass(frozen=True)
class Start:
    """Where a search began, and where it led."""

    begin: list[float]
    end: list[float]
    """`begin`, `end`: the unknowns."""
    residual: float
    """Root mean square over the first weights: what the given values miss of each signal, at least its noise."""


@dataclass(frozen=True)
class Fit:
    """What was found."""

    found: list[FittedUnknown]
    correlation: NDArray[np.float64]
    """Shape (p, p): of the errors of the unknowns."""
    before: float
    after: float
    """`before`, `after`: root mean square of the residuals over their noise."""
    chance: float
    """Probability that noise alone makes a fit so much better (F-test with the effective number of samples)."""
    noise: dict[str, float]
    misfit: dict[str, float]
    """`noise`, `misfit`: by signal, in its unit: noise of the measured signal, and root mean square of what the fit
    leaves."""
    computed_noise: float
    """Of the FMU, over the noise of the signals."""
    samples: int
    effective: float
    """`samples`, `effective`: number of samples, and as how many uncorrelated ones they count."""
    runs: int
    converged: bool
    starts: list[Start]
    """One where only one was asked for; without those that the FMU refused."""
    left_out: dict[str, float]
    """By signal, in its unit: root mean square over parts of the log left out of the fit in turn, to first order."""
    criterion: float
    """Of Bayes (Schwarz), with the effective number of samples: the lower of two fits to the same log is the better."""
    units: dict[str, str]
    refused: list[str] = field(default_factory=list)
    """Of each start that the FMU refused: a sentence with its parameters."""

    @property
    def parameters(self) -> dict[str, float]:
        """Values of those of the FMU."""
        return {f.unknown.name: f.value for f in self.found if f.unknown.kind == "parameter"}

    def sensor(self, signal: str) -> tuple[float, float, float, float]:
        """Delay, drift, bias and gain of a signal, as far as they were sought."""
        own = {f.unknown.kind: f.value for f in self.found if f.unknown.signal in ("", signal)}
        return own.get("delay", 0.0), own.get("drift", 0.0), own.get("bias", 0.0), own.get("gain", 1.0)
