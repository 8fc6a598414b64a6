"""A rigid part of a suspension."""

from mbs.vehicle.quantities import PartInertia, PartMass, Point
from mbs.vehicle.section import Section


class Part(Section):
    """A rigid part of the left side; its principal axes are parallel to the axes of the drawing."""

    mass: PartMass
    """Mass."""
    com: Point
    """Centre of mass as drawn."""
    inertia: tuple[PartInertia, PartInertia, PartInertia]
    """Moments of inertia about the axes x, y and z through the centre of mass."""
