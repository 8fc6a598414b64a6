"""Joint: a name, its equations and the data for sensors and drawing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import Vector, array, is_number
from mbs.common.errors import ModelError
from mbs.model.body import Body
from mbs.model.carried_parts import SlidingPoint, Spin
from mbs.model.equation import Equation
from mbs.model.joint_ends import PointPair
from mbs.model.joint_rotation import RotationConditions
from mbs.model.records import Switch

FORCE_KINDS = ("point", "line", "distance", "drive", "driven_distance", "gear", "rack", "thread")
"""Kinds of equations whose multipliers are a force or a torque for sensors."""
SCALAR_FORCES = {
    "distance": "tension",
    "drop_link": "tension",
    "drive": "drive",
    "gear": "torque",
    "rack": "force",
    "screw": "force",
}
"""Component of the only force or torque of a type of joint."""


@dataclass(frozen=True)
class JointPlaces:
    """Position of a joint: its bodies and, on each in earth axes as drawn, its point and axis (if it has one)."""

    bodies: tuple[Body, Body]
    points: tuple[ArrayLike, ArrayLike]
    axes: tuple[ArrayLike, ArrayLike] | None = None


@dataclass(frozen=True)
class Drawing:
    """Conditions of a joint on a point and an axis of each of two rigid bodies, which compile may correct."""

    bodies: tuple[Body, Body]
    points: tuple[ArrayLike, ArrayLike]
    """Each of shape (dimension,): as drawn, earth axes, m."""
    axes: tuple[ArrayLike, ArrayLike] | None
    """As drawn, earth axes."""
    conditions: tuple[str, ...]
    """"point" (the points coincide), "axis" (the axes are parallel), "orientation" (no relative rotation), "line" (the
    first point is on the second axis), "angle" (of the axes is constant), "distance" (of the points is constant)."""
    remake: Callable[[tuple[ArrayLike, ArrayLike], tuple[ArrayLike, ArrayLike] | None, float], Joint] = field(
        repr=False
    )
    """``remake(points, axes, length)`` returns the joint with other ends."""
    length: float = 0.0
    """Length of a distance, m."""


@dataclass(frozen=True)
class AngleBodies:
    """Bodies and axis of a relative angle: of body 2 against body 1 (axis as drawn, earth axes; None in the plane)."""

    bodies: tuple[Body, Body]
    axis: ArrayLike | None
    coordinate: int


@dataclass(frozen=True)
class JointEnds:
    """Ends of a joint for the search of closed loops: its bodies (the ground, a body or a node), points and axis."""

    bodies: tuple[Body, Body]
    points: tuple[AffineVector, AffineVector]
    """Point of the joint on the first and on the second body."""
    axis: AffineVector | None = None
    """Axis about which the bodies turn, or line of the second body along which the point of the first slides."""
    slides: bool = False
    """Whether the bodies slide along the axis."""
    rod: bool = False
    """Whether a massless rod connects the points, which then do not coincide."""


@dataclass(frozen=True)
class RollingBody:
    """A body that rolls on a horizontal plane as a wheel: radius and height of the plane, m, drawn centre and axis."""

    radius: float
    level: float
    body: Body
    centre: Vector
    axis: Vector


@dataclass(frozen=True)
class RollingSpin:
    """A spin that rolls on a horizontal plane: radius and height of the plane, m."""

    radius: float
    level: float
    spin: Spin


class Joint:
    """A constraint of the model.

    Attributes
    ----------
    as_rows : bool
        Whether its force equations are rows and not eliminated, so that their multipliers (the joint force) exist; set
        by sensors of joint forces.
    switch : Switch or None
        Switches its rows on and off; None: they are always on.
    rows_weight : float
        Factor of the force on the first body along equation k, ``-rows_weight * lam_k``; 0 without such a force.
    force_unit : str
        Unit of the force that sensors read, "N" or "N m".
    normals : sequence of AffineVector
        Unit vectors of the second body along which ``-lam_k`` of the line equations act on the first.
    turning : RotationConditions or None
        Conditions on the relative rotation as products of vectors, made by `hold_turning`.
    places : JointPlaces or None
        Points and axes of joints of spanning trees: revolute, prismatic, spherical and weld.
    drawing : Drawing or None
        Conditions of a joint between two rigid bodies whose drawing can be corrected.
    turn : AngleBodies or None
        Bodies of a relative angle.
    ends : JointEnds or None
        Ends of a joint that can be part of a closed loop.
    rolls : RollingBody, RollingSpin or None
        The wheel of a rolling joint.
    couples : (int, int, float) or None
        Coordinates of the wheels of a gear, and turns of the first for one turn of the second.
    actuator : JointEnds or None
        Ends of a driven distance.
    slide : (int, SlidingPoint) or None
        Number of the end of a distance that a driving function slides, and the sliding point.
    """

    def __init__(
        self,
        name: str,
        type: str,
        equations: Sequence[Equation],
        rows_weight: float = 0.0,
        normals: Sequence[AffineVector] = (),
        places: JointPlaces | None = None,
        turning: Callable[[], RotationConditions] | None = None,
        turn: AngleBodies | None = None,
    ) -> None:
        self.name = name
        self.type = type
        self.equations = list(equations)
        self.rows_weight = rows_weight
        self.force_unit = "N"
        self.normals = tuple(normals)
        self.places = places
        self.turn = turn
        self.as_rows = False
        self.turning: RotationConditions | None = None
        self._make_turning = turning
        self.switch: Switch | None = None
        self.ends: JointEnds | None = None
        self.drawing: Drawing | None = None
        self.actuator: JointEnds | None = None
        self.slide: tuple[int, SlidingPoint] | None = None
        self.rolls: RollingBody | RollingSpin | None = None
        self.couples: tuple[int, int, float] | None = None

    @property
    def turns(self) -> bool:
        """Whether it transmits a moment."""
        return self._make_turning is not None

    def hold_turning(self) -> RotationConditions:
        """Keep the conditions on relative rotation as rows, whose multipliers are the moment of the joint.

        Products of perpendicular vectors replace equal vectors, which would repeat a condition of unit length.
        """
        if self._make_turning is None:
            raise ModelError(f"The joint '{self.name}' ({self.type}) transmits no moment.")
        if self.turning is None:
            self.turning = self._make_turning()
            self.equations += self.turning.equations(self.name)
        return self.turning

    @property
    def turning_equations(self) -> list[int]:
        """Numbers of the equations whose multipliers are its moment."""
        return [k for k, e in enumerate(self.equations) if e.kind == "turning"]

    @property
    def replaced_equations(self) -> list[int]:
        """Numbers of the equations that the turning equations replace."""
        return [] if self.turning is None else [k for k, e in enumerate(self.equations) if e.kind in ("axis", "axes")]

    def __repr__(self) -> str:
        return f"<Joint {self.name!r} ({self.type})>"

    @property
    def force_equations(self) -> list[int]:
        """Numbers of the equations whose multipliers are its force."""
        return [k for k, e in enumerate(self.equations) if e.kind in FORCE_KINDS]


def equal_vectors(name: str, kind: str, a: AffineVector, b: AffineVector) -> list[Equation]:
    """Equations ``a - b = 0``, one for each component."""
    return [Equation(name, kind, linear=x - y) for x, y in zip(a.components, b.components, strict=True)]


def point_pair(point: PointPair, dimension: int, subject: str, kind: str = "point") -> tuple[Vector, Vector]:
    """A point, or an axis, of each body of a joint.

    `point`: shape (dimension,), or a pair if the drawing does not close; `kind`: "point" or "axis".

    Returns
    -------
    pair of ndarray, shape (dimension,)
        Of the first and of the second body.
    """
    expected = f"{dimension} numbers, or a pair of {'points' if kind == 'point' else 'axes'}, one per body"
    name = f"the {kind} of {subject}"
    value: Any = point
    if isinstance(value, (tuple, list, np.ndarray)) and len(value) == 2 and not any(is_number(p) for p in value):
        return array(value[0], (dimension,), name, wanted=expected), array(
            value[1], (dimension,), name, wanted=expected
        )
    shared = array(value, (dimension,), name, wanted=expected)
    return shared, shared
