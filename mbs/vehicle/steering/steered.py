"""What a steering gives the rest of the car."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from mbs.vehicle.corner import TieRodEnd


@dataclass(frozen=True)
class Steered:
    """A steering in a model.

    Attributes
    ----------
    tie_rod : TieRodEnd
        Gives the ends of the rack.
    outputs : callable
        Adds the outputs of the steering.
    """

    tie_rod: TieRodEnd
    outputs: Callable[[], None]
