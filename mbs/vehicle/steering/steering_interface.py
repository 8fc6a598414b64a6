"""Interface of a steering for other parts of the car."""

from collections.abc import Callable
from dataclasses import dataclass

from mbs.model.coordinate import Coordinate
from mbs.vehicle.corner import TieRodEnd

RACK = "rack travel"
"""Name of the coordinate of the rack, and of its drive."""


@dataclass(frozen=True)
class Steered:
    """A steering in a model."""

    tie_rod: TieRodEnd
    """Gives the ends of the rack."""
    outputs: Callable[[], None]
    """Adds the outputs that every steering has had from the first."""
    torque_outputs: Callable[[], None]
    """Adds those of speed, force and torque, after all others."""
    travel: Callable[[], Coordinate] | None = None
    """Adds the travel of the rack, m, as a coordinate in the place of its ends; None: the steering has none."""
