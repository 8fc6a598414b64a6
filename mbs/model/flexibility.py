"""What the compiler asks of a body that bends."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Flexibility:
    """Of ``n`` modes, in earth axes in the reference configuration; see `mbs.flexible.inertia_integrals`."""

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
