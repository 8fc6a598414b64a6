"""Sections that tyres of every formula have in a car file."""

from pathlib import Path

from mbs.elements.tyre_bore import TyreBore
from mbs.vehicle.quantities import Length, YawDamping, YawStiffness
from mbs.vehicle.section import Section


class TyreSection(Section):
    """Tyres of an axle."""

    def open(self, folder: Path) -> None:
        """Read the tyre property file, if the formula has one; called once by the reader of the car.

        Raises `CarFileError` if the file is missing or not valid.
        """


class Bore(Section, of=TyreBore):
    """Torque of a patch that turns on the road, after G. Rill, Road Vehicle Dynamics, CRC Press, 2011, section 3.7.

    Friction acts at two thirds of the mean of half the length and half the width of the patch; the carcass twists
    before the patch slides. Without this table a standing wheel turns about the vertical as if its patch were a point.
    """

    width: Length
    stiffness: YawStiffness
    damping: YawDamping
