"""Parts carried by bodies: point masses, wheels reduced to a spin, sliding points."""

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate


@dataclass(frozen=True)
class Payload:
    """A point mass that sits on a body; made by `Model.payload`."""

    name: str
    body: Body
    """Body that carries it."""
    position: Vector
    """Shape (dimension,): in earth axes in the reference configuration, m."""
    point: AffineVector
    """The point of the body as expressions of coordinates, m."""
    mass: float
    """kg."""
    shared: bool = False
    """Whether several points carry it."""


INERTIA_REALS = ("mass", "com_x", "com_y", "com_z", "xx", "yy", "zz", "xy", "xz", "yz")
"""As in the System: kg, m in the drawing, and entries of the inertia tensor about the centre of mass, kg m2."""


@dataclass(frozen=True)
class WrittenInertia:
    """Drawn mass properties of a body, and vectors at which changes of them act; made by `Model.written_inertia`."""

    name: str
    vectors: tuple[AffineVector, AffineVector, AffineVector, AffineVector]
    """The centre of mass as drawn, and the axes x, y and z, as expressions of coordinates."""
    reals: tuple[float, ...]
    """In the order of `INERTIA_REALS`."""


@dataclass(frozen=True)
class Spin(Coordinate):
    """A wheel on its carrier.

    The coordinate is a quasi coordinate: its rate is the absolute angular velocity of the wheel along `axis`; its
    value has no meaning. Mass and diametral inertia are lumped on the carrier, with zero axial inertia.
    """

    carrier: Body
    centre: AffineVector
    """Wheel centre, m."""
    axis: AffineVector
    """Axis f x g, a unit vector of the carrier. Nothing else has the same three objects of axis, f and g."""
    f: AffineVector
    """Unit vector of the carrier, perpendicular to the axis."""
    g: AffineVector
    """Unit vector of the carrier, perpendicular to the axis and f."""
    spin_inertia: float
    """Moment of inertia about the axis, kg m2."""
    diametral_inertia: float
    """Moment of inertia about diameters, kg m2."""
    rolling_radius: float
    """Radius, m, that gives the spin of a pose with a speed (positive speed along +x); 0: none."""
    drawn: tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]
    """f, g and axis in the drawing."""

    @property
    def axis_reference(self) -> tuple[float, ...]:
        """The axis in the drawing."""
        return self.drawn[2]

    @property
    def coordinate(self) -> Affine:
        """The spin coordinate; its rate is the absolute axial angular velocity, rad/s."""
        return self.affine


AXIS_REALS = ("azimuth", "elevation")
"""As in the System, rad: angle of the drawn axis about the vertical from y, and its angle above the horizontal."""


@dataclass(frozen=True)
class WrittenAxis:
    """Drawn direction of the axis of a wheel, which parameters change; made by `Model.written_axis`."""

    name: str
    spin: Spin
    frame: tuple[AffineVector, AffineVector, AffineVector]
    """Earth axes of the drawing as vectors of the carrier."""
    reals: tuple[float, float]
    """In the order of `AXIS_REALS`."""
    leaning: float
    """Increase of the rolling radius per unit of 1/cos(elevation), m."""

    @property
    def vectors(self) -> tuple[AffineVector, AffineVector, AffineVector]:
        """f, g and the axis of the wheel."""
        return self.spin.f, self.spin.g, self.spin.axis


@dataclass(frozen=True)
class SlidingPoint:
    """``p = start + sum of s_k * direction_k`` with the driving functions s in m; an end of `Model.distance`."""

    name: str
    body: Body
    start: AffineVector
    """Point of the body."""
    ways: tuple[tuple[AffineVector, int], ...]
    """Perpendicular unit vectors of the body, each with the number of its driving function."""
