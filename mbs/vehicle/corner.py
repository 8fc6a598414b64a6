"""Interface of a suspension at each wheel for other parts of the car."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from mbs.model.body import Body
from mbs.model.joint_ends import End
from mbs.vehicle.side import Point, Side

TieRodEnd: TypeAlias = Callable[[Side, Point], End]
"""From a side and the inner end of its tie rod as drawn to what it hangs on."""


@dataclass(frozen=True)
class Corner:
    """The side of a suspension at one wheel."""

    side: Side
    """Axle, and left or right."""
    carrier: Body
    """Carries the wheel."""
    parts: Mapping[str, Body]
    """Bodies by their names in the file, for anti-roll bars."""
