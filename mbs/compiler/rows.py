"""Rows of rigid bodies, in their shortest form.

A body is rigid if the six products v_i . v_j of three independent vectors of it are constant (planar: the length of one
vector). Vectors whose expressions in z are short give the fewest terms, for instance |B_2 - B_1|^2 = L^2 for a link
between two points that are coordinates.
"""

from collections.abc import Sequence
from math import hypot

import numpy as np

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector
from mbs.compiler.local_vectors import MIN_DISTANCE, body_length, distinct
from mbs.compiler.polynomial import Polynomial, RowTerms, add_product, drop_round_off, substitute
from mbs.model.body import Body

INDEPENDENT = 0.2
"""Least singular value of the chosen unit vectors (1: perpendicular)."""
MAX_POINTS = 8
"""Largest number of joint points of a body whose differences are candidates."""


def candidate_vectors(body: Body) -> list[Vector]:
    """Local vectors, m, for the rows of a body: its axes, axes of its joints, differences of its joint points."""
    if body.is_flexible:
        return list(np.eye(3))
    size = body_length(body)
    vectors: list[Vector] = [size * e for e in np.eye(body.dimension)]
    vectors += [size * u for u in body.joint_axes]
    points = distinct([np.zeros(body.dimension), *body.joint_points])[:MAX_POINTS]
    vectors += [p - q for k, p in enumerate(points) for q in points[:k]]
    return [w for w in vectors if hypot(*w.tolist()) > MIN_DISTANCE * size]


def rigid_rows(body: Body, full: Sequence[Affine], error: float = 0.0) -> list[RowTerms]:
    """Rows of a rigid body over z, with rows that hold identically.

    `full`: full coordinates as expressions in z; `error`: error of the corrected drawing, parts of its size. A row
    may be zero but for this error, which would lock the motion that the other rows allow.
    """
    if body.is_point:
        return []
    count = 1 if body.dimension == 2 else 3
    ranked = []
    for order, w in enumerate(candidate_vectors(body)):
        expression = substitute_vector(body.vector(w), full)
        terms = [len(c.terms) + (c.constant != 0.0) for c in expression.components]
        ranked.append((sum(t * t for t in terms), order, w, expression))
    ranked.sort(key=lambda item: item[:2])
    chosen: list[tuple[Vector, AffineVector]] = []
    units: list[Vector] = []
    for _, _, w, expression in ranked:
        trial = [*units, w / np.linalg.norm(w)]
        if len(trial) == 1 or np.linalg.svd(np.array(trial), compute_uv=False)[-1] > INDEPENDENT:
            chosen.append((w, expression))
            units = trial
        if len(chosen) == count:
            break
    rows = []
    for i, (w_i, v_i) in enumerate(chosen):
        for w_j, v_j in chosen[: i + 1]:
            p: Polynomial = {}
            largest = [0.0, 0.0, 0.0]
            for x, y in zip(v_i.components, v_j.components, strict=True):
                add_product(p, 1.0, x, y, largest)
            p[(-1, -1)] = p.get((-1, -1), 0.0) - float(np.dot(w_i, w_j))
            rows.append(RowTerms(body.name, "rigid", -1, -1, drop_round_off(p, body_length(body), largest, error)))
    return rows


def substitute_vector(vector: AffineVector, full: Sequence[Affine]) -> AffineVector:
    """A vector of expressions in full coordinates as one in z."""
    return AffineVector(tuple(substitute(c, full) for c in vector.components))
