"""Interface of a steering for other parts of the car."""

from collections.abc import Callable
from dataclasses import dataclass

from mbs.model.coordinate import Coordinate
from mbs.vehicle.side import TieRodEnd

RACK = "rack travel"
"""Name of the coordinate of the rack, and of its drive."""


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
