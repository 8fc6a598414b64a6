"""Interface of a suspension at each wheel for other parts of the car."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from mbs.model.body import Body
from mbs.model.joint_ends import End
from mbs.vehicle.side import Point, Side

TieRodEnd: TypeAlias = Callable[[Side, Point], End]
"""Returns the owner of the inner end of a tie rod from its side and the end as drawn, m."""


@dataclass(frozen=True)
class Corner:
    """The side of a suspension at one wheel."""

    side: Side
    """Axle, and left or right."""
    carrier: Body
    """Body that carries the wheel."""
    parts: Mapping[str, Body]
    """Bodies by their names in the file, to which anti-roll bars can be joined."""
