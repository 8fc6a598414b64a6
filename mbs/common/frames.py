"""Where the points and axes of the bodies are among the coordinates: what a shift or turn of the scene does to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FlexibleShapes:
    """How the nodes of a flexible body turn in its floating frame.

    Parameters
    ----------
    first : int
        Its first amplitude among the full coordinates; the others follow.
    turns : array of shape (nodes, 3, modes)
        Rotation of each node per unit amplitude, rad.
    """

    name: str
    first: int
    turns: Array


@dataclass(frozen=True)
class Frames:
    """Full coordinates ``T q + constant`` of a System: points and axes along the earth axes, angles, amplitudes.

    Parameters
    ----------
    T : sparse array of shape (nf, nq)
    constant : array of shape (nf,)
    dimension : int
        2 or 3.
    points, vectors : tuple of int
        First of the `dimension` full coordinates of each point and of each vector.
    bodies : tuple of int
        First full coordinate of each rigid body: centre of mass, then unit axes (spatial a, b, c; planar a).
    scalars : tuple of int
        Full coordinates that a shift or turn of the scene leaves as they are, and that may turn on: angles and spins.
    """

    T: sparse.csr_matrix
    constant: Array
    dimension: int
    points: tuple[int, ...]
    vectors: tuple[int, ...]
    bodies: tuple[int, ...]
    scalars: tuple[int, ...]
    flexible: tuple[FlexibleShapes, ...] = ()
