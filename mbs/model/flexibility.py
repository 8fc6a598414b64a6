"""Interface of a flexible body for the compiler."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.frames import AxialStiffening

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Flexibility:
    """Data of a flexible body with ``n`` modes, in earth axes as drawn; see `mbs.flexible.inertia_integrals`."""

    P: Array
    """Shape (3, n): kg."""
    c: Array
    """Shape (3, n, 3): kg m."""
    T: Array
    """Shape (n, n, 3, 3): kg."""
    K: Array
    C: Array
    """`K`, `C`, shape (n, n): modal stiffness and damping."""
    nodes: Array
    """Shape (k, 3): as drawn, m."""
    node_rotations: Array
    """Shape (k, 3, n): rad per amplitude, in the axes of the finite-element model."""
    axial: AxialStiffening
