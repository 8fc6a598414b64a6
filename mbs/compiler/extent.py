"""The length of a model, the unit of errors, and the length that a unit of each coordinate corresponds to."""

from collections.abc import Sequence
from math import prod

import numpy as np

from mbs.common.checks import Vector
from mbs.common.errors import ModelError
from mbs.compiler.polynomial import RowTerms
from mbs.model.body import Body
from mbs.model.model import Model

SPIN = 0.1
"""Radius of a wheel in parts of the length: its spin has no lever of its own."""
EPS = float(np.finfo(float).eps)
FAR = 1e-8
"""Round-off of a square, in parts of that of the length, that moves a point by as much of the length."""
SMALL, LARGE = 0.1, 100.0
"""Lengths of a model, m, below and above which tolerances in m are those of these lengths in parts of them."""


def model_length(model: Model) -> float:
    """The stated length, or the drawn one, m: relative errors are relative to it."""
    return drawn_length(model) if model.length is None else model.length


def drawn_length(model: Model) -> float:
    """The diagonal of the box around all bodies and joints as drawn, m.

    A single body without joints has twice its radius of gyration, several have that of their mean by mass, so that an
    inertia without mass has no length; where nothing has an extent the length is 1 m.
    """
    points = _all_points(model)
    extent = float(np.linalg.norm(np.ptp(points, axis=0))) if points else 0.0
    mass = sum(body.mass for body in model.bodies)
    polar = sum(body.mass * _gyration(body) ** 2 for body in model.bodies)
    length = max(extent, 2.0 * float(np.sqrt(polar / mass))) if mass else extent
    return length if length > 0.0 else 1.0


def check_near(model: Model, rows: Sequence[RowTerms], kinds: Sequence[str], length: float) -> None:
    """Raises `ModelError`: the model is drawn so far from the origin that squares of its coordinates lose its shape.

    `kinds`: of the coordinates z of the rows; `length`: of the model as drawn, m.
    """
    far = max((float(np.linalg.norm(p)) for p in _all_points(model)), default=0.0)
    if far <= max(1.0, length):
        return
    sizes = [far if kind == "point" else 1.0 for kind in kinds]
    for row in rows:
        largest = max((abs(v) * prod(sizes[i] for i in m if i >= 0) for m, v in row.main.items()), default=0.0)
        if EPS * largest > FAR * length**2:
            raise ModelError(
                f"The model '{model.name}' lies {far:.3g} m from the origin, {far / length:.3g} times its length: the "
                f"squares of coordinates that '{row.name}' needs are good to {EPS * largest:.2g} m2 there. Draw it "
                "nearer to the origin."
            )


def fineness(length: float) -> float:
    """Factor of tolerances in m, of the compiler and of steps, for a model of this length, m; in m2 its square."""
    return min(1.0, length / SMALL) * max(1.0, length / LARGE)


def coordinate_lengths(kinds: list[str], units: list[bool], length: float) -> list[float]:
    """Metres that one unit of each coordinate moves something by.

    `kinds`: point, vector, mode, angle or spin; `units`: whether a vector is a unit vector; others are in m; `length`:
    of the model, m.
    """
    of_kind = {"angle": length, "spin": SPIN * length}
    return [length if unit else of_kind.get(kind, 1.0) for kind, unit in zip(kinds, units, strict=True)]


def unit_vectors(model: Model, numbers: list[int]) -> list[bool]:
    """Whether full coordinates are components of unit vectors, as of flexible bodies and bases; others are in m."""
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
