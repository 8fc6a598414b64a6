"""Coordinates that only drives, racks or tables move."""

from __future__ import annotations

from mbs.common.checks import not_negative, number, one_of, shown
from mbs.model.coordinate import Coordinate
from mbs.model.mechanism import Mechanism


class DriveVocabulary(Mechanism):
    """Shafts and travels of a model."""

    def shaft(self: Mechanism, name: str, *, inertia: float = 0.0) -> Coordinate:
        """A shaft that turns in something else, as one coordinate: its angle, from 0 as drawn.

        What carries it takes no reaction of its inertia and does not turn it: the angle and the inertia are small, or
        the carrier turns slowly.

        Parameters
        ----------
        inertia : float
            kg m2; without one something must hold or weigh it, such as a rack or a drive.
        """
        value = not_negative(inertia, f"The inertia of shaft {shown(name)}")
        index = self.new_coordinate(self.unique("shaft", name), "angle", 0.0)
        self.inertias[index] = value
        return Coordinate(name, index, "rad")

    def travel(self: Mechanism, name: str, *, unit: str = "m", rate: float = 0.0) -> Coordinate:
        """A coordinate that tables are functions of, 0 as drawn.

        What it moves gives it its inertia; something must move with it, or a drive must hold it.

        Parameters
        ----------
        unit : {"m", "rad"}
            A length or an angle.
        rate : float
            At the start, m/s or rad/s.
        """
        one_of(unit, ("m", "rad"), f"The unit of travel {shown(name)}")
        start = number(rate, f"The rate of travel {shown(name)}")
        index = self.new_coordinate(self.unique("travel", name), "angle", 0.0)
        self.inertias[index] = 0.0
        if start:
            self.coordinate_rates[index] = start
        return Coordinate(name, index, unit)
