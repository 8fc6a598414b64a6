"""Length of a model, to which errors are relative, and lengths that units of its coordinates correspond to."""

from collections.abc import Sequence
from math import prod

import numpy as np

from mbs.common.checks import Vector
from mbs.common.errors import ModelError
from mbs.compiler.polynomial import RowTerms
from mbs.model.body import Body
from mbs.model.model import Model

SPIN_ARM = 0.1
"""Arm by which a spin angle counts as a length, parts of the length of the model."""
EPS = float(np.finfo(float).eps)
MAX_ROUND_OFF = 1e-8
"""Largest round-off of squared coordinates, parts of the squared length."""
SMALL, LARGE = 0.1, 100.0
"""Lengths of a model, m, below and above which tolerances in m are proportional to the length."""


def model_length(model: Model) -> float:
    """The stated length, or the drawn one, m, to which relative errors refer."""
    return drawn_length(model) if model.length is None else model.length


def drawn_length(model: Model) -> float:
    """The diagonal of the box around all bodies and joints as drawn, m.

    At least twice the radius of gyration of the bodies, averaged by mass; 1 m where nothing has an extent.
    """
    points = _all_points(model)
    extent = float(np.linalg.norm(np.ptp(points, axis=0))) if points else 0.0
    mass = sum(body.mass for body in model.bodies)
    polar = sum(body.mass * _gyration(body) ** 2 for body in model.bodies)
    length = max(extent, 2.0 * float(np.sqrt(polar / mass))) if mass else extent
    return length if length > 0.0 else 1.0


def check_distance(model: Model, rows: Sequence[RowTerms], kinds: Sequence[str], length: float) -> None:
    """Raise `ModelError` if a model is so far from the origin that squared coordinates lose its shape to round-off.

    `kinds`: kinds of the coordinates z of the rows; `length`: length of the model as drawn, m.
    """
    distance = max((float(np.linalg.norm(p)) for p in _all_points(model)), default=0.0)
    if distance <= max(1.0, length):
        return
    sizes = [distance if kind == "point" else 1.0 for kind in kinds]
    for row in rows:
        largest = max((abs(v) * prod(sizes[i] for i in m if i >= 0) for m, v in row.main.items()), default=0.0)
        if EPS * largest > MAX_ROUND_OFF * length**2:
            raise ModelError(
                f"The model '{model.name}' lies {distance:.3g} m from the origin, {distance / length:.3g} times its "
                f"length: the squares of coordinates that '{row.name}' needs are good to {EPS * largest:.2g} m2 there. "
                "Draw it nearer to the origin."
            )


def length_tolerance_factor(length: float) -> float:
    """Factor of tolerances in m for a model of a length, m; for tolerances in m2 its square."""
    return min(1.0, length / SMALL) * max(1.0, length / LARGE)


def coordinate_lengths(kinds: list[str], units: list[bool], length: float) -> list[float]:
    """Displacement, m, that one unit of each coordinate corresponds to.

    `kinds`: point, vector, mode, angle or spin; `units`: whether a vector is a unit vector; others are in m; `length`:
    of the model, m.
    """
    of_kind = {"angle": length, "spin": SPIN_ARM * length}
    return [length if unit else of_kind.get(kind, 1.0) for kind, unit in zip(kinds, units, strict=True)]


def unit_vectors(model: Model, numbers: list[int]) -> list[bool]:
    """Whether full coordinates are components of unit vectors of flexible bodies and bases; others are in m."""
    axes = {b.start + k for b in model.bodies if b.flexibility is not None or b.is_base for k in range(3, 12)}
    return [k in axes for k in numbers]


def _all_points(model: Model) -> list[Vector]:
    return [p for body in (model.ground, *model.bodies) for p in _points(body)]


def _points(body: Body) -> list[Vector]:
    if body.flexibility is not None:
        return list(body.flexibility.nodes)
    centre = [] if body.is_ground else [body.com]
    return centre + [body.com + p for p in body.joint_points]


def _gyration(body: Body) -> float:
    return 0.0 if body.is_point or body.flexibility is not None else body.gyration
