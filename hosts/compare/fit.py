"""Fits parameters of an FMU to a log, and estimates how well the log determines them."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import OptimizeResult, least_squares
from scipy.stats import qmc

from hosts.common.display_units import number_in
from hosts.common.errors import HostError
from hosts.compare.correlated_residuals import covariance, effective_samples
from hosts.compare.cross_validation import (
    MIN_PARTS,
    Parts,
    clustered_covariance,
    fold_changes,
    left_out_residuals,
    rms_without_each,
)
from hosts.compare.deviations import rms
from hosts.compare.fit_result import Fit, FittedUnknown, Start
from hosts.compare.fit_unknowns import Unknown
from hosts.compare.noise import computed_noise, difference_steps, measured_noise
from hosts.compare.residuals import RefusedError, Residuals
from hosts.driving.result import Result
from hosts.measures.signal import Signal

Bounds = tuple[NDArray[np.float64], NDArray[np.float64]]
_MAX_ROUNDS = 3  # searches, each with updated weights
_SETTLED = 0.02  # relative change of the weights
_MIN_NOISE = 0.01  # of a signal's standard deviation, for the first weights only
_NO_EFFECT = 1e-3  # of the noise, over the whole range of a parameter
_CHANGE = 1e-5  # relative change of the sum of squares at which a search ends: less than 0.1 of an interval
_STEP = 1e-6  # relative change of the unknowns at which a search ends
_SEED = 1  # of random start points


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
        Function of the parameters of the FMU by name; a sentence instead of a result if the FMU refuses them.
    evaluations : int
        Largest number of evaluations of a search.
    starts : int
        Number of searches: one from the given values, the others from points spread over the ranges, without those that
        the FMU refuses.
    parts : Parts, optional
        Parts of the log that are left out in turn.

    Raises
    ------
    HostError
        A parameter has no effect, or the FMU refuses the given values.

    Notes
    -----
    The weight of a signal is the inverse of its root mean square residual (the maximum-likelihood estimate where the
    noise of a signal is not known): it begins with the residual of the given values and is updated until it is
    constant. The searches use one-sided differences, the last step and the intervals central ones.
    """
    runs = 0

    def counted(values: Mapping[str, float]) -> Result | str:
        nonlocal runs
        runs += 1
        return simulate(values)

    noise = {n: measured_noise(s.values) for n, s in outputs.items()}
    least_noise = {n: max(noise[n], _MIN_NOISE * float(np.std(s.values)), 1e-12) for n, s in outputs.items()}
    residuals = Residuals(outputs, unknowns, dict(least_noise), counted)
    bounds = (np.array([u.low for u in unknowns]), np.array([u.high for u in unknowns]))
    scale = np.array([u.scale for u in unknowns])
    point = np.clip([u.start for u in unknowns], bounds[0] + 1e-6 * scale, bounds[1] - 1e-6 * scale)
    # A signal whose model error exceeds the noise is weighted by that error, so that no signal outweighs the others.
    residuals.accepted_curves(point)
    r = residuals(point)
    residuals.noise = {n: least_noise[n] * max(1.0, x) for n, x in residuals.rms_by_signal(r).items()}
    numeric_noise = computed_noise(residuals, point)
    residuals.steps, sensitivities = difference_steps(residuals, point, numeric_noise)
    _check_effects(unknowns, sensitivities, numeric_noise)
    start = point.copy()

    def search(begin: NDArray[np.float64]) -> OptimizeResult:
        return least_squares(
            residuals, begin, residuals.one_sided_jacobian, bounds,
            x_scale=scale, max_nfev=evaluations, xtol=_STEP, ftol=_CHANGE, gtol=1e-12,
        )  # fmt: skip

    solution, searches, refused = _search_from_all(search, _start_points(point, unknowns, starts))
    for _ in range(_MAX_ROUNDS - 1):
        if _update_weights(residuals, solution.fun):
            break
        solution = search(solution.x)
    converged = bool(solution.status > 0)
    point = _refine(residuals, solution.x, bounds)
    _update_weights(residuals, residuals(point))
    r, jacobian, r_start = residuals(point), residuals.jacobian(point), residuals(start)  # with the last weights
    result = _evaluate_fit(
        residuals, unknowns, point, r, jacobian, r_start, noise, numeric_noise, runs, converged, searches, parts
    )
    return replace(result, refused=refused)


