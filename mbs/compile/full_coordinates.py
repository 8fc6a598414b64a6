"""From full coordinates to z: scaling to metres, the transformation q_full = T z + z0, mass and gravity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.affine import Affine
from mbs.compile.eliminate import eliminate
from mbs.compile.rows import body_length
from mbs.model.equation import Equation
from mbs.model.model import Model

Array = NDArray[np.float64]


def lengths(model: Model) -> Array:
    """Metres per unit of each full coordinate: body axes are stored as L*a so that all of z is in metres."""
    units = np.ones(len(model.coordinates))
    for body in model.bodies:
        if not body.is_point:
            units[body.start + model.dimension : body.start + body.size] = body_length(body)
    return units


def reduce_coordinates(model: Model, linear: Sequence[Equation]) -> tuple[list[int], list[Affine], int]:
    """Eliminate the linear equations.

    Returns
    -------
    kept : list of int
        Full coordinates that are z (in the units of `lengths`).
    full : list of Affine
        Each full coordinate of the model (unit axes) as an expression of z.
    redundant : int
        Linear equations that said nothing new.
    """
    units = lengths(model)
    equations = []
    for equation in linear:
        form = equation.linear_form()
        equations.append((equation.name, Affine({i: c / units[i] for i, c in form.terms.items()}, form.constant)))
    locked = {i for i, info in enumerate(model.coordinates) if info.kind in ("angle", "spin")}
    result = eliminate(len(model.coordinates), equations, locked)
    full = [e if u == 1.0 else e * (1.0 / u) for e, u in zip(result.expressions, units, strict=True)]
    return result.kept, full, result.redundant


def transformation(full: Sequence[Affine], nz: int) -> tuple[sparse.csr_matrix, Array]:
    """T, shape (n_full, nz), and z0, shape (n_full,), of q_full = T z + z0."""
    pointer = np.concatenate([[0], np.cumsum([len(e.terms) for e in full])])
    columns = np.fromiter((j for e in full for j in e.terms), dtype=np.int64, count=int(pointer[-1]))
    values = np.fromiter((v for e in full for v in e.terms.values()), dtype=float, count=int(pointer[-1]))
    return sparse.csr_matrix((values, columns, pointer), shape=(len(full), nz)), np.array([e.constant for e in full])


def full_mass(model: Model, weights: Array | None = None) -> sparse.csr_matrix:
    """Mass matrix of the full coordinates; `weights` (one per body) scale the bodies."""
    rows, columns, values = [], [], []
    for k, body in enumerate(model.bodies):
        block = body.mass_block() * (1.0 if weights is None else weights[k])
        i, j = np.nonzero(block)
        rows.append(i + body.start)
        columns.append(j + body.start)
        values.append(block[i, j])
    if weights is None:
        own = np.array(list(model.inertias), dtype=np.int64)
        rows.append(own)
        columns.append(own)
        values.append(np.array(list(model.inertias.values()), dtype=float))
    n = len(model.coordinates)
    empty = np.zeros(0)
    i, j, v = (np.concatenate([empty, *part]) for part in (rows, columns, values))
    return sparse.coo_matrix((v, (i.astype(np.int64), j.astype(np.int64))), shape=(n, n)).tocsr()


def full_gravity(model: Model) -> Array:
    """Generalised gravity of the full coordinates: m g on r, first moments times g on the axes."""
    force = np.zeros(len(model.coordinates))
    d = model.dimension
    for body in model.bodies:
        force[body.start : body.start + d] = body.mass * model.gravity
        if not body.is_point:
            s, g = body.first_moment, model.gravity
            if d == 2:
                # centre of mass r + s_x a + s_y perp(a)
                force[body.start + 2 : body.start + 4] = [s[0] * g[0] + s[1] * g[1], s[0] * g[1] - s[1] * g[0]]
            else:
                force[body.start + 3 : body.start + 12] = np.outer(s, g).ravel()
    return force
