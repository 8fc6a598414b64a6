"""Constraint rows of one block of closed loops over the coordinates of its moving bodies; all others are held."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine
from mbs.compiler.loops import Block
from mbs.compiler.polynomial import RowTerms, substitute
from mbs.model.body import Body
from mbs.model.model import Model

Array = NDArray[np.float64]

RIGID = 12
"""Full coordinates of a body in space before its deformation."""
MAX_TIED = {"port": 1, "interface": 3}
"""Joints that tie coordinates of a port or a node to its body, by type, with the largest number that one row ties: a
row with more has coordinates of another body instead of the port.
"""


@dataclass(frozen=True)
class BlockRows:
    """Moving coordinates of a block, their rows, and whether a body is flexible, is driven, has a spring."""

    coordinates: list[int]
    rows: list[RowTerms]
    flexible: bool
    driven: bool
    has_spring: bool


@dataclass(frozen=True)
class Quadratics:
    """Functions ``c + L x + x' H x / 2`` as dense arrays of shapes (m,), (m, n) and (m, n, n)."""

    constant: Array
    linear: Array
    hessian: Array

    def at(self, x: Array) -> tuple[Array, Array]:
        """Values and gradients."""
        slope = (self.hessian.reshape(-1, len(x)) @ x).reshape(self.linear.shape)  # one product is faster than m
        return self.constant + (self.linear + 0.5 * slope) @ x, self.linear + slope


def rows_of_block(
    model: Model, block: Block, rows: Sequence[tuple[RowTerms, set[int]]], full: Sequence[Affine]
) -> BlockRows:
    """Coordinates and rows of a block without its drives; deformations are held.

    `rows`: all rows, each with the coordinates it depends on; `full`: full coordinates as expressions in z.
    """
    moving_bodies = [b for v in block.vertices if v is not block.reference for b in v.bodies]
    held_bodies = [b for b in block.reference.bodies if not b.is_ground]
    tying_rows = [
        (columns, MAX_TIED[model.joints[row.joint].type])
        for row, columns in rows
        if row.joint >= 0 and model.joints[row.joint].type in MAX_TIED
    ]
    deformations = _coordinates([*moving_bodies, *held_bodies], full, deformation=True)
    held = _add_tied(_coordinates(held_bodies, full), deformations, tying_rows)
    moving = _add_tied(_coordinates(moving_bodies, full) - held - deformations, deformations | held, tying_rows)
    block_coordinates = moving | held | deformations
    block_rows, driven = [], False
    for row, columns in rows:
        if not columns & moving:
            continue
        if row.theta >= 0 or row.kind in ("drive", "driven_distance"):
            driven = True
        elif columns <= block_coordinates and not row.rates and row.switch < 0:
            block_rows.append(row)
    flexible = any(b.is_flexible for b in moving_bodies)
    return BlockRows(sorted(moving), block_rows, flexible, driven, _has_spring(model, moving, full))


def _has_spring(model: Model, moving: set[int], full: Sequence[Affine]) -> bool:
    """Whether a spring acts on a moving body."""
    springs = [e for e in model.elements if e.elastic]
    return any(moving & set(substitute(signal, full).terms) for e in springs for signal in e.signals)


def _coordinates(bodies: Iterable[Body], full: Sequence[Affine], deformation: bool = False) -> set[int]:
    """Coordinates of z on which the positions of bodies depend; with `deformation`: their deformations."""
    ranges = [range(b.start + RIGID, b.start + b.size) if deformation else _rigid_coordinates(b) for b in bodies]
    return {j for coordinates in ranges for i in coordinates for j in full[i].terms}


def _rigid_coordinates(body: Body) -> range:
    return range(body.start, body.start + min(body.size, RIGID))


def _add_tied(initial: set[int], excluded: set[int], tying_rows: Sequence[tuple[set[int], int]]) -> set[int]:
    """`initial` and the coordinates of nodes and ports that `tying_rows` tie to it, without `excluded`."""
    coordinates, changed = set(initial), True
    while changed:
        changed = False
        for columns, max_tied in tying_rows:
            new = columns - coordinates - excluded
            if 0 < len(new) <= max_tied and columns & coordinates:
                coordinates |= new
                changed = True
    return coordinates


def quadratics(block_rows: BlockRows, q: Array, guides: Array) -> Quadratics:
    """The rows in the moving coordinates, scaled to unit gradients; other coordinates and driving functions held."""
    index = {c: k for k, c in enumerate(block_rows.coordinates)}
    m, n = len(block_rows.rows), len(block_rows.coordinates)
    constant, linear, hessian = np.zeros(m), np.zeros((m, n)), np.zeros((m, n, n))
    for r, row in enumerate(block_rows.rows):
        terms = [(1.0, row.main), *((float(guides[g]) ** power, p) for g, power, p in row.guides)]
        for factor, polynomial in terms:
            for monomial, v in polynomial.items():
                value = factor * v
                moving = [index[k] for k in monomial if k in index]
                for k in monomial:
                    if k >= 0 and k not in index:
                        value *= q[k]
                if len(moving) == 2:
                    hessian[r, moving[0], moving[1]] += value
                    hessian[r, moving[1], moving[0]] += value
                elif moving:
                    linear[r, moving[0]] += value
                else:
                    constant[r] += value
    size = np.linalg.norm(linear + hessian @ q[block_rows.coordinates], axis=1)
    factors = 1.0 / np.where(size > 0.0, size, 1.0)
    return Quadratics(constant * factors, linear * factors[:, None], hessian * factors[:, None, None])


def affine_of(expression: Affine, full: Sequence[Affine], coordinates: Sequence[int], q: Array) -> Array:
    """Constant and coefficients of an expression in the moving coordinates, shape (1 + n,); all others are held."""
    of_z = substitute(expression, full)
    index = {c: k for k, c in enumerate(coordinates)}
    row = np.zeros(1 + len(coordinates))
    row[0] = of_z.constant
    for j, v in of_z.terms.items():
        if j in index:
            row[1 + index[j]] += v
        else:
            row[0] += v * q[j]
    return row
