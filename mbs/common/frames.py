"""Points and axes of bodies as full coordinates, and their change when the scene is translated or rotated."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Array = NDArray[np.float64]


@dataclass(frozen=True)
class AxialStiffening:
    """Axial forces of ``b`` beams by ``n`` amplitudes, and the stiffness that they add as parts of the elastic one."""

    forces: Array
    """Shape (b, n): tension per amplitude, N."""
    roots: Array
    """Shape (b, n, 6): the stiffness per tension in modes of unit elastic energy is ``root @ root.T``, N^-0.5."""
    bounds: Array
    """Shape (b,): largest eigenvalue of each stiffness per tension, 1/N."""

    def share(self, amplitudes: Array, least: float) -> float:
        """Largest part of the elastic stiffness of a deformation that the axial forces add or take.

        It is the axial force as a part of the buckling load of the body with its frame clamped: of a straight beam
        whose frame is in its middle, of the Euler load between hinged ends.

        `amplitudes`: shape (n,). A share below `least` may be returned as 0.
        """
        forces = self.forces @ amplitudes
        if np.abs(forces) @ self.bounds <= least:
            return 0.0
        stiffness = np.tensordot(self.roots * forces[:, None, None], self.roots, ((0, 2), (0, 2)))
        return float(np.abs(np.linalg.eigvalsh(stiffness)).max())


@dataclass(frozen=True)
class FlexibleShapes:
    """What a flexible body does in its floating frame, per modal amplitude."""

    name: str
    first: int
    """Index of its first amplitude among the full coordinates; the others follow."""
    turns: Array
    """Shape (nodes, 3, modes): rotation of each node per unit amplitude, rad."""
    axial: AxialStiffening


@dataclass(frozen=True)
class Frames:
    """Full coordinates ``T q + constant`` of a System: points and axes along the earth axes, angles, amplitudes."""

    T: sparse.csr_matrix
    """Shape (nf, nq)."""
    constant: Array
    """Shape (nf,)."""
    dimension: int
    """2 or 3."""
    points: tuple[int, ...]
    """First of the `dimension` full coordinates of each point."""
    vectors: tuple[int, ...]
    """First of the `dimension` full coordinates of each vector."""
    bodies: tuple[int, ...]
    """First full coordinate of each rigid body: centre of mass, then unit axes (spatial a, b, c; planar a)."""
    scalars: tuple[int, ...]
    """Full coordinates that no translation or rotation of the scene changes, and that may grow: angles and spins."""
    flexible: tuple[FlexibleShapes, ...] = ()
