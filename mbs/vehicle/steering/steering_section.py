"""Base class of the sections of steerings in a car file."""

from abc import abstractmethod
from collections.abc import Iterator
from typing import ClassVar

from mbs.model.records import Guide
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import TieRodEnd
from mbs.vehicle.section import Section

COLUMN_STICK = 200.0, 5.0  # N m/rad, N m s/rad of a column that sticks: 1 N m of friction gives by 5 mrad


class SteeringSection(Section):
    """A steering, whose motion is one number: the travel of a rack or the angle of an arm."""

    motion: ClassVar[str] = "rack_travel"
    """Name of its motion, which is one of the quantities of kinematic curves."""
    without_travel: ClassVar[str] = ""
    """Why tables over the travel of a rack cannot be steered by it; empty where they can."""

    rack_port: ClassVar[str] = ""
    """Kind of the port by which another program may move its rack; empty where it has none."""

    def port_faults(self) -> Iterator[str]:
        """Why this one cannot have that port."""
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
        """Key that gives it and how far the ends of the tie rods go aside at full lock, m."""

    @abstractmethod
    def wheel_at(self, motion: float) -> tuple[float, float]:
        """Angle of the steering wheel, rad, and its change per motion.

        `motion`: in m or rad, positive where it steers to the left.
        """

    def signed(self, way: float) -> float:
        """Sign of its motion where it steers to the left.

        `way`: 1 where a rack that moves to the left steers to the left, else -1.
        """
        return way

    @abstractmethod
    def ends(self, b: CarBuilder, guide: Guide, way: float) -> TieRodEnd:
        """Owner of the inner ends of the tie rods, moved by a guide.

        `guide`: in m or rad; `way`: as of `signed`.
        """

    @property
    def on_flexible_chassis(self) -> bool:
        """Whether the chassis may bend or have ports."""
        return True

    @property
    def moving_mass(self) -> float:
        """Mass of what is a body of its own, kg."""
        return 0.0
