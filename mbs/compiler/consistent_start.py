"""Position and velocity problem at the start."""

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
"""Violation, m, above which an assembly is refused."""
MIN_GRADIENT = 1e-3
"""Least |Phi_q| by which a violation is divided to make it a distance."""
ITERATIONS = 60
REGULARISATION = 1e-11
"""Regularisation of the multipliers for redundant rows; rows have unit length."""
FREE_WEIGHT = 1e-8
"""Weight of the kinetic energy of bodies without a given velocity."""
MASSLESS = 1e-12
"""Weight of velocities without mass, such as rates of relative angles, parts of the mean mass: they have no energy."""


def factorise(metric: sparse.csr_matrix, Phiq: sparse.csr_matrix) -> tuple[object, Array]:
    """Factorisation of [W Phi_q'; Phi_q -eps], with rows scaled to unit length, and the factors of the rows."""
    size = np.sqrt(np.asarray(Phiq.multiply(Phiq).sum(axis=1)).ravel())
    factor = 1.0 / np.where(size > 0.0, size, 1.0)
    scaled = sparse.diags(factor) @ Phiq
    weight = float(np.mean(metric.diagonal()))
    block = sparse.bmat(
        [[metric / weight, scaled.T], [scaled, -REGULARISATION * sparse.identity(Phiq.shape[0])]], format="csc"
    )
    return splu(block), factor


def positive_metric(mass: sparse.csr_matrix, part: float) -> sparse.csr_matrix:
    """The mass matrix with a part of the mean mass on coordinates that have none."""
    diagonal = mass.diagonal()
    mean = float(np.mean(diagonal[diagonal > 0.0])) if np.any(diagonal > 0.0) else 1.0
    return sparse.csr_matrix(mass + sparse.diags(np.where(diagonal > 0.0, 0.0, part * mean)))


def close_position(
    rows: Sequence[RowTerms],
    arrays: RowArrays,
    mass: sparse.csr_matrix,
    stiffness: sparse.csr_matrix,
    q: Array,
    guides: Array,
    joint_gaps: Callable[[Array], Mapping[str, float]],
    tolerance_factor: float,
) -> Array:
    """The assembled position next to `q`, by Gauss-Newton in the metric of the mass and of the stiffness, kg.

    `joint_gaps`: returns gaps of the eliminated joints, m; `tolerance_factor`: `length_tolerance_factor`.
    Raises `ModelError`: joints stay open, which it names.
    """
    if arrays.nc == 0:
        return q
    metric = (positive_metric(mass, 1.0) + stiffness).tocsr()
    violation, position, step = _violation(arrays, q, guides, tolerance_factor)[0], q, 1.0
    for _ in range(ITERATIONS):
        if np.max(violation) <= CLOSED * tolerance_factor:
            return position
        phi, Phiq, _ = arrays.evaluate(position, guides)
        lu, factor = factorise(metric, Phiq)
        correction = lu.solve(np.concatenate([np.zeros(arrays.nq), -phi * factor]))[: arrays.nq]  # type: ignore[attr-defined]
        while step > 1e-3:
            candidate = position + step * correction
            trial = _violation(arrays, candidate, guides, tolerance_factor)[0]
            if np.linalg.norm(trial) < np.linalg.norm(violation):
                break
            step *= 0.5
        else:
            break
        position, violation, step = candidate, trial, min(1.0, 2.0 * step)
    if np.max(violation) <= OPEN * tolerance_factor:
        return position
    gaps = dict(joint_gaps(position))
    for row, value in zip(rows, violation, strict=True):
        if row.joint >= 0:
            gaps[row.name] = max(gaps.get(row.name, 0.0), float(value))
    largest = max([OPEN * tolerance_factor, *gaps.values()])
    largest_gaps = sorted((item for item in gaps.items() if item[1] > 0.01 * largest), key=lambda item: -item[1])[:6]
    raise ModelError(
        "The assembly cannot be closed; these joints stay open: "
        + ", ".join(f"'{n}' by {v:.3g} m" for n, v in largest_gaps)
        + "."
    )


def _violation(arrays: RowArrays, q: Array, guides: Array, tolerance_factor: float) -> tuple[Array, sparse.csr_matrix]:
    """|Phi| / |Phi_q| of each row, approximately m, and Phi_q."""
    phi, Phiq, _ = arrays.evaluate(q, guides)
    size = np.sqrt(np.asarray(Phiq.multiply(Phiq).sum(axis=1)).ravel())
    return np.abs(phi) / np.maximum(size, MIN_GRADIENT * tolerance_factor), Phiq


def start_velocity(
    arrays: RowArrays,
    mass: sparse.csr_matrix,
    stiffness: sparse.csr_matrix,
    given_mass: sparse.csr_matrix,
    given_momentum: Array,
    q: Array,
    guides: Array,
    driving_rates: Array,
    free_momentum: Array | None = None,
) -> Array:
    """Velocity that satisfies the rows and comes nearest to the given velocities.

    Minimises the kinetic energy of the difference from the given velocities, plus a small weight times the energy of
    all other velocities; repeated about its own result, so that the weight does not change the given velocities. Rates
    of deformation count by their elastic energy, so that flexible bodies start with as little vibration as the joints
    allow.

    Parameters
    ----------
    stiffness : csr_matrix
        Of the flexible bodies, as a mass (kg).
    given_mass : csr_matrix
        Mass of the bodies with a given velocity, in z.
    given_momentum : ndarray, shape (nq,)
        The same mass times the given velocities.
    free_momentum : ndarray, shape (nq,), optional
        The whole mass times the velocities of the other coordinates without joints; None: zero.
    """
    _, Phiq, phi_t = arrays.evaluate(q, guides, driving_rates)
    v = np.zeros(arrays.nq)
    if not np.any(given_momentum) and not np.any(phi_t):
        return v
    metric = (positive_metric(mass, MASSLESS) + stiffness).tocsr()
    if free_momentum is not None:
        v = np.atleast_1d(spsolve(metric.tocsc(), free_momentum))
    total = (given_mass + stiffness + FREE_WEIGHT * metric).tocsr()
    lu, factor = factorise(total, Phiq)
    weight = float(np.mean(total.diagonal()))
    for _ in range(4):
        right = np.concatenate([(given_momentum + FREE_WEIGHT * (metric @ v)) / weight, -phi_t * factor])
        v = lu.solve(right)[: arrays.nq]  # type: ignore[attr-defined]
    # reduce the error of Phi_q v = -Phi_t to round-off
    lu, factor = factorise(metric, Phiq)
    for _ in range(2):
        v = v - lu.solve(np.concatenate([np.zeros(arrays.nq), (Phiq @ v + phi_t) * factor]))[: arrays.nq]  # type: ignore[attr-defined]
    return v