def _search_from_all(
    search: Callable[[NDArray[np.float64]], OptimizeResult], points: Iterable[NDArray[np.float64]]
) -> tuple[OptimizeResult, list[Start], list[str]]:
    """The best solution, all searches, and the sentences of start points that the FMU refuses.

    Raises `RefusedError` if it refuses the first point, that of the given values.
    """
    solutions: list[OptimizeResult] = []
    searches: list[Start] = []
    refused: list[str] = []
    for k, begin in enumerate(points):
        try:
            solutions.append(search(begin))
        except RefusedError as error:
            if k == 0:
                raise
            refused.append(str(error))
            continue
        searches.append(Start(begin.tolist(), solutions[-1].x.tolist(), rms(solutions[-1].fun)))
    return min(solutions, key=lambda t: float(t.cost)), searches, refused


def _update_weights(residuals: Residuals, r: NDArray[np.float64]) -> bool:
    """Weight each signal by the inverse of its residual. Returns whether the weights have hardly changed."""
    factors = {n: max(x, 1e-9) for n, x in residuals.rms_by_signal(r).items()}
    residuals.noise = {n: residuals.noise[n] * x for n, x in factors.items()}
    return all(abs(x - 1.0) < _SETTLED for x in factors.values())


def _refine(residuals: Residuals, p: NDArray[np.float64], bounds: Bounds) -> NDArray[np.float64]:
    """The point after a Gauss-Newton step with central differences, if that lowers the sum of squares."""
    jacobian, r = residuals.jacobian(p), residuals(p)
    size = np.where((norms := np.linalg.norm(jacobian, axis=0)) > 0.0, norms, 1.0)
    q = np.clip(p - np.linalg.lstsq(jacobian / size, r, 1e-7)[0] / size, *bounds)
    q_residuals = residuals(q)
    smaller = float(q_residuals @ q_residuals) < float(r @ r) * (1.0 - _CHANGE)
    return np.asarray(q if smaller else p)


def _start_points(p: NDArray[np.float64], unknowns: Sequence[Unknown], count: int) -> list[NDArray[np.float64]]:
    """Start points of the searches: the given values, and points of a Sobol' sequence in the ranges of parameters."""
    fmu_indices = [k for k, u in enumerate(unknowns) if u.kind == "parameter"]
    results = [p]
    if not fmu_indices:
        return results
    for point in qmc.Sobol(len(fmu_indices), rng=_SEED).random_base2(max(count - 1, 1).bit_length())[: count - 1]:
        q = p.copy()
        q[fmu_indices] = [u.low + (0.1 + 0.8 * x) * (u.high - u.low) for u, x in zip(unknowns, point, strict=False)]
        results.append(q)
    return results


def _check_effects(unknowns: Sequence[Unknown], sensitivities: NDArray[np.float64], numeric_noise: float) -> None:
    for u, change in zip(unknowns, sensitivities, strict=False):
        if change < max(_NO_EFFECT, 10.0 * numeric_noise):
            span = f"'{u.name}' from {u.low:.6g} to {number_in(u.high, u.unit, '.6g')}"
            raise HostError(
                f"{span} does not change any of the compared signals (by {change:.1g} of their noise): "
                "this log does not determine it; leave it out, or compare signals that show it."
            )


