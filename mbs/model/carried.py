"""What bodies carry: point masses, wheels reduced to a spin, points that slide."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate


@dataclass(frozen=True)
class Payload:
    """A point mass that sits on a body; made by `Model.payload`.

    Parameters
    ----------
    body : Body
        What it sits on.
    position : ndarray, shape (dimension,)
        In earth axes in the reference configuration, m.
    point : AffineVector
        The point of the body as expressions of coordinates, m.
    mass : float
        kg.
    shared : bool
        Whether several points carry it.
    """

    name: str
    body: Body
    position: Vector
    point: AffineVector
    mass: float
    shared: bool = False


INERTIA_REALS = ("mass", "com_x", "com_y", "com_z", "xx", "yy", "zz", "xy", "xz", "yz")
"""As in the System: kg, m in the drawing, and entries of the inertia tensor about the centre of mass, kg m2."""


@dataclass(frozen=True)
class WrittenInertia:
    """Mass that a body has as drawn, and what carries its change; made by `Model.written_inertia`.

    Attributes
    ----------
    vectors : tuple of AffineVector
        The centre of mass as drawn, and the axes x, y and z, as expressions of coordinates.
    reals : tuple of float
        In the order of `INERTIA_REALS`.
    """

    name: str
    vectors: tuple[AffineVector, AffineVector, AffineVector, AffineVector]
    reals: tuple[float, ...]


@dataclass(frozen=True)
class Spin(Coordinate):
    """A wheel on its carrier.

    The coordinate is a quasi coordinate: its rate is the absolute angular velocity of the wheel along `axis`; its
    value has no meaning. Mass and diametral inertia are lumped on the carrier, with zero axial inertia.

    Attributes
    ----------
    centre, axis, f, g : AffineVector
        Wheel centre and unit vectors of the carrier with axis = f x g.
    rolling_radius : float
        Radius, m, that gives the spin of a pose with a speed (positive speed along +x); 0: none.
    """

    carrier: Body
    centre: AffineVector
    axis: AffineVector
    f: AffineVector
    g: AffineVector
    spin_inertia: float
    rolling_radius: float
    axis_reference: tuple[float, ...]

    @property
    def coordinate(self) -> Affine:
        """The spin coordinate; its rate is the absolute axial angular velocity, rad/s."""
        return self.affine


@dataclass(frozen=True)
class SlidingPoint:
    """``p(s) = start + s * direction`` with the guide s in m; an end of `Model.distance`.

    Attributes
    ----------
    start, direction : AffineVector
        Point and unit vector of the body.
    """

    name: str
    body: Body
    start: AffineVector
    direction: AffineVector
    guide: int
