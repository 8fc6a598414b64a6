"""The result of a fit: values of the unknowns, their uncertainty, and the quality of the fit."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hosts.compare.fit_unknowns import Unknown


@dataclass(frozen=True)
class FittedUnknown:
    """The value of one unknown, and how well the log determines it."""

    unknown: Unknown
    value: float
    half_width: float
    """Half the width of its 95 % confidence interval; infinite: the log does not determine it."""
    bound: str = ""
    """``lower`` or ``upper``: it lies at this bound; otherwise empty."""
    without: float = math.nan
    """Residual on parts left out of the fit if the unknown keeps its start value, divided by the residual with the
    unknown fitted; to first order."""
    folds: list[float] = field(default_factory=list)
    """Values if one of four folds of the log is left out, to first order; empty if the log is too short."""


@dataclass(frozen=True)
class Start:
    """A search for the unknowns from one start."""

    begin: list[float]
    """Unknowns at its start."""
    end: list[float]
    """Unknowns at its end."""
    residual: float
    """Root mean square at the end, in first weights: of each signal the residual of the given values, or its noise if
    that is larger."""


@dataclass(frozen=True)
class Fit:
    """The fit of all unknowns to a log."""

    found: list[FittedUnknown]
    correlation: NDArray[np.float64]
    """Of the errors of the p unknowns, shape (p, p)."""
    before: float
    """Root mean square of the residuals over their noise, with the given values."""
    after: float
    """The same with the fitted values."""
    chance: float
    """Probability that noise alone improves a fit as much (F-test with the effective number of samples)."""
    noise: dict[str, float]
    """Noise of each measured signal, in its unit."""
    misfit: dict[str, float]
    """Root mean square residual of each signal after the fit, in its unit."""
    computed_noise: float
    """Noise of the FMU's outputs, divided by the noise of the signals."""
    samples: int
    """Number of samples."""
    effective: float
    """Number of uncorrelated samples that they are worth."""
    runs: int
    """Number of runs of the FMU."""
    converged: bool
    starts: list[Start]
    """Searches, without those whose start the FMU refused."""
    left_out: dict[str, float]
    """Root mean square residual of each signal on parts of the log left out in turn, in its unit, to first order."""
    criterion: float
    """Bayesian information criterion (Schwarz) with the effective number of samples; of fits to one log the lowest is
    the best."""
    units: dict[str, str]
    """Unit of each signal."""
    refused: list[str] = field(default_factory=list)
    """A sentence with the parameters of each start that the FMU refused."""

    @property
    def parameters(self) -> dict[str, float]:
        """Fitted values of the parameters of the FMU, by name."""
        return {f.unknown.name: f.value for f in self.found if f.unknown.kind == "parameter"}

    def sensor(self, signal: str) -> tuple[float, float, float, float]:
        """Delay (s), drift, bias and gain of a signal; those that were not fitted are 0, 0, 0 and 1."""
        values = {f.unknown.kind: f.value for f in self.found if f.unknown.signal in ("", signal)}
        return values.get("delay", 0.0), values.get("drift", 0.0), values.get("bias", 0.0), values.get("gain", 1.0)
