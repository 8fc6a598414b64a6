"""Position and velocity problem at the start, solved while the rows still have names."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu, spsolve

from mbs.common.errors import ModelError
from mbs.compiler.polynomial import RowTerms
from mbs.compiler.row_arrays import RowArrays

Array = NDArray[np.float64]

CLOSED = 1e-11
"""Violation, m, at which an assembly counts as closed."""
OPEN = 1e-8
"""Violation, m, above which it is refused."""
LEAST = 1e-3
"""Of |Phi_q|: where a row hardly moves, its violation is no distance."""
ITERATIONS = 60
REGULARISATION = 1e-11
"""Of the multipliers, against rows scaled to Phi_q M^-1 Phi_q' = 1: lets redundant rows pass."""
FREE = 1e-8
"""Weight of the kinetic energy of bodies without a given velocity."""


def solver(metric: sparse.csr_matrix, Phiq: sparse.csr_matrix) -> tuple[object, Array]:
    """Factorised [W Phi_q'; Phi_q -eps] with rows scaled to unit length, and the row factors."""
    size = np.sqrt(np.asarray(Phiq.multiply(Phiq).sum(axis=1)).ravel())
    factor = 1.0 / np.where(size > 0.0, size, 1.0)
    scaled = sparse.diags(factor) @ Phiq
    weight = float(np.mean(metric.diagonal()))
    block = sparse.bmat(
        [[metric / weight, scaled.T], [scaled, -REGULARISATION * sparse.identity(Phiq.shape[0])]], format="csc"
    )
    return splu(block), factor


def positive_metric(mass: sparse.csr_matrix) -> sparse.csr_matrix:
    """The mass matrix with a mean mass on coordinates that have none."""
    diagonal = mass.diagonal()
    mean = float(np.mean(diagonal[diagonal > 0.0])) if np.any(diagonal > 0.0) else 1.0
    return sparse.csr_matrix(mass + sparse.diags(np.where(diagonal > 0.0, 0.0, mean)))


def close_position(
    rows: Sequence[RowTerms],
    arrays: RowArrays,
    mass: sparse.csr_matrix,
    stiffness: sparse.csr_matrix,
    q: Array,
    guides: Array,
    joint_gaps: Callable[[Array], Mapping[str, float]],
    fine: float,
) -> Array:
    """The assembled position next to `q` (Gauss-Newton in the metric of the mass and of the stiffness of flexible
    bodies, kg), or a `ModelError` naming the joints that stay open; `joint_gaps`: gaps of the eliminated joints;
    `fine`: factor of the tolerances, `fineness` of the model.
    """
    if arrays.nc == 0:
        return q
    metric = (positive_metric(mass) + stiffness).tocsr()
    open_now, best, step = _violation(arrays, q, guides, fine)[0], q, 1.0
    for _ in range(ITERATIONS):
        if np.max(open_now) <= CLOSED * fine:
            return best
        phi, Phiq, _ = arrays.evaluate(best, guides)
        lu, factor = solver(metric, Phiq)
        move = lu.solve(np.concatenate([np.zeros(arrays.nq), -phi * factor]))[: arrays.nq]  # type: ignore[attr-defined]
        while step > 1e-3:
            candidate = best + step * move
            trial = _violation(arrays, candidate, guides, fine)[0]
            if np.linalg.norm(trial) < np.linalg.norm(open_now):
                break
            step *= 0.5
        else:
            break
        best, open_now, step = candidate, trial, min(1.0, 2.0 * step)
    if np.max(open_now) <= OPEN * fine:
        return best
    gaps = dict(joint_gaps(best))
    for row, value in zip(rows, open_now, strict=True):
        if row.joint >= 0:
            gaps[row.name] = max(gaps.get(row.name, 0.0), float(value))
    largest = max([OPEN * fine, *gaps.values()])
    listed = sorted((item for item in gaps.items() if item[1] > 0.01 * largest), key=lambda item: -item[1])[:6]
    raise ModelError(
        "The assembly cannot be closed; these joints stay open: "
        + ", ".join(f"'{n}' by {v:.3g} m" for n, v in listed)
        + "."
    )


def _violation(arrays: RowArrays, q: Array, guides: Array, fine: float) -> tuple[Array, sparse.csr_matrix]:
    """|Phi| / |Phi_q| per row, about metres."""
    phi, Phiq, _ = arrays.evaluate(q, guides)
    size = np.sqrt(np.asarray(Phiq.multiply(Phiq).sum(axis=1)).ravel())
    return np.abs(phi) / np.maximum(size, LEAST * fine), Phiq


def start_velocity(
    arrays: RowArrays,
    mass: sparse.csr_matrix,
    stiffness: sparse.csr_matrix,
    given: sparse.csr_matrix,
    aim: Array,
    q: Array,
    guides: Array,
    guide_rates: Array,
    near: Array | None = None,
) -> Array:
    """Velocity that satisfies the rows and comes nearest to the given velocities.

    Minimises (v-target)' given (v-target) with a slight weight on the kinetic energy of all else; repeated about its
    own result, so that the slight weight leaves no trace in the given velocities. Rates of deformation count by the
    energy they would store, so that flexible bodies start with as little vibration as the joints allow.

    Parameters
    ----------
    stiffness : csr_matrix
        Of the flexible bodies, as a mass (kg).
    given : csr_matrix
        Mass of the bodies with a given velocity, over z.
    aim : ndarray, shape (nq,)
        The same mass times the given velocities.
    near : ndarray, shape (nq,), optional
        The whole mass times the velocities of the other coordinates without joints; None: zero.
    """
    _, Phiq, phi_t = arrays.evaluate(q, guides, guide_rates)
    v = np.zeros(arrays.nq)
    if not np.any(aim) and not np.any(phi_t):
        return v
    metric = (positive_metric(mass) + stiffness).tocsr()
    if near is not None:
        v = np.atleast_1d(spsolve(metric.tocsc(), near))
    total = (given + stiffness + FREE * metric).tocsr()
    lu, factor = solver(total, Phiq)
    weight = float(np.mean(total.diagonal()))
    for _ in range(4):
        right = np.concatenate([(aim + FREE * (metric @ v)) / weight, -phi_t * factor])
        v = lu.solve(right)[: arrays.nq]  # type: ignore[attr-defined]
    # tighten Phi_q v = -Phi_t
    lu, factor = solver(metric, Phiq)
    for _ in range(2):
        v = v - lu.solve(np.concatenate([np.zeros(arrays.nq), (Phiq @ v + phi_t) * factor]))[: arrays.nq]  # type: ignore[attr-defined]
    return v
