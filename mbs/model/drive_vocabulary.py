"""Shafts, travels, and rotors that turn with a coordinate."""

from mbs.common.checks import not_negative, number, one_of, positive, shown
from mbs.model.bodies import BodyVocabulary
from mbs.model.coordinate import Coordinate
from mbs.model.records import Armature


class DriveVocabulary(BodyVocabulary):
    """Shafts, travels and armatures of a model."""

    def shaft(self, name: str, *, inertia: float = 0.0) -> Coordinate:
        """A shaft that turns in another part, as one coordinate: its angle, from 0 as drawn.

        Its carrier takes no reaction of its inertia and does not turn it: the angle and the inertia are small, or the
        carrier turns slowly.

        Parameters
        ----------
        inertia : float
            kg m2; without one something must hold or weigh it, such as a rack or a drive.
        """
        value = not_negative(inertia, f"The inertia of shaft {shown(name)}")
        index = self.new_coordinate(self.unique("shaft", name), "angle", 0.0)
        self.inertias[index] = value
        return Coordinate(name, index, "rad")

    def travel(self, name: str, *, unit: str = "m", rate: float = 0.0) -> Coordinate:
        """A coordinate as a variable of tables, 0 as drawn.

        Its inertia is the inertia of the parts that it moves; there must be one, or a drive must hold it.

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

    def armature(self, name: str, coordinate: Coordinate, *, inertia: float, ratio: float = 1.0) -> Armature:
        """Inertia that turns with a relative angle, such as the rotor of a motor behind a gear.

        Its moment on its carrier is neglected: the rotor is small, or the carrier turns slowly.

        Parameters
        ----------
        coordinate : Coordinate
            A relative angle or a spin of this model.
        inertia : float
            About its own axis, kg m2; `inertia` times ``ratio**2`` is added to the inertia of the coordinate.
        ratio : float
            Its turns for one of the coordinate. A fixed parameter may write it.
        """
        self.owned_coordinate(coordinate, f"The armature '{name}'")
        own_inertia = not_negative(inertia, f"The inertia of armature '{name}'")
        turns = positive(ratio, f"The ratio of armature '{name}'")
        new = self.enter("armature", self.armatures, Armature(name, coordinate.affine, own_inertia, turns))
        self.inertias[coordinate.index] = self.inertias.get(coordinate.index, 0.0) + own_inertia * turns * turns
        return new
