"""Strain gauge by rows of recovery that another program has written."""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import numpy as np

from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel
from mbs.vehicle.chassis.gauges.reading import STRESS, Reading
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
