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

from __future__ import annotations

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

GAP = 1e-3  # of the radius: a drawing that misses the plane by less is closed by compile
FLAT = 0.05  # s below which a wheel lies rather than stands


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
    what = f"rolling joint '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {what} needs a spatial model; this one has dimension 2.")
    R, z = positive(radius, f"The radius of {what}"), number(level, f"The level of {what}")
    if isinstance(wheel, Spin):
        if centre is not None or axis is not None:
            raise ModelError(f"The {what} takes centre and axis from the spin '{wheel.name}'; leave them out.")
        model.owned_coordinate(wheel, f"The {what}")
        c, n = wheel.centre, wheel.axis
        model.remember(wheel.carrier)
        wheel.carrier.joint_points.append(_at_reference(model, c) - wheel.carrier.com)
    else:
        body = model.owned(wheel, f"The {what}")
        if body.is_ground or body.is_point or body.is_flexible:
            raise ModelError(f"The {what} needs a rigid body or a spin, not '{body.name}'.")
        if centre is None or axis is None:
            raise ModelError(f"The {what} needs the centre and the axis of the wheel on body '{body.name}'.")
        c, n = model.anchor(body, centre, what), model.anchor_axis(body, axis, what)
        square = perpendicular(unit_vector(axis, 3, f"The axis of {what}"))
    _touches(_at_reference(model, c)[2] - z, _at_reference(model, n)[2], R, what)
    height = Affine({}, -z) + c[2]
    touch = [(0.5 / R, height, height), (0.5 * R, n[2], n[2])]
    equations = [Equation(name, "touch", touch, Affine({}, -0.5 * R))]
    if isinstance(wheel, Spin):
        scaled, w = height * (1.0 / R), wheel.coordinate
        along = [(1.0, n[1], c[0]), (-1.0, n[0], c[1]), (-R, scaled, w)]
        across = [(1.0, n[0], c[0]), (1.0, n[1], c[1]), (R, scaled, n[2])]
        equations += [Equation(name, "roll", rates=along), Equation(name, "track", rates=across)]
    else:
        f, g = (model.anchor_axis(body, e, what) for e in square)
        equations += [
            Equation(name, "roll", rates=[(1.0 / R, height, c[i]), (-R, f[2], f[i]), (-R, g[2], g[i])]) for i in (0, 1)
        ]
    joint = Joint(name, "rolling", equations)
    if isinstance(wheel, Spin):
        joint.rolls = RollingSpin(R, z, wheel)
    else:
        joint.rolls = RollingBody(R, z, body, _at_reference(model, c), _at_reference(model, n))
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
    what = f"skate '{name}'"
    owned = model.owned(body, f"The {what}")
    if owned.is_ground or owned.is_point or owned.is_flexible:
        raise ModelError(f"The {what} needs a rigid body, not '{owned.name}'.")
    unit = unit_vector(direction, model.dimension, f"The direction of {what}")
    if np.linalg.norm(unit[:2]) < FLAT:
        raise ModelError(f"The {what} has the direction {unit.tolist()}, which is upright; it must lie in the plane.")
    p, d = model.anchor(body, point, what), model.anchor_axis(body, unit, what)
    joint = Joint(name, "skate", [Equation(name, "skate", rates=[(1.0, d[0], p[1]), (-1.0, d[1], p[0])])])
    if switch is not None:
        joint.switch = new_switch(model, name, switch)
    return joint


def _at_reference(model: BodyVocabulary, v: AffineVector) -> Vector:
    return v.value(model.drawn())


def _touches(height: float, n_z: float, R: float, what: str) -> None:
    """Refuse a wheel that lies, or that is drawn off the plane."""
    standing = float(np.sqrt(max(0.0, 1.0 - n_z**2)))
    if standing < FLAT:
        raise ModelError(f"The wheel of {what} lies flat, its axle is upright; it rolls only where it stands.")
    gap = float(height - R * standing)
    if abs(gap) > GAP * R:
        where = f"{gap:.4g} m above" if gap > 0.0 else f"{-gap:.4g} m below"
        raise ModelError(
            f"The wheel of {what} does not touch the plane: its lowest point is {where} it. "
            f"With the radius {R:g} m its centre must be {R * standing:.6g} m above the plane."
        )