def _evaluate_fit(
    residuals: Residuals,
    unknowns: Sequence[Unknown],
    p: NDArray[np.float64],
    r: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    r_start: NDArray[np.float64],
    noise: dict[str, float],
    numeric_noise: float,
    runs: int,
    converged: bool,
    searches: list[Start],
    parts: Parts | None,
) -> Fit:
    blocks = residuals.blocks
    covariances, undetermined = covariance(jacobian, r, blocks, [s.time for s in residuals.outputs.values()])
    effective = sum(effective_samples(r[b]) for b in blocks)
    freedom = max(effective - len(p), 1.0)
    errors = np.sqrt(np.diag(covariances))
    half = float(stats.t.ppf(0.975, freedom)) * errors
    inside = [k for k, u in enumerate(unknowns) if not (undetermined[k] or _bound_reached(u, float(p[k])))]
    left_out, without = dict.fromkeys(residuals.outputs, math.nan), [math.nan] * len(p)
    by_fold: list[list[float]] = [[] for _ in p]
    if parts is not None and parts.independent >= MIN_PARTS and inside:
        columns = jacobian[:, inside]
        clustered = np.sqrt(np.diag(clustered_covariance(columns, r, parts)))
        half[inside] = np.maximum(half[inside], float(stats.t.ppf(0.975, parts.independent - 1.0)) * clustered)
        errors_outside = left_out_residuals(columns, r, parts)
        left_out = {n: x * residuals.noise[n] for n, x in residuals.rms_by_signal(errors_outside).items()}
        size = rms(errors_outside)
        worse = rms_without_each(columns, r, parts, [unknowns[k].start - float(p[k]) for k in inside])
        changes = fold_changes(columns, r, parts).T
        for k, error, change in zip(inside, worse, changes, strict=True):
            # A log that is reproduced exactly has no residual to compare with.
            without[k], by_fold[k] = error / size if size else math.nan, [float(p[k] + c) for c in change]
    finite = np.where(np.isfinite(errors) & (errors > 0.0), errors, 1.0)
    correlation = np.where(np.isfinite(covariances), covariances, 0.0) / np.outer(finite, finite)
    np.fill_diagonal(correlation, 1.0)
    results = [
        FittedUnknown(u, float(v), math.inf if gone else float(h), _bound_reached(u, float(v)), w, f)
        for u, v, h, gone, w, f in zip(unknowns, p, half, undetermined, without, by_fold, strict=True)
    ]
    c0, c1 = float(r_start @ r_start), float(r @ r)
    f = max(c0 - c1, 0.0) / len(p) / (c1 / freedom) if c1 > 0.0 else math.inf
    misfit = {n: x * residuals.noise[n] for n, x in residuals.rms_by_signal(r).items()}
    count = len(r)
    # With estimated weights the log-likelihood of a signal is the logarithm of its residual.
    pairs = [(left, effective_samples(r[b])) for left, b in zip(misfit.values(), blocks, strict=True) if left > 0.0]
    criterion = sum(2.0 * number * math.log(left) for left, number in pairs)
    criterion += len(p) * math.log(max(effective, 1.0))
    return Fit(
        results, correlation, math.sqrt(c0 / count), math.sqrt(c1 / count), float(stats.f.sf(f, len(p), freedom)),
        noise, misfit, numeric_noise, count, effective, runs, converged, searches, left_out, criterion,
        {n: s.unit for n, s in residuals.outputs.items()},
    )  # fmt: skip


def _bound_reached(unknown: Unknown, value: float) -> str:
    near = 1e-3 * (unknown.high - unknown.low) if math.isfinite(unknown.high - unknown.low) else 0.0
    if value <= unknown.low + near and near:
        return "lower"
    return "upper" if near and value >= unknown.high - near else ""


def overlapping(
    outputs: Mapping[str, Signal], end: float, skip: float, delays: Mapping[str, float]
) -> dict[str, Signal]:
    """The samples of signals that overlap with the simulation at a delay near its first guess.

    `end`: end of the simulation, s; `skip`: time that is left out at the beginning, s; `delays`: first guesses, s.
    """
    results = {}
    for name, signal in outputs.items():
        delay = delays.get(name, 0.0)
        margin = 3.0 * signal.interval if delay else 0.0
        results[name] = replace(signal.between(max(skip, delay + margin), min(end, end + delay - margin)))
    return results
