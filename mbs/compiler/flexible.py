"""Flexible bodies as the `flex_` arrays of the System."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.affine import Affine
from mbs.compiler.front_arrays import Locate
from mbs.model.body import Body
from mbs.model.flexibility import Flexibility
from mbs.model.model import Model

Array = NDArray[np.float64]
PAIRS = ((1, 2), (2, 0), (0, 1))
"""yz, zx, xy."""
TIME = 0.1
"""Time, s, whose square times the stiffness is a mass: a consistent start deforms bodies as little as possible."""


def flexible_bodies(model: Model) -> list[tuple[Body, Flexibility]]:
    """Flexible bodies of a model, and their flexibility."""
    return [(b, b.flexibility) for b in model.bodies if b.flexibility is not None]


def flexible_coordinates(model: Model) -> set[int]:
    """Full coordinates of flexible bodies, which are never eliminated: frames and modal amplitudes."""
    return {i for b, _ in flexible_bodies(model) for i in range(b.start, b.start + b.size)}


def flexible_cliques(model: Model, full: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z (before ordering) that each body couples in the tangent."""
    return [_body_coordinates(b, full) for b, _ in flexible_bodies(model)]


def deformation_metric(model: Model, full: Sequence[Affine], new: NDArray[np.int64]) -> sparse.csr_matrix:
    """Stiffness of the flexible bodies times TIME^2, kg, in elimination order, shape (nq, nq)."""
    rows, columns, values = [np.zeros(0, int)], [np.zeros(0, int)], [np.zeros(0)]
    for body, flexibility in flexible_bodies(model):
        coordinates = new[_body_coordinates(body, full)][12:]
        rows.append(np.repeat(coordinates, len(coordinates)))
        columns.append(np.tile(coordinates, len(coordinates)))
        values.append(TIME**2 * flexibility.K.ravel())
    entries = (np.concatenate(rows), np.concatenate(columns))
    return sparse.coo_matrix((np.concatenate(values), entries), shape=(len(new), len(new))).tocsr()


def flexible_arrays(model: Model, full: Sequence[Affine], new: NDArray[np.int64], front_of: Locate) -> dict[str, Any]:
    """The `flex_` arrays; amplitudes in the order of their coordinates."""
    counts, frames, modes, fronts, locs = [0], [], [], [], []
    data: dict[str, list[Array]] = {name: [] for name in ("gravity", "P", "c", "T", "K", "C")}
    for body, flexibility in flexible_bodies(model):
        coordinates = new[_body_coordinates(body, full)]
        order = np.argsort(coordinates[12:])
        frame, mode = coordinates[:12], coordinates[12:][order]
        front, loc = front_of([*frame.tolist(), *mode.tolist()])
        counts.append(len(mode))
        frames.append(frame)
        modes.append(mode)
        fronts.append(front)
        locs += loc
        block = np.ix_(order, order)
        data["gravity"].append(model.gravity)
        data["P"].append(flexibility.P[:, order])
        data["c"].append(flexibility.c[:, order].transpose(0, 2, 1))
        data["T"].append(_products(flexibility.T[block]))
        data["K"].append(flexibility.K[block])
        data["C"].append(flexibility.C[block])
    return {
        "flex_mode_ptr": np.cumsum(counts),
        "flex_frame": np.concatenate([np.zeros(0, int), *frames]),
        "flex_mode": np.concatenate([np.zeros(0, int), *modes]),
        "flex_front": np.array(fronts, dtype=np.int64),
        "flex_loc": np.array(locs, dtype=np.int64),
        **{f"flex_{name}": np.concatenate([np.zeros(0), *(x.ravel() for x in v)]) for name, v in data.items()},
    }


def _body_coordinates(body: Body, full: Sequence[Affine]) -> list[int]:
    """Coordinates of z of a flexible body: each of its coordinates is one of z."""
    return [next(iter(full[i].terms)) for i in range(body.start, body.start + body.size)]


def _products(T: Array) -> Array:
    """From T[j, l] = sum m phi_l phi_j' the nine matrices of the System file by columns, shape (9, n, n).

    With G_ik = sum m phi_i,j phi_k,l: G_xx, G_yy, G_zz, the symmetric parts of G_yz, G_zx, G_xy, and their
    antisymmetric parts.
    """
    G = T.transpose(3, 2, 0, 1)  # [i, k, j, l] from [j, l, k, i]
    even = [G[i, i] for i in range(3)] + [(G[i, k] + G[k, i]) / 2 for i, k in PAIRS]
    odd = [(G[i, k] - G[k, i]) / 2 for i, k in PAIRS]
    return np.array([(m + m.T) / 2 for m in even] + [(m.T - m) / 2 for m in odd])
