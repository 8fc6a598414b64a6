"""Frames of a model, kept in Python in addition to the arrays of the System."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.frames import FlexibleShapes, Frames
from mbs.compiler.lookup_tables import lookup_coordinates
from mbs.model.model import Model


def frames_of(model: Model, T: sparse.csr_matrix, constant: NDArray[np.float64]) -> Frames:
    """Frames of a model whose full coordinates are ``T q + constant``."""
    points: list[int] = []
    vectors: list[int] = []
    scalars: list[int] = []
    for i, coordinate in enumerate(model.coordinates):
        if coordinate.kind in ("point", "vector"):
            if coordinate.component == 0:
                (points if coordinate.kind == "point" else vectors).append(i)
        elif coordinate.kind in ("angle", "spin"):
            scalars.append(i)
    rigid = tuple(b.start for b in model.bodies if not (b.is_point or b.is_flexible))
    flexible = tuple(
        FlexibleShapes(b.name, b.start + 12, b.flexibility.node_rotations, b.flexibility.axial)
        for b in model.bodies
        if b.flexibility is not None
    )
    table_coordinates = lookup_coordinates(model)
    if table_coordinates:  # coordinates from tables are not affine in q
        constant = constant.copy()
        constant[table_coordinates] = np.nan
    return Frames(T, constant, model.dimension, tuple(points), tuple(vectors), rigid, tuple(scalars), flexible)
