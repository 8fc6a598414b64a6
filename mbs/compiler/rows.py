"""Rows of the System: rigidity of bodies in their shortest form, and the joint equations that are not linear.

A body is rigid if three independent vectors of it keep their six products v_i . v_j (planar: one vector its length).
Which vectors is free: those whose expressions in z are short give the fewest terms, for instance |B_2 - B_1|^2 = L^2
for a link between two points that are coordinates.
"""

from collections.abc import Sequence
from math import hypot

import numpy as np

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector
from mbs.compiler.local_vectors import SHORT, body_length, distinct
from mbs.compiler.polynomial import Polynomial, RowTerms, add_product, cleaned, substitute
from mbs.model.body import Body

INDEPENDENT = 0.2
"""Smallest singular value of the chosen unit vectors (1: perpendicular)."""
MOST_POINTS = 8
"""Differences are formed among this many joint points of a body at most."""


def candidates(body: Body) -> list[Vector]:
    """Local vectors a rigid-body equation may use: axes of the body and of its joints, differences of its joint
    points.
    """
    if body.is_flexible:
        return list(np.eye(3))
    size = body_length(body)
    vectors: list[Vector] = [size * e for e in np.eye(body.dimension)]
    vectors += [size * u for u in body.joint_axes]
    points = distinct([np.zeros(body.dimension), *body.joint_points])[:MOST_POINTS]
    vectors += [p - q for k, p in enumerate(points) for q in points[:k]]
    return [w for w in vectors if hypot(*w.tolist()) > SHORT * size]


def rigid_rows(body: Body, full: Sequence[Affine], error: float = 0.0) -> list[RowTerms]:
    """Rigidity of one body over z; rows that hold identically are still among them.

    `error`: of the corrected drawing, parts of its size. The remainder of a row after the correction holds in the
    corrected motion, but its round-off would fix the motion that the other rows allow.
    """
    if body.is_point:
        return []
    count = 1 if body.dimension == 2 else 3
    ranked = []
    for order, w in enumerate(candidates(body)):
        expression = in_z(body.vector(w), full)
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
            rows.append(RowTerms(body.name, "rigid", -1, -1, cleaned(p, body_length(body), largest, error)))
    return rows


def in_z(vector: AffineVector, full: Sequence[Affine]) -> AffineVector:
    """A vector of full coordinates as one of z."""
    return AffineVector(tuple(substitute(c, full) for c in vector.components))
