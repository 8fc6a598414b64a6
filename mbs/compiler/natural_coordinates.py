"""Natural coordinates: points and vectors of each body that are its full coordinates.

Points of a rigid body are affine in one point and three independent vectors of it (planar: one vector), in which its
mass matrix is constant. A joint point, differences of joint points and joint axes make equations short. With only one
point, distances depend on vectors alone, and rows keep their accuracy far from the origin. A body with many joints has
its centre of mass and its axes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine
from mbs.compiler.local_vectors import MIN_DISTANCE, body_length, distinct
from mbs.model.body import Body
from mbs.model.coordinate import CoordinateInfo
from mbs.model.model import Model

Array = NDArray[np.float64]

MAX_ITEMS = 6
"""Largest number of joint points and axes from which coordinates are chosen; a body with more has centre and axes."""
INDEPENDENT = 0.2
"""Least singular value of the chosen points and vectors, scaled to unit length."""
DROP = 1e-13
"""Coefficients below this part of the largest count as zero."""


@dataclass(frozen=True)
class NaturalCoordinates:
    """Full coordinates of a model."""

    info: list[CoordinateInfo]
    expressions: list[Affine]
    """The coordinates of the model (centre of mass and unit axes) as expressions of these."""


def natural_coordinates(model: Model) -> NaturalCoordinates:
    """Choose coordinates of rigid bodies that joints share, in place of their centres of mass and unit axes."""
    info = [*model.coordinates]
    expressions = [Affine({i: 1.0}) for i in range(len(info))]
    for body in model.bodies:
        if not (body.is_point or body.is_flexible or body.is_base):
            _choose_coordinates(body, info, expressions)
    return NaturalCoordinates(info, expressions)


Choice = tuple[str, float, Array]
"""Name, 1 for a point or 0 for a vector, and its local components, m."""


def _choose_coordinates(body: Body, info: list[CoordinateInfo], expressions: list[Affine]) -> None:
    chosen = choose(body)
    d = body.dimension
    if d == 3:
        G = np.array([[o, *w] for _, o, w in chosen]).T
        blocks = np.einsum("im,kl->mkil", np.linalg.inv(G), np.eye(3))
    else:
        H = np.array([[o, complex(*w)] for _, o, w in chosen]).T
        c = np.linalg.inv(H).T  # c[m, i]: factor of item i in r (m = 0) and a (m = 1), a rotation and scaling
        rotations = np.array([[c.real, -c.imag], [c.imag, c.real]])
        blocks = np.transpose(rotations, (2, 0, 3, 1))
    matrix = blocks.reshape(body.size, body.size)
    tolerance = DROP * np.max(np.abs(matrix))
    for i, row in enumerate(matrix.tolist(), start=body.start):
        expressions[i] = Affine({j: v for j, v in enumerate(row, start=body.start) if abs(v) > tolerance})
    for n, (name, o, w) in enumerate(chosen):
        for k in range(d):
            kind = "point" if o else "vector"
            reference = float(o * body.com[k] + w[k])
            info[body.start + d * n + k] = CoordinateInfo(f"{body.name}.{name}{'xyz'[k]}", kind, k, reference)


def choose(body: Body) -> list[Choice]:
    """Independent points and vectors of a body: of its joints first, then of its frame."""
    size, d = body_length(body), body.dimension
    frame: list[Choice] = [("r", 1.0, np.zeros(d))]
    frame += [(f"{'abc'[k]}", 0.0, size * e) for k, e in enumerate(np.eye(d)[: 1 if d == 2 else 3])]
    points = distinct(body.joint_points)
    axes = distinct([size * u for u in body.joint_axes], undirected=True)
    if not points or len(points) + len(axes) > MAX_ITEMS:
        return frame
    differences = [w - points[0] for w in points[1:]]
    items = [*(w for w in differences if np.linalg.norm(w) > MIN_DISTANCE * size), *axes]
    chosen: list[Choice] = [("p", 1.0, points[0])]
    for item in [*((f"v{n}", 0.0, w) for n, w in enumerate(items)), *frame[1:]]:
        trial = [*chosen, item]
        if _least_singular_value(trial, size) > INDEPENDENT:
            chosen = trial
        if len(chosen) == len(frame):
            return chosen
    return frame


def _least_singular_value(items: list[Choice], size: float) -> float:
    """Least singular value of the items as columns of unit length in homogeneous components."""
    if len(items[0][2]) == 2:
        columns = np.array([[o, complex(*w) / size] for _, o, w in items])
    else:
        columns = np.array([[o, *(w / size)] for _, o, w in items])
    columns = columns / np.linalg.norm(columns, axis=1, keepdims=True)
    return float(np.linalg.svd(columns, compute_uv=False)[-1])
