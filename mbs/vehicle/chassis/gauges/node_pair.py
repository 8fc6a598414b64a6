"""Strain gauge between two nodes."""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import numpy as np

from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel
from mbs.vehicle.chassis.gauges.reading import STRESS, Reading
from mbs.vehicle.quantities import YoungsModulus
from mbs.vehicle.section import Section


class NodePair(Section):
    """Gauge that measures the strain between two nodes on a surface, such as neighbours of a mesh of solid elements."""

    kind: Literal["node_pair"]
    """Names this kind of gauge."""
    nodes: tuple[str, str]
    """Its ends; they should be so near that the stress hardly changes between them."""
    opposite: tuple[str, str] | None = None
    """Ends of a second gauge that is subtracted (half-bridge)."""
    E: YoungsModulus
    """Young's modulus: the stress is it times the strain."""

    def readings(self, name: str, model: FiniteElementModel, folder: Path) -> Iterator[Reading]:
        """Stress that the gauge reports.

        Raises `ModelError` if there is no such node, or both ends are at one place.
        """
        a, b = self.nodes
        row, text = self._strain(model, "nodes"), f"E times the strain from node {a} to node {b} at gauge {name}"
        if self.opposite is not None:
            row = row - self._strain(model, "opposite")
            text = f"half-bridge {name}, nodes {a} and {b} minus nodes {self.opposite[0]} and {self.opposite[1]}"
        yield Reading(STRESS, name, "Pa", text, self.E * row, self.nodes)

    def _strain(self, model: FiniteElementModel, field: str) -> np.ndarray:
        """Row of the strain between the nodes of a field by nodal displacements, shape (n_dof,)."""
        ends = getattr(self, field)
        for node in ends:
            if node not in model.names:
                raise ModelError(f"{self.key(field)} names node {node!r}; the frame has no such node.")
        a, b = (model.node(node) for node in ends)
        vector = model.positions[b] - model.positions[a]
        length = float(np.linalg.norm(vector))
        if length == 0.0:
            raise ModelError(f"{self.key(field)} is {list(ends)}; the two nodes are at one place.")
        row = np.zeros(model.n_dof)
        row[model.freedoms(b)] = vector / length**2
        row[model.freedoms(a)] = -vector / length**2
        return row
