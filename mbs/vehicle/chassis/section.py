"""Tables of the chassis."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from mbs.elements.contact_points import ContactPoints
from mbs.vehicle.chassis.frames import Frame
from mbs.vehicle.names import Name
from mbs.vehicle.quantities import (
    ChassisMass,
    Coefficient,
    HysteresisLoss,
    Inertia,
    MassCentre,
    Point,
    ProductOfInertia,
    SmallLength,
    Thickness,
)
from mbs.vehicle.section import Section

ContactPoint = Annotated[
    Annotated[str, Tag("joint")] | Annotated[Point, Tag("point")],
    Discriminator(lambda value: "joint" if isinstance(value, str) else "point"),
]


class GroundContact(Section, of=ContactPoints):
    """Points of the chassis that may touch the ground; without this table it passes through. chi of their loss is as of
    the stops of the springs.
    """

    points: Annotated[tuple[ContactPoint, ...], Field(min_length=1)]
    """Points of the left half, each with its image on the right: coordinates, or the name of a joint of the frame."""
    radius: Thickness
    depth: SmallLength
    """By how much a point gives under a quarter of the car."""
    loss: HysteresisLoss
    friction_factor: Coefficient


class Chassis(Section):
    """Chassis with all that is fixed to it."""

    mass: ChassisMass
    """Mass without payloads."""
    com: tuple[MassCentre, MassCentre, MassCentre]
    """Centre of mass as drawn."""
    inertia: tuple[Inertia, Inertia, Inertia]
    """Moments of inertia about the axes x, y and z through the centre of mass."""
    products: tuple[ProductOfInertia, ProductOfInertia, ProductOfInertia] = (0.0, 0.0, 0.0)
    """Entries xy, xz and yz of the inertia tensor, which are minus the integrals of x y, x z and y z over the mass."""
    reference: Point
    """Point that carries a floating frame."""
    accelerometers: dict[Name, Point] = Field(default_factory=dict)
    """Accelerometers by name."""
    body: Literal["auto", "open", "clear", "closed"] = "auto"
    """How the body is drawn: open (none), clear (the key x of pages makes it see-through), closed; auto: open with a
    frame of tubes."""
    frame: Frame | None = None
    """Flexible frame; without it the chassis is rigid and has no stresses."""
    ground_contact: GroundContact | None = None
    """Where the chassis may touch the ground."""

    @property
    def tensor(self) -> tuple[tuple[float, float, float], ...]:
        """Inertia tensor about the centre of mass, kg m2."""
        (x, y, z), (xy, xz, yz) = self.inertia, self.products
        return (x, xy, xz), (xy, y, yz), (xz, yz, z)
