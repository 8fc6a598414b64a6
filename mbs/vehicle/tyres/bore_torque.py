"""Bore torque of the tyres of a car file."""

from mbs.elements.tyre_bore import TyreBore
from mbs.vehicle.quantities import Length, YawDamping, YawStiffness
from mbs.vehicle.section import Section


class Bore(Section, of=TyreBore):
    """Torque of a patch that turns on the road, after G. Rill, Road Vehicle Dynamics, CRC Press, 2011, section 3.7.

    Friction acts at two thirds of the mean of half the length and half the width of the patch; the carcass twists
    before the patch slides. Without this table a standing wheel turns about the vertical as if its patch were a point.
    """

    width: Length
    stiffness: YawStiffness
    damping: YawDamping
