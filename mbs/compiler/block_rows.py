"""The rows of one block of closed loops over the coordinates of its moving bodies, all else held."""

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
"""Full coordinates of a body in space before those of its deformation."""
CARRIED = {"port": 1, "interface": 3}
"""Types of the joints that tie the coordinates of a port or a node to its body, and how many a row may tie at once:
more are those of another body, which took the place of the port's.
"""


@dataclass(frozen=True)
class MovingPart:
    """Moving coordinates of a block, their rows, and whether a body of the block bends, is driven or sprung."""

    coordinates: list[int]
    rows: list[RowTerms]
    bends: bool
    driven: bool
    sprung: bool


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


def moving_part(
    model: Model, block: Block, rows: Sequence[tuple[RowTerms, set[int]]], full: Sequence[Affine]
) -> MovingPart:
    """Coordinates and rows of a block, of all rows with their columns; drives are let go, deformations stay."""
    moving_bodies = [b for v in block.vertices if v is not block.held for b in v.bodies]
    held_bodies = [b for b in block.held.bodies if not b.is_ground]
    carrying = [
        (columns, CARRIED[model.joints[row.joint].type])
        for row, columns in rows
        if row.joint >= 0 and model.joints[row.joint].type in CARRIED
    ]
    modes = _coordinates([*moving_bodies, *held_bodies], full, deformation=True)
    held = _with_carried(_coordinates(held_bodies, full), modes, carrying)
    moving = _with_carried(_coordinates(moving_bodies, full) - held - modes, modes | held, carrying)
    block_coordinates = moving | held | modes
    tied, driven = [], False
    for row, columns in rows:
        if not columns & moving:
            continue
        if row.theta >= 0 or row.kind in ("drive", "driven_distance"):
            driven = True
        elif columns <= block_coordinates and not row.rates and row.switch < 0:
            tied.append(row)
    bends = any(b.is_flexible for b in moving_bodies)
    return MovingPart(sorted(moving), tied, bends, driven, _sprung(model, moving, full))


def _sprung(model: Model, moving: set[int], full: Sequence[Affine]) -> bool:
    """Whether a spring acts on a moving body."""
    springs = [e for e in model.elements if e.elastic]
    return any(moving & set(substitute(signal, full).terms) for e in springs for signal in e.signals)


def _coordinates(bodies: Iterable[Body], full: Sequence[Affine], deformation: bool = False) -> set[int]:
    """Coordinates of z on which the positions of bodies depend, or with `deformation` their deformations."""
    ranges = [range(b.start + RIGID, b.start + b.size) if deformation else _rigid_coordinates(b) for b in bodies]
    return {j for coordinates in ranges for i in coordinates for j in full[i].terms}


def _rigid_coordinates(body: Body) -> range:
    return range(body.start, body.start + min(body.size, RIGID))


def _with_carried(own: set[int], other: set[int], carrying: Sequence[tuple[set[int], int]]) -> set[int]:
    """`own` and the coordinates of nodes and ports that the rows in `carrying` tie to it, none of `other`."""
    coordinates, grew = set(own), True
    while grew:
        grew = False
        for columns, most in carrying:
            new = columns - coordinates - other
            if 0 < len(new) <= most and columns & coordinates:
                coordinates |= new
                grew = True
    return coordinates


def quadratics(part: MovingPart, q: Array, guides: Array) -> Quadratics:
    """The rows with all other coordinates and the guides where they are, scaled to unit gradients."""
    index = {c: k for k, c in enumerate(part.coordinates)}
    m, n = len(part.rows), len(part.coordinates)
    constant, linear, hessian = np.zeros(m), np.zeros((m, n)), np.zeros((m, n, n))
    for r, row in enumerate(part.rows):
        terms = [(1.0, row.main), *((float(guides[g]) ** power, p) for g, power, p in row.guides)]
        for factor, polynomial in terms:
            for monomial, v in polynomial.items():
                value = factor * v
                free = [index[k] for k in monomial if k in index]
                for k in monomial:
                    if k >= 0 and k not in index:
                        value *= q[k]
                if len(free) == 2:
                    hessian[r, free[0], free[1]] += value
                    hessian[r, free[1], free[0]] += value
                elif free:
                    linear[r, free[0]] += value
                else:
                    constant[r] += value
    size = np.linalg.norm(linear + hessian @ q[part.coordinates], axis=1)
    factors = 1.0 / np.where(size > 0.0, size, 1.0)
    return Quadratics(constant * factors, linear * factors[:, None], hessian * factors[:, None, None])


def affine_of(expression: Affine, full: Sequence[Affine], coordinates: Sequence[int], q: Array) -> Array:
    """Constant and coefficients of the moving coordinates, all others where they are; shape (1 + n,)."""
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
