"""Mass points from the mass matrix of another program."""

import numpy as np

from mbs.common.errors import ModelError
from mbs.flexible.mass_points import MassPoints, nodal_mass_points
from mbs.flexible.sparse_matrices import Sparse

ISOTROPY = 1e-3  # largest difference between the masses of a model along x, y and z


def lumped_masses(M: Sparse, positions: np.ndarray, dof: np.ndarray) -> MassPoints:
    """Lump a mass matrix at the nodes, isotropic in translation; the total mass is kept.

    Row sums are used if none is negative (bars, beams, linear solids); otherwise the diagonal is scaled to the
    total (Hinton, Rock and Zienkiewicz 1976), which quadratic elements need. Rotary inertia is omitted.

    `M`: shape (n_dof, n_dof); `positions`: shape (n, 3); `dof`: as in `FiniteElementModel`, shape (n, 6).
    """
    n_dof, translation = int(M.shape[0]), dof[:, :3]
    unit = np.zeros((n_dof, 3))
    for axis in range(3):
        unit[translation[:, axis], axis] = 1.0
    rows = np.asarray(M @ unit)
    totals = np.einsum("ij,ij->j", unit, rows)
    if not (totals > 0).all():
        raise ModelError(f"The mass matrix weighs {totals.min():g} kg along an axis; it must be positive.")
    if np.ptp(totals) > ISOTROPY * totals.mean():
        supports_removed = not (M.diagonal()[translation] != 0.0).all()
        reason = (
            "supports must not be removed from it"
            if supports_removed
            else "its freedoms are not in the order of the nodes"
        )
        raise ModelError(
            f"The mass matrix weighs {totals[0]:g}, {totals[1]:g} and {totals[2]:g} kg along x, y and z: {reason}."
        )
    masses = np.stack([rows[translation[:, axis], axis] for axis in range(3)]).mean(axis=0)
    if (masses < -1e-9 * totals.mean()).any():
        diagonal = M.diagonal()[translation]
        if (diagonal < 0).any():
            node = int(np.argwhere(diagonal < 0)[0, 0])
            raise ModelError(
                f"The mass matrix has the negative diagonal entry {diagonal[node].min():g} at node {node}."
            )
        masses = diagonal.mean(axis=1)
    masses = np.maximum(masses, 0.0)
    return nodal_mass_points(positions, masses * (totals.mean() / masses.sum()), translation, n_dof)
