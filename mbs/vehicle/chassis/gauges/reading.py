"""Reading of a gauge: name, unit and row on the nodal displacements."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

STRESS = "stress"


@dataclass(frozen=True)
class Reading:
    """An output of the car that is linear in the displacements of the nodes of its frame."""

    quantity: str
    """First part of the output's name, as "stress"."""
    gauge: str
    """Second part."""
    unit: str
    description: str
    row: np.ndarray
    """Shape (n_dof,) or that and three a node: per nodal displacement, m and rad, and per acceleration (`recovery`)."""
    between: tuple[str, str] | None = None
    """Nodes between which the gauge sits; None: it has no one place."""
    along: float = 0.5
    """Place from the first of them to the second, from 0 to 1."""

    @property
    def name(self) -> str:
        """Name of the output."""
        return f"{self.quantity}.{self.gauge}"


def in_order(readings: Iterable[Reading]) -> tuple[Reading, ...]:
    """Forces and moments first, then stresses, each in the order of the file. `readings`: gauge by gauge."""
    return tuple(sorted(readings, key=lambda reading: reading.quantity == STRESS))
