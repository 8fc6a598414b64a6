"""Base class of the sections of steerings in a car file."""

from abc import abstractmethod
from collections.abc import Iterator
from typing import ClassVar

from mbs.model.records import Guide
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.section import Section
from mbs.vehicle.side import TieRodEnd

COLUMN_STICK = 200.0, 5.0  # N m/rad, N m s/rad of a sticking column: 1 N m turns it by 5 mrad


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
    def ends(self, b: CarBuilder, guide: Guide, way: float) -> TieRodEnd:
        """Owner of the inner ends of the tie rods, moved by a guide.

        `guide`: guide, m or rad; `way`: as in `signed`.
        """

    @property
    def on_flexible_chassis(self) -> bool:
        """Whether the chassis can be flexible or quasi-static."""
        return True

    @property
    def moving_mass(self) -> float:
        """Mass of the parts that are bodies, kg."""
        return 0.0
