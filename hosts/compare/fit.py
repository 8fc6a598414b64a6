"""Finds parameters with which an FMU comes nearest to a log, and how well the log determines them."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import OptimizeResult, least_squares
from scipy.stats import qmc

from hosts.common.display_units import number_in
from hosts.common.errors import HostError
from hosts.compare.correlated_residuals import covariance, effective_samples
from hosts.compare.cross_validation import FEWEST, Parts, clustered_covariance, folds, left_out, without_each
from hosts.compare.deviations import rms
from hosts.compare.fit_result import Fit, FittedUnknown, Start
from hosts.compare.fit_unknowns import Unknown
from hosts.compare.noise import computed_noise, difference_steps, measured_noise
from hosts.compare.residuals import RefusedError, Residuals
from hosts.driving.result import Result
from hosts.measures.signal import Signal

Jacobian = Callable[[NDArray[np.float64]], NDArray[np.float64]]
Bounds = tuple[NDArray[np.float64], NDArray[np.float64]]
_ROUNDS = 3  # of weights
_SETTLED = 0.02  # change of the weights
_LEAST_NOISE = 0.01  # of a signal's standard deviation, for the first weights only
_NO_EFFECT = 1e-3  # of the noise, over the whole range
_CHANGE = 1e-5  # of the sum of squares, at which a round ends: less than 0.1 of an interval
_STEP = 1e-6  # of the unknowns, at which a round ends
_SEED = 1  # of other starts


def fit(
    outputs: Mapping[str, Signal],
    unknowns: Sequence[Unknown],
    simulate: Callable[[Mapping[str, float]], Result | str],
    evaluations: int = 50,
    starts: int = 1,
    parts: Parts | None = None,
) -> Fit:
    """Fit by bounded, scaled least squares.

    Parameters
    ----------
    unknowns : sequence of Unknown
        Those of the FMU first.
    simulate : callable
        Of parameters of the FMU by name; the reason, a sentence, where it refuses them.
    evaluations : int
        At most, of each round.
    starts : int
        How many searches: one from the given values, the others from points spread over the ranges; of these, such
        that the FMU refuses are left out.
    parts : Parts, optional
        Of the log, that are left out in turn.

    Raises
    ------
    HostError
        A parameter has no effect at all, or the FMU refuses the given values.

    Notes
    -----
    Weights are the inverse of what the fit leaves of each signal (the estimate of greatest likelihood where the noise
    of a signal is not known): they begin with what is left at the given values and are renewed until they stay. The
    search takes one-sided differences, its last steps and the intervals central ones.
    """
    runs = 0

    def counted(values: Mapping[str, float]) -> Result | str:
        nonlocal runs
        runs += 1
        return simulate(values)

    noise = {n: measured_noise(s.values) for n, s in outputs.items()}
    least = {n: max(noise[n], _LEAST_NOISE * float(np.std(s.values)), 1e-12) for n, s in outputs.items()}
    residuals = Residuals(outputs, unknowns, dict(least), counted)
    bounds = (np.array([u.low for u in unknowns]), np.array([u.high for u in unknowns]))
    width = np.array([u.scale for u in unknowns])
    p = np.clip([u.start for u in unknowns], bounds[0] + 1e-6 * width, bounds[1] - 1e-6 * width)
    # A model that misses more than noise is weighted by what it misses, so that no signal outweighs the others.
    residuals.accepted(p)
    first = residuals(p)
    residuals.noise = {n: least[n] * max(1.0, x) for n, x in residuals.left(first).items()}
    numeric_noise = computed_noise(residuals, p)
    residuals.steps, sensitivities = difference_steps(residuals, p, numeric_noise)
    _check_effects(unknowns, sensitivities, numeric_noise)
    start = p.copy()

    def search(begin: NDArray[np.float64], jacobian: Jacobian, most: int) -> OptimizeResult:
        return least_squares(
            residuals, begin, jacobian, bounds, x_scale=width, max_nfev=most, xtol=_STEP, ftol=_CHANGE, gtol=1e-12
        )

    solutions: list[OptimizeResult] = []
    searches: list[Start] = []
    refused: list[str] = []
    for k, begin in enumerate(_begins(p, unknowns, starts)):
        try:
            solutions.append(search(begin, residuals.one_sided, evaluations))
        except RefusedError as error:
            if k == 0:
                raise
            refused.append(str(error))
            continue
        searches.append(Start(begin.tolist(), solutions[-1].x.tolist(), rms(solutions[-1].fun)))
    solution = min(solutions, key=lambda t: float(t.cost))
    for _ in range(_ROUNDS - 1):
        if _weighted_anew(residuals, solution.fun):
            break
        solution = search(solution.x, residuals.one_sided, evaluations)
    converged = bool(solution.status > 0)
    p = _polished(residuals, solution.x, bounds)
    _weighted_anew(residuals, residuals(p))
    r, jacobian, begun = residuals(p), residuals.jacobian(p), residuals(start)  # as the weights are now
    result = _judged(residuals, unknowns, p, r, jacobian, begun, noise, numeric_noise, runs, converged, searches, parts)
    return replace(result, refused=refused)


def _weighted_anew(residuals: Residuals, r: NDArray[np.float64]) -> bool:
    """Weight each signal by what residuals leave of it; whether its weights stay as they were."""
    remaining = {n: max(x, 1e-9) for n, x in residuals.left(r).items()}
    residuals.noise = {n: residuals.noise[n] * x for n, x in remaining.items()}
    return all(abs(x - 1.0) < _SETTLED for x in remaining.values())


def _polished(residuals: Residuals, p: NDArray[np.float64], bounds: Bounds) -> NDArray[np.float64]:
    """A step of Gauss and Newton with central differences, which those of one side may have missed."""
    jacobian, r = residuals.jacobian(p), residuals(p)
    size = np.where((result := np.linalg.norm(jacobian, axis=0)) > 0.0, result, 1.0)
    q = np.clip(p - np.linalg.lstsq(jacobian / size, r, 1e-7)[0] / size, *bounds)
    better = residuals(q)
    smaller = float(better @ better) < float(r @ r) * (1.0 - _CHANGE)
    return np.asarray(q if smaller else p)


def _begins(p: NDArray[np.float64], unknowns: Sequence[Unknown], count: int) -> list[NDArray[np.float64]]:
    """The given values, and points of Sobol's sequence in the ranges of the FMU's parameters."""
    fmu_indices = [k for k, u in enumerate(unknowns) if u.kind == "parameter"]
    results = [p]
    if not fmu_indices:
        return results
    for point in qmc.Sobol(len(fmu_indices), rng=_SEED).random_base2(max(count - 1, 1).bit_length())[: count - 1]:
        q = p.copy()
        q[fmu_indices] = [u.low + (0.1 + 0.8 * x) * (u.high - u.low) for u, x in zip(unknowns, point, strict=False)]
        results.append(q)
    return results


def _check_effects(unknowns: Sequence[Unknown], sensitivities: NDArray[np.float64], own: float) -> None:
    for u, change in zip(unknowns, sensitivities, strict=False):
        if change < max(_NO_EFFECT, 10.0 * own):
            span = f"'{u.name}' from {u.low:.6g} to {number_in(u.high, u.unit, '.6g')}"
            raise HostError(
                f"{span} does not change any of the compared signals (by {change:.1g} of their noise): "
                "this log does not determine it; leave it out, or compare signals that show it."
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
    searches: list[Start],
    parts: Parts | None,
) -> Fit:
    blocks = residuals.blocks
    spread, lost = covariance(jacobian, r, blocks, [s.time for s in residuals.outputs.values()])
    effective = sum(effective_samples(r[b]) for b in blocks)
    freedom = max(effective - len(p), 1.0)
    errors = np.sqrt(np.diag(spread))
    half = float(stats.t.ppf(0.975, freedom)) * errors
    inside = [k for k, u in enumerate(unknowns) if not (lost[k] or _bound(u, float(p[k])))]
    outside, without = dict.fromkeys(residuals.outputs, math.nan), [math.nan] * len(p)
    by_fold: list[list[float]] = [[] for _ in p]
    if parts is not None and parts.independent >= FEWEST and inside:
        free = jacobian[:, inside]
        clustered = np.sqrt(np.diag(clustered_covariance(free, r, parts)))
        half[inside] = np.maximum(half[inside], float(stats.t.ppf(0.975, parts.independent - 1.0)) * clustered)
        errors_outside = left_out(free, r, parts)
        outside = {n: x * residuals.noise[n] for n, x in residuals.left(errors_outside).items()}
        size = rms(errors_outside)
        worse = without_each(free, r, parts, [unknowns[k].start - float(p[k]) for k in inside])
        changes = folds(free, r, parts).T
        for k, error, change in zip(inside, worse, changes, strict=True):
            # A log that is met to the last bit leaves nothing to compare with.
            without[k], by_fold[k] = error / size if size else math.nan, [float(p[k] + c) for c in change]
    finite = np.where(np.isfinite(errors) & (errors > 0.0), errors, 1.0)
    correlation = np.where(np.isfinite(spread), spread, 0.0) / np.outer(finite, finite)
    np.fill_diagonal(correlation, 1.0)
    results = [
        FittedUnknown(u, float(v), math.inf if gone else float(h), _bound(u, float(v)), w, f)
        for u, v, h, gone, w, f in zip(unknowns, p, half, lost, without, by_fold, strict=True)
    ]
    c0, c1 = float(begun @ begun), float(r @ r)
    f = max(c0 - c1, 0.0) / len(p) / (c1 / freedom) if c1 > 0.0 else math.inf
    misfit = {n: x * residuals.noise[n] for n, x in residuals.left(r).items()}
    count = len(r)
    # The likelihood of weights that are renewed: of each signal the logarithm of what is left.
    pairs = [(left, effective_samples(r[b])) for left, b in zip(misfit.values(), blocks, strict=True) if left > 0.0]
    criterion = sum(2.0 * number * math.log(left) for left, number in pairs)
    criterion += len(p) * math.log(max(effective, 1.0))
    return Fit(
        results, correlation, math.sqrt(c0 / count), math.sqrt(c1 / count), float(stats.f.sf(f, len(p), freedom)),
        noise, misfit, own, count, effective, runs, converged, searches, outside, criterion,
        {n: s.unit for n, s in residuals.outputs.items()},
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

    `end`, `skip`: of the simulation; seconds that are left out at the beginning; `delays`: first guesses that are used,
    s.
    """
    results = {}
    for name, signal in outputs.items():
        delay = delays.get(name, 0.0)
        margin = 3.0 * signal.interval if delay else 0.0
        results[name] = replace(signal.between(max(skip, delay + margin), min(end, end + delay - margin)))
    return results
