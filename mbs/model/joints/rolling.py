"""Conditions on velocities: wheels that roll without slip, and skates.

A wheel is a knife edge: a circle of radius R about c with the unit axle n. It touches the level plane below c, in the
direction -(k - n_z n)/s of its own plane, where k is up and s = sqrt(1 - n_z^2) = c_z / R. With that, three conditions
of a rolling wheel are products of two coordinates or rates:

    c_z^2 + R^2 n_z^2 = R^2                              it touches
    n_y c_x' - n_x c_y' - c_z w = 0                      the contact point does not move along the track ...
    n_x c_x' + n_y c_y' + c_z n_z' = 0                   ... nor across it, both times s

with w the absolute axial rate. A body with the unit vectors f, g square to n and to each other has instead of the last
two c_z c' - R^2 (f_z f' + g_z g') = 0 in x and y.
"""

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector, number, positive
from mbs.common.checks import direction as unit_vector
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.equation import Equation
from mbs.model.joints.joint import Joint, RollingBody, RollingSpin
from mbs.model.perpendicular_vectors import perpendicular
from mbs.model.switches import new_switch

MAX_GAP = 1e-3
"""Largest gap between wheel and plane as drawn, parts of the radius, which compile closes."""
FLAT = 0.05
"""Least s of a wheel that stands."""


def rolling(
    model: BodyVocabulary,
    name: str,
    wheel: Body | Spin,
    *,
    radius: float,
    centre: ArrayLike | None = None,
    axis: ArrayLike | None = None,
    level: float = 0.0,
) -> Joint:
    """A wheel with a knife edge that rolls without slip on a level plane; it always touches.

    Parameters
    ----------
    wheel : Body or Spin
        A rigid body, or a spin on its carrier.
    radius : float
        m.
    centre, axis : array_like, shape (3,)
        As drawn, in earth axes, m and without unit; of a body, a spin has them.
    level : float
        Height z of the plane, m.

    Returns
    -------
    Joint
        It has no force that can be read.

    Raises
    ------
    ModelError
        The model is planar, the wheel is not rigid or lies flat, or it misses the plane by more than a thousandth
        of its radius.
    """
    subject = f"rolling joint '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {subject} needs a spatial model; this one has dimension 2.")
    R, z = positive(radius, f"The radius of {subject}"), number(level, f"The level of {subject}")
    if isinstance(wheel, Spin):
        if centre is not None or axis is not None:
            raise ModelError(f"The {subject} takes centre and axis from the spin '{wheel.name}'; leave them out.")
        model.owned_coordinate(wheel, f"The {subject}")
        c, n = wheel.centre, wheel.axis
        model.remember(wheel.carrier)
        wheel.carrier.joint_points.append(_drawn_value(model, c) - wheel.carrier.com)
    else:
        body = model.owned(wheel, f"The {subject}")
        if body.is_ground or body.is_point or body.is_flexible:
            raise ModelError(f"The {subject} needs a rigid body or a spin, not '{body.name}'.")
        if centre is None or axis is None:
            raise ModelError(f"The {subject} needs the centre and the axis of the wheel on body '{body.name}'.")
        c, n = model.anchor(body, centre, subject), model.anchor_axis(body, axis, subject)
        normals = perpendicular(unit_vector(axis, 3, f"The axis of {subject}"))
    _check_contact(_drawn_value(model, c)[2] - z, _drawn_value(model, n)[2], R, subject)
    height = Affine({}, -z) + c[2]
    touch = [(0.5 / R, height, height), (0.5 * R, n[2], n[2])]
    equations = [Equation(name, "touch", touch, Affine({}, -0.5 * R))]
    if isinstance(wheel, Spin):
        scaled, w = height * (1.0 / R), wheel.coordinate
        along = [(1.0, n[1], c[0]), (-1.0, n[0], c[1]), (-R, scaled, w)]
        across = [(1.0, n[0], c[0]), (1.0, n[1], c[1]), (R, scaled, n[2])]
        equations += [Equation(name, "roll", rates=along), Equation(name, "track", rates=across)]
    else:
        f, g = (model.anchor_axis(body, e, subject) for e in normals)
        equations += [
            Equation(name, "roll", rates=[(1.0 / R, height, c[i]), (-R, f[2], f[i]), (-R, g[2], g[i])]) for i in (0, 1)
        ]
    joint = Joint(name, "rolling", equations)
    if isinstance(wheel, Spin):
        joint.rolls = RollingSpin(R, z, wheel)
    else:
        joint.rolls = RollingBody(R, z, body, _drawn_value(model, c), _drawn_value(model, n))
    return joint


def skate(
    model: BodyVocabulary, name: str, body: Body, *, point: ArrayLike, direction: ArrayLike, switch: bool | None = None
) -> Joint:
    """A knife edge: a point of a body moves along a direction of the body only, seen from above.

    With d the direction the equation is ``d_x p_y' - d_y p_x' = 0``.

    Parameters
    ----------
    point, direction : array_like, shape (2,) or (3,)
        As drawn, in earth axes, m and without unit; the height is free.
    switch : bool, optional
        With a switch of the same name, on or off at the start.

    Returns
    -------
    Joint
        It has no force that can be read.

    Raises
    ------
    ModelError
        The direction is vertical, or the body is not rigid.
    """
    subject = f"skate '{name}'"
    owned = model.owned(body, f"The {subject}")
    if owned.is_ground or owned.is_point or owned.is_flexible:
        raise ModelError(f"The {subject} needs a rigid body, not '{owned.name}'.")
    unit = unit_vector(direction, model.dimension, f"The direction of {subject}")
    if np.linalg.norm(unit[:2]) < FLAT:
        raise ModelError(
            f"The {subject} has the direction {unit.tolist()}, which is upright; it must lie in the plane."
        )
    p, d = model.anchor(body, point, subject), model.anchor_axis(body, unit, subject)
    joint = Joint(name, "skate", [Equation(name, "skate", rates=[(1.0, d[0], p[1]), (-1.0, d[1], p[0])])])
    if switch is not None:
        joint.switch = new_switch(model, name, switch)
    return joint


def _drawn_value(model: BodyVocabulary, v: AffineVector) -> Vector:
    return v.value(model.drawn())


def _check_contact(height: float, n_z: float, R: float, subject: str) -> None:
    """Raise `ModelError` for a wheel that lies flat, or that does not touch the plane as drawn."""
    height_ratio = float(np.sqrt(max(0.0, 1.0 - n_z**2)))
    if height_ratio < FLAT:
        raise ModelError(f"The wheel of {subject} lies flat, its axle is upright; it rolls only upright.")
    gap = float(height - R * height_ratio)
    if abs(gap) > MAX_GAP * R:
        position = f"{gap:.4g} m above" if gap > 0.0 else f"{-gap:.4g} m below"
        raise ModelError(
            f"The wheel of {subject} does not touch the plane: its lowest point is {position} it. "
            f"With the radius {R:g} m its centre must be {R * height_ratio:.6g} m above the plane."
        )
