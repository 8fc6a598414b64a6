"""Strain gauges of a frame that comes as matrices: between two nodes, or by rows of recovery of another program."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel
from mbs.vehicle.chassis.gauges.reading import STRESS, Reading
from mbs.vehicle.quantities import YoungsModulus
from mbs.vehicle.section import Section
from mbs.vehicle.table import Row, read_table

AXES = ("x", "y", "z", "rx", "ry", "rz")
QUANTITIES = {
    "bending_moment": ("N.m", "bending moment at gauge {}"),
    "axial_force": ("N", "axial force at gauge {}, positive: pulled"),
    "torsional_moment": ("N.m", "torsional moment at gauge {}"),
    STRESS: ("Pa", "stress at gauge {}"),
}
MAX_FACTOR = 1e18  # N, N m or Pa per m or rad
RIGID = 1e-4  # of what a rigid motion would give if all factors had one sign: printed factors pass


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


class RecoveryRows(Section):
    """Gauge that is a sum of nodal displacements and rotations, each times a factor."""

    kind: Literal["recovery"]
    """Names this kind of gauge."""
    table: str
    """Table of the factors of this gauge, and perhaps of others: gauge, quantity (bending_moment, axial_force,
    torsional_moment or stress), node, axis (x, y, z, rx, ry, rz), factor (N, N m or Pa per m or rad)."""

    def readings(self, name: str, model: FiniteElementModel, folder: Path) -> Iterator[Reading]:
        """Readings of the gauge.

        Raises `ModelError` if the table is missing or does not fit the nodes, or a rigid motion would be read as a
        stress.
        """
        columns = ("gauge", "quantity", "node", "axis", "factor")
        rows: dict[str, np.ndarray] = {}
        for line in read_table(folder, self.table, self.key("table"), columns):
            if line["gauge"] != name:
                continue
            if line["quantity"] not in QUANTITIES:
                available = ", ".join(QUANTITIES)
                raise ModelError(f"{line.where}: quantity is {line['quantity']!r}; it must be one of {available}.")
            row = rows.setdefault(line["quantity"], np.zeros(model.n_dof))
            row[_freedom(line, model)] += line.number("factor", -MAX_FACTOR, MAX_FACTOR, "per m or rad")
        if not rows:
            raise ModelError(f"{self.key('table')} ({self.table}) has no line of gauge {name}.")
        rigid = model.rigid_motions(model.positions.mean(axis=0))
        for quantity, (unit, text) in QUANTITIES.items():
            if quantity in rows:
                row = rows[quantity]
                if np.abs(row @ rigid).max() > RIGID * (np.abs(row) @ np.abs(rigid)).max():
                    raise ModelError(
                        f"{self.key('table')} ({self.table}): the factors of {quantity} of gauge {name} read a rigid "
                        "motion of the frame; a strain does not."
                    )
                yield Reading(quantity, name, unit, text.format(name), row)


def _freedom(line: Row, model: FiniteElementModel) -> int:
    """Number of the freedom of a line. Raises `ModelError` if the node or the freedom does not exist."""
    node, axis = line["node"], line["axis"]
    if node not in model.names:
        raise ModelError(f"{line.where}: the frame has no node {node!r}.")
    if axis not in AXES:
        raise ModelError(f"{line.where}: axis is {axis!r}; it must be one of {', '.join(AXES)}.")
    number = int(model.dof[model.node(node), AXES.index(axis)])
    if number < 0:
        raise ModelError(f"{line.where}: node {node} has no freedom {axis}.")
    return number


MatrixGauge = Annotated[NodePair | RecoveryRows, Field(discriminator="kind")]
"""A gauge of a frame that comes as matrices."""
