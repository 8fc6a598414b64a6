"""Points and axes of bodies as full coordinates, and their change when the scene is translated or rotated."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FlexibleShapes:
    """Rotations of the nodes of a flexible body in its floating frame, per modal amplitude."""

    name: str
    first: int
    """Index of its first amplitude among the full coordinates; the others follow."""
    turns: Array
    """Shape (nodes, 3, modes): rotation of each node per unit amplitude, rad."""


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
