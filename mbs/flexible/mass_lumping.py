"""Lumps the mass matrix of another program to mass points."""

import numpy as np
from numpy.typing import NDArray

from mbs.common.errors import ModelError
from mbs.flexible.mass_points import MassPoints, nodal_mass_points
from mbs.flexible.sparse_matrices import Sparse

_MAX_ANISOTROPY = 1e-3  # largest relative difference between the masses along x, y and z
_ROUND_OFF = 1e-9  # negative row sum, relative to the total mass, that counts as 0


def lumped_masses(M: Sparse, positions: NDArray[np.float64], dof: NDArray[np.intp]) -> MassPoints:
    """Lump a mass matrix at the nodes, isotropic in translation; the total mass is kept.

    Row sums are used if none is negative (bars, beams, linear solids); otherwise the diagonal is scaled to the
    total (Hinton, Rock and Zienkiewicz 1976), which quadratic elements need. Rotary inertia is omitted.

    `M`: kg, shape (n_dof, n_dof); `positions`: m, shape (n, 3); `dof`: as in `FiniteElementModel`, shape (n, 6).

    Raises `ModelError` if the mass along an axis is not positive, the masses along x, y and z differ, or both row sums
    and diagonal have negative entries.
    """
    n_dof, translation = int(M.shape[0]), dof[:, :3]
    unit_translations = np.zeros((n_dof, 3))
    for axis in range(3):
        unit_translations[translation[:, axis], axis] = 1.0
    row_sums = np.asarray(M @ unit_translations)
    totals = np.einsum("ij,ij->j", unit_translations, row_sums)
    _check_totals(M, translation, totals)
    masses = np.stack([row_sums[translation[:, axis], axis] for axis in range(3)]).mean(axis=0)
    if (masses < -_ROUND_OFF * totals.mean()).any():
        masses = _diagonal_masses(M, translation)
    masses = np.maximum(masses, 0.0)  # round-off
    return nodal_mass_points(positions, masses * (totals.mean() / masses.sum()), translation, n_dof)


def _check_totals(M: Sparse, translation: NDArray[np.intp], totals: NDArray[np.float64]) -> None:
    """Raise `ModelError` if the masses along x, y and z, kg, shape (3,), are not positive and equal."""
    if not (totals > 0).all():
        raise ModelError(f"The mass matrix has a mass of {totals.min():g} kg along an axis; it must be positive.")
    if np.ptp(totals) > _MAX_ANISOTROPY * totals.mean():
        supports_removed = not (M.diagonal()[translation] != 0.0).all()
        reason = (
            "constrained degrees of freedom must not be removed from it"
            if supports_removed
            else "its degrees of freedom are not in the order of the nodes"
        )
        raise ModelError(
            f"The mass matrix has masses of {totals[0]:g}, {totals[1]:g} and {totals[2]:g} kg along x, y and z: "
            f"{reason}."
        )


def _diagonal_masses(M: Sparse, translation: NDArray[np.intp]) -> NDArray[np.float64]:
    """Mean diagonal entry of the translations of each node, kg, shape (n,), not scaled to the total."""
    diagonal = M.diagonal()[translation]
    if (diagonal < 0).any():
        node = int(np.argwhere(diagonal < 0)[0, 0])
        raise ModelError(f"The mass matrix has the negative diagonal entry {diagonal[node].min():g} at node {node}.")
    return np.asarray(diagonal.mean(axis=1))
