"""Mass of a flexible body as points that move with the finite-element interpolation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from mbs.common.errors import ModelError


@dataclass(frozen=True)
class MassPoints:
    """Point masses, isotropic in translation, whose displacements are linear in the nodes'.

    With isotropy ``B' M_FEM B`` of the paper's equation (13) reduces to constant shape integrals, because A'A = I holds
    for each point. Points at the nodes give the lumped mass matrix; points at the Gauss stations of the
    elements give the consistent one, to the last digit, and the collapse holds all the same.
    """

    positions: np.ndarray
    """Shape (p, 3): undeformed, in the axes of the finite-element model, m."""
    masses: np.ndarray
    """Shape (p,): kg."""
    interpolation: sp.csr_array
    """Shape (3 p, n_dof): rows 3 k to 3 k + 2 give the displacement of point k from the nodal displacements."""

    def mass_matrix(self) -> sp.csc_array:
        """``sum_k m_k N_k' N_k``, shape (n_dof, n_dof), kg and m."""
        weighted = self.interpolation.multiply(np.repeat(self.masses, 3)[:, None])
        return sp.csc_array(self.interpolation.T @ sp.csr_array(weighted))

    def merged(self, other: MassPoints) -> MassPoints:
        """The mass points of both sets."""
        return MassPoints(
            np.vstack([self.positions, other.positions]),
            np.concatenate([self.masses, other.masses]),
            sp.csr_array(sp.vstack([self.interpolation, other.interpolation])),
        )


def nodal_mass_points(positions: np.ndarray, masses: np.ndarray, translation: np.ndarray, n_dof: int) -> MassPoints:
    """Mass points at the nodes; nodes without mass are omitted.

    `positions`: shape (n, 3); `masses`: shape (n,); `translation`: numbers of the translations of each node among the
    `n_dof` degrees of freedom, shape (n, 3).
    """
    mass_nodes = np.flatnonzero(masses)
    rows = np.arange(3 * mass_nodes.size)
    interpolation = sp.csr_array(
        (np.ones(rows.size), (rows, translation[mass_nodes].ravel())), shape=(rows.size, n_dof)
    )
    return MassPoints(positions[mass_nodes], masses[mass_nodes], interpolation)


def rigid_motions(points: np.ndarray) -> np.ndarray:
    """Displacements of points (p, 3) for unit translations and unit small rotations, shape (p, 3, 6)."""
    motions = np.zeros((len(points), 3, 6))
    for axis in range(3):
        motions[:, axis, axis] = 1.0
        motions[:, :, 3 + axis] = np.cross(np.eye(3)[axis], points)
    return motions


def check_masses(masses: np.ndarray, names: tuple[str, ...]) -> None:
    """Refuse masses that are negative or not finite, one per node."""
    invalid = np.flatnonzero(~(np.isfinite(masses) & (masses >= 0.0)))
    if invalid.size:
        raise ModelError(f"The mass at node {names[invalid[0]]!r} is {masses[invalid[0]]:g} kg; it cannot be negative.")
