"""Sobol' indices: the fraction of the variance of a measure that each parameter causes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from SALib.analyze import rbd_fast, sobol

from hosts.common.numbers import is_round_off

_MIN_BLOCKS = 64
_BARS = "Bars: bootstrap, 95 %; an index whose bar reaches zero or lies below it cannot be distinguished from zero."
_HARMONICS = 10  # of RBD-FAST
_MIN_RUNS_FOR_ESTIMATE = 64  # runs, of which the bootstrap of SALib uses half
_MAX_RUNS_FOR_ESTIMATE = 50_000
_SEED = 1  # of the bootstrap; SALib ignores 0


@dataclass(frozen=True)
class Indices:
    """Indices of the parameters, 0 to 1; NaN if there is none."""

    names: tuple[str, ...]
    first: NDArray[np.float64]
    first_conf: NDArray[np.float64]
    """`first`, `first_conf`, shape (d,): first-order index of each parameter, and half of its 95 % interval."""
    total: NDArray[np.float64]
    total_conf: NDArray[np.float64]
    """`total`, `total_conf`, shape (d,): total index of each parameter, and half of its 95 % interval."""
    how: str
    """A sentence on the estimator and the number of runs."""


def saltelli_indices(names: Sequence[str], points: NDArray[np.int64], y: NDArray[np.float64]) -> Indices | str:
    """First-order and total indices from a Saltelli design; or a sentence why there are none.

    Parameters
    ----------
    names : sequence of str, length d
    points : ndarray of int, shape (m,)
        Number of the point of each run in the order of `SALib.sample.sobol.sample`.
    y : ndarray of shape (m,)
        Finite.

    Notes
    -----
    A. Saltelli et al., Computer Physics Communications 181, 2010, 259-270, by SALib. A block of the design with a
    missing run is left out, since the estimators compare the runs of a block. Intervals of few blocks are too short:
    those of 16 blocks contained a total index of Ishigami's function for 75 % of 300 seeds. The bootstrap assumes
    independent blocks, which scrambled Sobol' points are not: with most numbers of blocks the intervals are too wide,
    but with 384 and 512 blocks those of one index of six contained it for 87 % and 83 % of the seeds.
    """
    width = len(names) + 2
    blocks = np.full((int(points.max()) // width + 1, width), np.nan)
    blocks.flat[points] = y
    whole = np.isfinite(blocks).all(axis=1)
    if whole.sum() < _MIN_BLOCKS:
        return f"Only {whole.sum()} blocks of {width} runs of the design are whole; indices need {_MIN_BLOCKS}."
    values = blocks[whole].ravel()
    if message := _constant_text(values):
        return message
    result = sobol.analyze(_salib_problem(names), values, calc_second_order=False, seed=_SEED)
    left_out = f"; blocks with a missing or failed run left out: {len(whole) - whole.sum()}" * (not whole.all())
    how = f"Sobol' indices by Saltelli's estimators from {whole.sum()} blocks of {width} runs{left_out}. {_BARS}"
    s1, s1_conf, st, st_conf = (np.asarray(result[k], dtype=np.float64) for k in ("S1", "S1_conf", "ST", "ST_conf"))
    return Indices(tuple(names), s1, s1_conf, st, st_conf, how)


def grid_indices(names: Sequence[str], x: NDArray[np.float64], y: NDArray[np.float64]) -> Indices | str:
    """Exact indices of a full grid of equally likely levels, by sums of squares; or a sentence why there are none.

    `x`: shape (n, d); `y`: finite, shape (n,).
    """
    codes = [np.unique(column, return_inverse=True) for column in x.T]
    shape = tuple(len(levels) for levels, _ in codes)
    positions = np.ravel_multi_index(tuple(code for _, code in codes), shape)
    if len(y) != np.prod(shape) or len(np.unique(positions)) != len(y):
        return f"The grid is not full: {len(np.unique(positions))} of {int(np.prod(shape))} points yield the measure."
    table = np.empty(len(y))
    table[positions] = y
    table = table.reshape(shape)
    variance = table.var()
    if message := _constant_text(y):
        return message
    axes = range(len(names))
    has_effect = [bool(np.ptp(table, axis=i).any()) for i in axes]  # a mean of equal numbers has rounding errors
    first = [has_effect[i] * table.mean(axis=tuple(k for k in axes if k != i)).var() / variance for i in axes]
    total = [has_effect[i] * table.var(axis=i).mean() / variance for i in axes]
    none = np.full(len(names), np.nan)
    how = f"Exact for the {' x '.join(map(str, shape))} points of the grid, each taken to be equally likely."
    return Indices(tuple(names), np.array(first), none, np.array(total), none, how)


def estimated_indices(names: Sequence[str], x: NDArray[np.float64], y: NDArray[np.float64]) -> Indices | str:
    """First-order indices of any space-filling design, by RBD-FAST; or a sentence why there are none.

    `x`: shape (n, d); `y`: finite, shape (n,).

    Notes
    -----
    S. Tarantola, D. Gatelli, T. Mara, Reliability Engineering and System Safety 91, 2006, 717-727; with the bias
    correction of J.-Y. Tissot and C. Prieur, 2012; by SALib.
    """
    if len(y) < _MIN_RUNS_FOR_ESTIMATE:
        return f"{len(y)} runs yield the measure; estimated indices need {_MIN_RUNS_FOR_ESTIMATE}."
    if message := _constant_text(y):
        return message
    if len(y) > _MAX_RUNS_FOR_ESTIMATE:
        subset = np.random.default_rng(_SEED).choice(len(y), _MAX_RUNS_FOR_ESTIMATE, replace=False)
        x, y = x[subset], y[subset]
    result = rbd_fast.analyze(_salib_problem(names), x, y, M=_HARMONICS, seed=_SEED)
    none = np.full(len(names), np.nan)
    how = (
        f"An estimate by RBD-FAST from {len(y)} runs, of the first order only: for total indices choose the sampling "
        f"method saltelli. {_BARS}"
    )
    return Indices(tuple(names), np.asarray(result["S1"]), np.asarray(result["S1_conf"]), none, none, how)


def _constant_text(values: NDArray[np.float64]) -> str:
    """A sentence if values differ by rounding errors only; otherwise empty."""
    if is_round_off(float(np.ptp(values)), float(np.abs(values).max())):
        return f"The measure is {values[0]:.6g} in all runs."
    return ""


def _salib_problem(names: Sequence[str]) -> dict[str, object]:
    return {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}
