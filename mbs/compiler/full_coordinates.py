"""Transformation of full coordinates q_full = T z + z0, with mass matrix and gravity of the full coordinates."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.affine import Affine
from mbs.compiler.elimination import Elimination, eliminate
from mbs.compiler.natural_coordinates import NaturalCoordinates
from mbs.compiler.polynomial import RowTerms, drop_round_off, substitute
from mbs.model.coordinate import CoordinateInfo
from mbs.model.equation import Equation
from mbs.model.model import Model

Array = NDArray[np.float64]


def reduce_coordinates(
    model: Model, natural: NaturalCoordinates, linear: Sequence[Equation], retained: set[int], length: float
) -> tuple[NaturalCoordinates, list[int], list[Affine], list[Affine], int, list[RowTerms]]:
    """Eliminate the linear equations.

    `retained`: coordinates of flexible bodies, which are never eliminated; `length`: length of the model as drawn, m.

    Returns
    -------
    natural : NaturalCoordinates
        The given ones, and for a floating scene vectors between its remaining points.
    remaining : list of int
        Natural coordinates that form z.
    full : list of Affine
        Each coordinate of the model (centre of mass, unit axes) as an expression in z.
    all : list of Affine
        Each natural coordinate as an expression in z.
    redundant : int
        Number of redundant linear equations.
    left : list of RowTerms
        Linear equations between coordinates of flexible bodies.
    """
    equations = [(e.name, substitute(e.linear_form(), natural.expressions)) for e in linear]

    def eliminate_all(info: Sequence[CoordinateInfo], equations: Sequence[tuple[str, Affine]]) -> Elimination:
        locked = {i for i, c in enumerate(info) if c.kind in ("angle", "spin")}
        points = {i for i, c in enumerate(info) if c.kind == "point"}
        # a scene without joints to the ground may move far: its rows must not contain differences of positions
        return eliminate(
            len(info),
            equations,
            locked,
            points,
            preferred_first=not model.grounded,
            retained=frozenset(retained),
            length=length,
        )

    solution = eliminate_all(natural.info, equations)
    if model.floating and (differences := _difference_coordinates(natural.info, solution, retained, model.dimension)):
        natural = NaturalCoordinates([*natural.info, *(info for info, _ in differences)], natural.expressions)
        solution = eliminate_all(natural.info, equations + [(info.name, e) for info, e in differences])
    full = [substitute(e, solution.expressions) for e in natural.expressions]
    left = []
    for i, expression in solution.left:
        terms = {(j, -1): v for j, v in expression.terms.items()} | {(-1, -1): expression.constant}
        left.append(RowTerms(linear[i].name, linear[i].kind, -1, -1, drop_round_off(terms)))
    return natural, solution.remaining, full, solution.expressions, solution.redundant, left


def _difference_coordinates(
    info: Sequence[CoordinateInfo], solution: Elimination, retained: set[int], dimension: int
) -> list[tuple[CoordinateInfo, Affine]]:
    """New coordinates, each with its equation: vectors to the remaining points from the one that most expressions use.

    A scene that moves far then has one position, and no differences of large positions.
    """
    uses = {i: sum(k in e.terms for e in solution.expressions) for k, i in enumerate(solution.remaining)}
    points = [i for i in solution.remaining if info[i].kind == "point" and info[i].component == 0]
    base = max(points, key=lambda i: (i in retained, uses[i]), default=-1)
    differences: list[tuple[CoordinateInfo, Affine]] = []
    for i in points:
        if i == base or i in retained:
            continue
        for k in range(dimension):
            point, origin, new = info[i + k], info[base + k], len(info) + len(differences)
            difference = CoordinateInfo(
                f"{point.name} - {origin.name}", "vector", k, point.reference - origin.reference
            )
            differences.append((difference, Affine({i + k: 1.0, base + k: -1.0, new: -1.0})))
    return differences


def transformation(full: Sequence[Affine], nz: int) -> tuple[sparse.csr_matrix, Array]:
    """T, shape (n_full, nz), and z0, shape (n_full,), of q_full = T z + z0."""
    pointer = np.concatenate([[0], np.cumsum([len(e.terms) for e in full])])
    columns = np.fromiter((j for e in full for j in e.terms), dtype=np.int64, count=int(pointer[-1]))
    values = np.fromiter((v for e in full for v in e.terms.values()), dtype=float, count=int(pointer[-1]))
    return sparse.csr_matrix((values, columns, pointer), shape=(len(full), nz)), np.array([e.constant for e in full])


def full_mass(model: Model, weights: Mapping[int, Array] | None = None) -> sparse.csr_matrix:
    """Mass matrix of the full coordinates, or a matrix of the blocks in `weights`, by number of the body."""
    rows, columns, values = [], [], []
    for k, body in enumerate(model.bodies):
        if weights is not None and k not in weights:
            continue
        block = body.mass_block() if weights is None else weights[k]
        i, j = np.nonzero(block)
        rows.append(i + body.start)
        columns.append(j + body.start)
        values.append(block[i, j])
    if weights is None:
        coordinates = np.array(list(model.inertias), dtype=np.int64)
        rows.append(coordinates)
        columns.append(coordinates)
        values.append(np.array(list(model.inertias.values()), dtype=float))
    n = len(model.coordinates)
    empty = np.zeros(0)
    i, j, v = (np.concatenate([empty, *arrays]) for arrays in (rows, columns, values))
    return sparse.coo_matrix((v, (i.astype(np.int64), j.astype(np.int64))), shape=(n, n)).tocsr()


def full_gravity(model: Model) -> Array:
    """Generalised gravity force on the full coordinates, N: m g on r, first moments times g on the axes."""
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


def symmetric(matrix: sparse.csr_matrix) -> sparse.csr_matrix:
    """A mass matrix made exactly symmetric, without entries that are round-off."""
    m = (0.5 * (matrix + matrix.T)).tocoo()
    diagonal = np.abs(m.tocsr().diagonal())
    # the mass of a massless direction, such as the axle of a thin disc, is set to zero
    diagonal[diagonal < 1e-14 * np.max(diagonal, initial=0.0)] = 0.0
    scale = np.sqrt(np.maximum(diagonal[m.row] * diagonal[m.col], 0.0))
    significant = (np.abs(m.data) > 1e-14 * scale) & (scale > 0.0)
    return sparse.coo_matrix((m.data[significant], (m.row[significant], m.col[significant])), shape=m.shape).tocsr()
