"""Reading of a gauge: name, unit and row on the nodal displacements."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

STRESS = "stress"


@dataclass(frozen=True)
class Reading:
    """An output of the car that is linear in the displacements of the nodes of its frame."""

    quantity: str
    """First part of the name of the output, such as "stress"."""
    gauge: str
    """Name of the gauge, the second part."""
    unit: str
    description: str
    row: np.ndarray
    """Factors of nodal displacements, m and rad, shape (n_dof,), or also of nodal accelerations (`recovery`)."""
    between: tuple[str, str] | None = None
    """Nodes between which the gauge lies; None: it has no single position."""
    along: float = 0.5
    """Relative position from the first of them to the second, 0 to 1."""

    @property
    def name(self) -> str:
        """Name of the output."""
        return f"{self.quantity}.{self.gauge}"


def drawn_gauges(readings: Iterable[Reading]) -> list[dict[str, Any]]:
    """Entries of `gauges` of a scene, with names of nodes, of the stresses whose gauges have a position."""
    return [
        {"name": r.gauge, "value": r.name, "unit": r.unit, "nodes": r.between, "along": r.along}
        for r in readings
        if r.quantity == STRESS and r.between is not None
    ]


def sort_readings(readings: Iterable[Reading]) -> tuple[Reading, ...]:
    """Sort readings: forces and moments, then stresses, each in the order of the file."""
    return tuple(sorted(readings, key=lambda reading: reading.quantity == STRESS))
