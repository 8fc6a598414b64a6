"""Cross-validation of a fit, to first order: each part of the log is left out in turn.

With the Jacobian at the solution the parameters without a part follow from linear equations, without further runs. The
windows that overlap a window are left out with it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from hosts.compare.deviations import rms
from hosts.compare.segments import Segment
from hosts.measures.signal import Signal

Array = NDArray[np.float64]
_PARTS_OF_RUN = 10
MIN_PARTS = 4
"""Smallest number of independent parts for a cross-validation."""
FOLDS = 4


@dataclass(frozen=True)
class Parts:
    """Parts of a log, each of which can be left out."""

    number: NDArray[np.intp]
    """Shape (n,): number of the part in which each residual lies."""
    begins: Array
    """Shape (k,): start of each part in the log, s."""
    length: float
    """Length of a part, s."""

    @property
    def independent(self) -> float:
        """Number of parts that do not overlap and cover the same time."""
        step = np.minimum(np.diff(np.sort(self.begins)), self.length)
        return 1.0 + float(step.sum()) / self.length


def parts_of(outputs: Mapping[str, Signal], segments: Sequence[Segment]) -> Parts:
    """Windows as parts, or ten equal parts of a single run.

    `outputs`: samples that are compared, in the order of the residuals.
    """
    if len(segments) > 1:
        positions = np.array([s.offset for s in segments])
        begins, length = np.array([s.begin for s in segments]), segments[0].length
    else:
        times = np.concatenate([s.time for s in outputs.values()])
        length = max(float(np.ptp(times)), 1e-9) / _PARTS_OF_RUN
        positions = begins = float(times.min()) + length * np.arange(_PARTS_OF_RUN)
    number = np.concatenate([np.searchsorted(positions - 1e-9, s.time, side="right") - 1 for s in outputs.values()])
    return Parts(np.clip(number, 0, len(positions) - 1), begins, length)


def clustered_covariance(jacobian: Array, residual: Array, parts: Parts) -> Array:
    """Covariance of parameters whose residuals may correlate within a part and between neighbouring parts.

    `jacobian`: shape (n, p); `residual`: shape (n,). Returns an array of shape (p, p).

    Notes
    -----
    (J'J)⁻¹ S'BS (J'J)⁻¹ with the scores J'r of each part in the rows of S and Bartlett's weights B over twice the
    length of a part, times k/(k - 1) (A. C. Cameron, D. L. Miller, A practitioner's guide to cluster-robust inference,
    Journal of Human Resources 50 (2015) 317-372).
    """
    scores = _sums_by_part(jacobian * residual[:, None], parts)
    distances = np.abs(parts.begins[:, None] - parts.begins) / (2.0 * parts.length)
    inverse = np.linalg.pinv(jacobian.T @ jacobian)
    count = parts.independent
    meat = scores.T @ np.clip(1.0 - distances, 0.0, None) @ scores * (count / max(count - 1.0, 1.0))
    return np.asarray(inverse @ meat @ inverse)


def jackknife(jacobian: Array, residual: Array, parts: Parts) -> Array:
    """Half widths of 95 % intervals by leaving out each part in turn, to first order, shape (p,).

    `jacobian`: shape (n, p); `residual`: shape (n,).

    Notes
    -----
    Correlated errors within a part count once. Where one part alone determines a parameter, the interval is as wide as
    the change without that part (Cameron and Miller as above, CR3).
    """
    count = len(parts.begins)
    changes = _changes(jacobian, residual, parts, [[k] for k in range(count)])
    errors = np.sqrt((count - 1) / count * np.sum(changes**2, axis=0))
    return np.asarray(float(stats.t.ppf(0.975, count - 1)) * errors)


def left_out_residuals(jacobian: Array, residual: Array, parts: Parts) -> Array:
    """Residuals of each part with the parameters fitted to the other parts, to first order, shape (n,).

    `jacobian`: shape (n, p); `residual`: shape (n,).
    """
    result = residual.copy()
    for k, change in enumerate(_changes(jacobian, residual, parts, [[k] for k in range(len(parts.begins))])):
        rows = parts.number == k
        result[rows] += jacobian[rows] @ change
    return result


def fold_changes(jacobian: Array, residual: Array, parts: Parts) -> Array:
    """Change of the parameters without each fold of the log, to first order; a fold is a sequence of parts.

    `jacobian`: shape (n, p); `residual`: shape (n,). Returns an array of shape (FOLDS, p).
    """
    order = np.argsort(parts.begins, kind="stable")
    return _changes(jacobian, residual, parts, [list(fold) for fold in np.array_split(order, FOLDS)])


def _changes(jacobian: Array, residual: Array, parts: Parts, groups: Sequence[Sequence[int]]) -> Array:
    """Change of the parameters without each group of parts and the parts that overlap it, shape (k, p)."""
    size = np.linalg.norm(jacobian, axis=0)
    size = np.where(size > 0.0, size, 1.0)
    scaled = jacobian / size
    matrices = np.array([scaled[parts.number == k].T @ scaled[parts.number == k] for k in range(len(parts.begins))])
    scores = _sums_by_part(scaled * residual[:, None], parts)
    results = []
    for group in groups:
        distances = np.abs(parts.begins[:, None] - parts.begins[list(group)]).min(axis=1)
        retained = distances >= parts.length * (1.0 - 1e-9)
        change = np.linalg.pinv(matrices[retained].sum(axis=0), rcond=1e-12) @ scores[retained].sum(axis=0)
        results.append(-change / size)
    return np.array(results)


def rms_without_each(jacobian: Array, residual: Array, parts: Parts, steps: Sequence[float]) -> list[float]:
    """Root mean square of `left_out_residuals` with each parameter in turn at its start value, to first order.

    `steps`: start value less fitted value of each parameter.
    """
    results = []
    for k, step in enumerate(steps):
        other_columns = np.delete(jacobian, k, axis=1)
        residuals = left_out_residuals(other_columns, residual + jacobian[:, k] * step, parts)
        results.append(rms(residuals))
    return results


def _sums_by_part(rows: Array, parts: Parts) -> Array:
    values = np.zeros((len(parts.begins), rows.shape[1]))
    np.add.at(values, parts.number, rows)
    return values
