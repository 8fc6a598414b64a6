"""Seeks parameters with which an FMU comes nearest to a log, and tells how well the log determines them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import least_squares

from hosts.common.errors import HostError
from hosts.compare.correlated import covariance, effective_samples
from hosts.compare.log import Signal
from hosts.compare.noise import computed_noise, difference_steps, measured_noise
from hosts.compare.residuals import Residuals, Unknown
from hosts.driving.co_simulation import Result

_ROUNDS = 3  # of weights
_SETTLED = 0.02  # change of the weights
_LEAST_NOISE = 0.01  # of a signal's standard deviation, for the first weights only
_NO_EFFECT = 1e-3  # of the noise, over the whole range


@dataclass(frozen=True)
class Found:
    """An unknown that was sought.

    Parameters
    ----------
    half_width : float
        Of its 95 % confidence interval; infinite where the log does not determine it.
    bound : str
        ``lower`` or ``upper`` where it lies at this bound, else empty.
    """

    unknown: Unknown
    value: float
    half_width: float
    bound: str = ""


@dataclass(frozen=True)
class Fit:
    """What was found.

    Parameters
    ----------
    correlation : ndarray of shape (p, p)
        Of the errors of the unknowns.
    before, after : float
        Root mean square of the residuals over their noise.
    chance : float
        Probability that noise alone makes a fit so much better (F-test with the effective number of samples).
    noise, misfit : dict of str to float
        By signal, in its unit: noise of the measured signal, and root mean square of what the fit leaves.
    computed_noise : float
        Of the FMU, over the noise of the signals.
    samples, effective : float
        Number of samples, and as how many uncorrelated ones they count.
    runs : int
        Of the FMU.
    """

    found: list[Found]
    correlation: NDArray[np.float64]
    before: float
    after: float
    chance: float
    noise: dict[str, float]
    misfit: dict[str, float]
    computed_noise: float
    samples: int
    effective: float
    runs: int
    converged: bool

    @property
    def parameters(self) -> dict[str, float]:
        """Values of those of the FMU."""
        return {f.unknown.name: f.value for f in self.found if f.unknown.kind == "parameter"}

    def sensor(self, signal: str) -> tuple[float, float, float, float]:
        """Delay, drift, bias and gain of a signal, as far as they were sought."""
        own = {f.unknown.kind: f.value for f in self.found if f.unknown.signal in ("", signal)}
        return own.get("delay", 0.0), own.get("drift", 0.0), own.get("bias", 0.0), own.get("gain", 1.0)


def fit(
    outputs: Mapping[str, Signal],
    unknowns: Sequence[Unknown],
    simulate: Callable[[Mapping[str, float]], Result | None],
    evaluations: int = 50,
) -> Fit:
    """Fit by bounded, scaled least squares.

    Parameters
    ----------
    outputs : mapping of str to Signal
        Samples that are compared.
    unknowns : sequence of Unknown
        Those of the FMU first.
    simulate : callable
        Of parameters of the FMU by name; None where it refuses a step.
    evaluations : int
        At most, of each round.

    Raises
    ------
    HostError
        A parameter has no effect at all.

    Notes
    -----
    Weights are the inverse of what the fit leaves of each signal (the estimate of greatest likelihood where the noise
    of a signal is not known): they begin with the noise of the measured signal and are renewed until they stay.
    """
    runs = 0

    def counted(values: Mapping[str, float]) -> Result | None:
        nonlocal runs
        runs += 1
        return simulate(values)

    noise = {n: measured_noise(s.values) for n, s in outputs.items()}
    weights = {n: max(noise[n], _LEAST_NOISE * float(np.std(s.values)), 1e-12) for n, s in outputs.items()}
    residuals = Residuals(outputs, unknowns, weights, counted)
    bounds = (np.array([u.low for u in unknowns]), np.array([u.high for u in unknowns]))
    width = np.array([u.scale for u in unknowns])
    p = np.clip([u.start for u in unknowns], bounds[0] + 1e-6 * width, bounds[1] - 1e-6 * width)
    own = computed_noise(residuals, p)
    residuals.steps, sensitivities = difference_steps(residuals, p, own)
    _check_effects(unknowns, sensitivities, own)
    start, blocks = p.copy(), residuals.blocks
    for _ in range(_ROUNDS):
        solution = least_squares(
            residuals,
            p,
            residuals.jacobian,
            bounds,
            x_scale=width,
            max_nfev=evaluations,
            xtol=1e-9,
            ftol=1e-9,
            gtol=1e-12,
        )
        p, r = solution.x, solution.fun
        left = {n: max(float(np.sqrt(np.mean(r[b] ** 2))), 1e-9) for n, b in zip(outputs, blocks, strict=True)}
        if all(abs(x - 1.0) < _SETTLED for x in left.values()):
            break
        residuals.noise = {n: residuals.noise[n] * left[n] for n in outputs}
    # Weights of the last round may be another; residuals and Jacobian as the weights are now.
    r, jacobian = residuals(p), residuals.jacobian(p)
    begun = residuals(start)
    return _judged(residuals, unknowns, p, r, jacobian, begun, noise, own, runs, bool(solution.status > 0))


def _check_effects(unknowns: Sequence[Unknown], sensitivities: NDArray[np.float64], own: float) -> None:
    for u, change in zip(unknowns, sensitivities, strict=False):
        if change < max(_NO_EFFECT, 10.0 * own):
            raise HostError(
                f"'{u.name}' from {u.low:.6g} to {u.high:.6g} {u.unit} does not change any of the compared signals (by "
                f"{change:.1g} of their noise): this log cannot tell it; leave it out, or compare signals that show it."
            )


def _judged(
    residuals: Residuals,
    unknowns: Sequence[Unknown],
    p: NDArray[np.float64],
    r: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    begun: NDArray[np.float64],
    noise: dict[str, float],
    own: float,
    runs: int,
    converged: bool,
) -> Fit:
    blocks = residuals.blocks
    spread, lost = covariance(jacobian, r, blocks)
    effective = sum(effective_samples(r[b]) for b in blocks)
    freedom = max(effective - len(p), 1.0)
    errors = np.sqrt(np.diag(spread))
    half = float(stats.t.ppf(0.975, freedom)) * errors
    finite = np.where(np.isfinite(errors) & (errors > 0.0), errors, 1.0)
    correlation = np.where(np.isfinite(spread), spread, 0.0) / np.outer(finite, finite)
    np.fill_diagonal(correlation, 1.0)
    found = [
        Found(u, float(v), math.inf if gone else float(h), _bound(u, float(v)))
        for u, v, h, gone in zip(unknowns, p, half, lost, strict=True)
    ]
    c0, c1 = float(begun @ begun), float(r @ r)
    f = max(c0 - c1, 0.0) / len(p) / (c1 / freedom) if c1 > 0.0 else math.inf
    misfit = {
        n: float(np.sqrt(np.mean(r[b] ** 2))) * residuals.noise[n]
        for n, b in zip(residuals.outputs, blocks, strict=True)
    }
    count = len(r)
    return Fit(
        found, correlation, math.sqrt(c0 / count), math.sqrt(c1 / count), float(stats.f.sf(f, len(p), freedom)), noise,
        misfit, own, count, effective, runs, converged,
    )  # fmt: skip


def _bound(unknown: Unknown, value: float) -> str:
    near = 1e-3 * (unknown.high - unknown.low) if math.isfinite(unknown.high - unknown.low) else 0.0
    if value <= unknown.low + near and near:
        return "lower"
    return "upper" if near and value >= unknown.high - near else ""


def overlapping(
    outputs: Mapping[str, Signal], end: float, skip: float, delays: Mapping[str, float]
) -> dict[str, Signal]:
    """The samples that are compared, wherever a delay near its first guess puts them.

    Parameters
    ----------
    end, skip : float
        Of the simulation; seconds that are left out at the beginning.
    delays : mapping of str to float
        First guesses that are used, s.
    """
    made = {}
    for name, signal in outputs.items():
        delay = delays.get(name, 0.0)
        margin = 3.0 * signal.interval if delay else 0.0
        made[name] = replace(signal.between(max(skip, delay + margin), min(end, end + delay - margin)))
    return made
