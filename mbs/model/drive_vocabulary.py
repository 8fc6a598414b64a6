"""Drives, and the coordinates that only drives, racks or tables move."""

from __future__ import annotations

from mbs.common.affine import Affine
from mbs.common.checks import not_negative, number, one_of, shown
from mbs.model.coordinate import Coordinate
from mbs.model.ends import End
from mbs.model.joints.drive import drive
from mbs.model.joints.joint import Joint
from mbs.model.mechanism import Mechanism
from mbs.model.records import Guide


class DriveVocabulary(Mechanism):
    """The drives of a model."""

    def drive(
        self: Mechanism,
        name: str,
        driven: Coordinate | Affine | tuple[End, End],
        guide: Guide,
        *,
        switch: bool | None = None,
    ) -> Joint:
        """Prescribed motion: a coordinate, a component of a point, or the distance of two points follows a guide.

        Parameters
        ----------
        driven : Coordinate, Affine or (end, end)
            A relative angle; an expression such as ``body.point(p)[0]``; or two ends as of `distance`.
        guide : Guide
            Of this model, rad or m.
        switch : bool, optional
            With a switch of the same name, on or off at the start: the drive can let go. One that is turned on later
            keeps the distance to its guide that there is then.

        Returns
        -------
        Joint
            For sensors: its force is that of the drive, zero while it is off.

        Raises
        ------
        ModelError
            What is driven cannot move, an end slides, or a driven distance starts at zero.
        """
        return self._join(drive(self, name, driven, guide, switch))

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
