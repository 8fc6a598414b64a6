"""What every model has: the words that cars are written in, without those that few models need."""

from __future__ import annotations

import math

from numpy.typing import ArrayLike

from mbs.common.checks import not_negative, positive
from mbs.model.air import AirVocabulary
from mbs.model.angle import relative_angle
from mbs.model.anti_roll_bar import anti_roll_bar
from mbs.model.coordinate import Coordinate
from mbs.model.guides import GuideVocabulary
from mbs.model.inputs import new_input
from mbs.model.joint_vocabulary import JointVocabulary
from mbs.model.parameters import ParameterVocabulary
from mbs.model.records import Armature, Input
from mbs.model.road_vocabulary import RoadVocabulary
from mbs.model.sensors import SensorVocabulary
from mbs.model.spin import SpinVocabulary
from mbs.model.springs import SpringVocabulary


class Mechanism(
    JointVocabulary,
    SpringVocabulary,
    AirVocabulary,
    RoadVocabulary,
    SensorVocabulary,
    SpinVocabulary,
    GuideVocabulary,
    ParameterVocabulary,
):
    """A `Model`, which describes the arguments, with the words that all cars need; `compile` takes it.

    A part of a car that needs one more word calls it by its vocabulary, as ``ForceVocabulary.torque_on(m, ...)``.
    """

    def __init__(
        self, name: str, dimension: int = 3, gravity: ArrayLike | None = None, *, length: float | None = None
    ) -> None:
        super().__init__(name, dimension, gravity, length)
        self.coordinate_rates: dict[int, float] = {}

    # --- coordinates ---
    relative_angle = relative_angle
    anti_roll_bar = anti_roll_bar

    def armature(self, name: str, coordinate: Coordinate, *, inertia: float, ratio: float = 1.0) -> Armature:
        """Inertia that turns with a relative angle, such as the rotor of a motor behind a gear.

        Its moment on what carries it is left out: the rotor is small, or the carrier turns slowly.

        Parameters
        ----------
        coordinate : Coordinate
            A relative angle or a spin of this model.
        inertia : float
            About its own axis, kg m2; `inertia` times ``ratio**2`` is added to what the coordinate has already.
        ratio : float
            Its turns for one of the coordinate. A fixed parameter may write it.
        """
        self.owned_coordinate(coordinate, f"The armature '{name}'")
        own = not_negative(inertia, f"The inertia of armature '{name}'")
        turns = positive(ratio, f"The ratio of armature '{name}'")
        new = self.enter("armature", self.armatures, Armature(name, coordinate.affine, own, turns))
        self.inertias[coordinate.index] = self.inertias.get(coordinate.index, 0.0) + own * turns * turns
        return new

    # --- inputs, guides, parameters ---
    def input(
        self,
        name: str,
        *,
        start: float = 0.0,
        min: float = -math.inf,
        max: float = math.inf,
        unit: str = "1",
        description: str = "",
        whole: bool = False,
        port: bool = False,
    ) -> Input:
        """A number that a host sets.

        Parameters
        ----------
        start : float
            Value at the start, in `unit`.
        min, max : float
            Limits, in `unit`; values beyond them are refused. They may be infinite.
        unit : str
            "1" for a pure number.
        whole : bool
            Whether it takes whole numbers only, such as the position of a lever: an integer of an FMU. Over time it
            keeps a value until the next one.
        port : bool
            Whether another program sets it at every step: an FMU then holds its last value, with one warning, where a
            value is not finite, and warns before the first step if it was not set.
        """
        return new_input(self, name, start, min, max, unit, description, whole, port)
