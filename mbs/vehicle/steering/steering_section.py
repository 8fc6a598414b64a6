"""Base class of the sections of steerings in a car file, and what a steering gives to other parts of the car."""

from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from mbs.elements.coordinate_friction import CoordinateFriction
from mbs.model.coordinate import Coordinate
from mbs.model.model import Model
from mbs.model.records import DrivingFunction, Input
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.section import Section
from mbs.vehicle.side import TieRodEnd

COLUMN_STICK = 200.0, 5.0  # N m/rad, N m s/rad of a sticking column: 1 N m turns it by 5 mrad


@dataclass(frozen=True)
class Steered:
    """A steering in a model."""

    tie_rod: TieRodEnd
    """Returns the owner of the inner end of a tie rod."""
    outputs: Callable[[], None]
    """Adds the outputs of travel and angle."""
    torque_outputs: Callable[[], None]
    """Adds the outputs of speed, force and torque, after all other outputs."""
    travel: Callable[[], Coordinate] | None = None
    """Adds the travel of the rack, m, as a coordinate instead of its ends; None: there is none."""


class SteeringSection(Section):
    """A steering, whose motion is one number: the travel of a rack or the angle of an arm."""

    motion: ClassVar[str] = "rack_travel"
    """Name of the motion among the quantities of kinematic curves."""
    without_travel: ClassVar[str] = ""
    """Why tables against the travel of a rack are impossible; empty if they are possible."""

    rack_port: ClassVar[str] = ""
    """Kind of the port by which another program can move the rack; empty if there is none."""

    def port_faults(self) -> Iterator[str]:
        """Yield a sentence if the steering cannot have the port."""
        yield from ()

    @property
    @abstractmethod
    def wheel_angle_max(self) -> float:
        """Angle of the steering wheel at full lock, rad."""

    @property
    @abstractmethod
    def full(self) -> float:
        """Motion at full lock, m or rad."""

    @property
    @abstractmethod
    def lateral_travel(self) -> tuple[str, float]:
        """Key path and lateral travel of the ends of the tie rods at full lock, m."""

    @abstractmethod
    def wheel_at(self, motion: float) -> tuple[float, float]:
        """Angle of the steering wheel, rad, and its derivative by the motion.

        `motion`: m or rad, positive if it steers to the left.
        """

    def signed(self, way: float) -> float:
        """Sign of the motion that steers to the left.

        `way`: 1 if a rack that moves to the left steers to the left, otherwise -1.
        """
        return way

    @abstractmethod
    def ends(self, b: CarBuilder, guide: DrivingFunction, way: float) -> TieRodEnd:
        """Owner of the inner ends of the tie rods, moved by a driving function.

        `guide`: driving function, m or rad; `way`: as in `signed`.
        """

    @property
    def on_flexible_chassis(self) -> bool:
        """Whether the chassis can be flexible or quasi-static."""
        return True

    @property
    def moving_mass(self) -> float:
        """Mass of the parts that are bodies, kg."""
        return 0.0

    def angle_demand(self, m: Model) -> Input:
        """Add the input of the demanded angle of the steering wheel, rad."""
        return m.input(
            "steering_wheel_angle_demand",
            min=-self.wheel_angle_max,
            max=self.wheel_angle_max,
            unit="rad",
            description="angle of the steering wheel, positive to the left; it is added to what steering asks for",
        )


def column_friction(m: Model, guide: DrivingFunction, per_radian: float, torque: float) -> None:
    """Add friction of `torque`, N m, to a steering wheel. `guide`: `per_radian` times the angle of the wheel, rad."""
    wheel = m.shaft("steering wheel")
    m.drive("steering column", wheel.affine * per_radian, guide)
    m.add(CoordinateFriction(torque, *COLUMN_STICK).record("steering friction", wheel.affine))
