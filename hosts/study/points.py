"""The points of a study, in blocks: values of its parameters on a grid, at random or from a table."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import brief
from ali3.tables import TextTable, number_of
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.variables import Variable
from hosts.study.parameters import Parameter, in_fmu_unit
from hosts.study.study_file import ParameterEntry, SamplingEntry

if TYPE_CHECKING:
    from hosts.study.random_points import UnitPoints

_MAX_POINTS = 10**9
_MAX_DIGESTED_POINTS = 256  # first and last points in the hash of drawn points


@dataclass(frozen=True)
class Points:
    """A source of points."""

    count: int
    block: Callable[[int, int], Mapping[str, list[Value]]]
    """Function of the number of the first point and a count; returns values by the name of the parameter."""
    parameters: tuple[Parameter, ...] = ()
    """Parameters of a grid or of random points; empty for a table."""


def grid_points(lengths: Sequence[int]) -> UnitPoints:
    """All combinations, the last dimension fastest; each value is the middle of an equal part of [0, 1)."""

    def block(first: int, count: int) -> NDArray[np.float64]:
        indices = np.unravel_index(np.arange(first, first + count), lengths)
        return (np.stack(indices, axis=1) + 0.5) / np.array(lengths, dtype=np.float64)

    return block


def sampled_points(parameters: tuple[Parameter, ...], sampling: SamplingEntry, file: str) -> Points:
    """Points of a grid, or random ones. `file`: name of the study file in messages.

    Raises `HostError` if there are too many points.
    """
    if sampling.method == "grid":
        parameters = tuple(p.with_grid_values() for p in parameters)
        lengths = tuple(p.length for p in parameters)
        count, unit_points = math.prod(lengths), grid_points(lengths)
        if count > _MAX_POINTS:
            product = " x ".join(map(str, lengths))
            raise HostError(f"{file}: the grid has {product} = {count:.3g} points; at most {_MAX_POINTS:.0e} can be.")
    else:
        count, unit_points = _random_points(len(parameters), sampling, file)

    def block(first: int, size: int) -> Mapping[str, list[Value]]:
        positions = unit_points(first, size)
        return {p.name: p.at(positions[:, k]) for k, p in enumerate(parameters)}

    return Points(count, block, parameters)


def _random_points(d: int, sampling: SamplingEntry, file: str) -> tuple[int, UnitPoints]:
    """Number of random points of d dimensions, and the points."""
    from hosts.study.random_points import latin_hypercube, saltelli, sobol_sequence

    n, seed = sampling.runs or 0, sampling.seed
    if sampling.method == "sobol":
        return n, sobol_sequence(d, seed)
    if sampling.method == "saltelli":
        return n * (d + 2), saltelli(d, seed)
    if n * d > _MAX_POINTS:
        raise HostError(
            f"{file}: a Latin hypercube of {n} points of {d} parameters needs {8e-9 * n * d:.3g} GB of memory; "
            "take the method sobol."
        )
    return n, latin_hypercube(d, n, seed)


def digest(points: Points) -> str:
    """A hash of all points of a table, or of the first and last ones of a grid or of random points."""
    limit = _MAX_DIGESTED_POINTS if points.parameters else points.count
    ends = [points.block(0, min(points.count, limit))]
    if points.count > limit:
        ends.append(points.block(points.count - _MAX_DIGESTED_POINTS, _MAX_DIGESTED_POINTS))
    return hashlib.sha256(json.dumps([dict(end) for end in ends]).encode()).hexdigest()


def table_points(
    file: Path, variable_of: Callable[[str, str], Variable], entries: Mapping[str, ParameterEntry]
) -> Points:
    """Points of a CSV file whose heading names parameters.

    `variable_of`: function of a name and its position in messages; raises `HostError` if there is no such variable
    that can be set; `entries`: units of columns whose heading has none. Raises `HostError` with the line, the name and
    the value.
    """
    table = TextTable(file, HostError, f"The table {file}", units=True)
    names = table.names
    variables = [variable_of(name, f"{file}, heading") for name in names]
    unknown = next((name for name in entries if name not in names), None)
    if unknown is not None:
        raise HostError(f"parameters.'{unknown}' is not a column of {file}; its columns are {', '.join(names)}.")
    columns: dict[str, list[Value]] = {name: [] for name in names}
    for row in table.rows():
        for variable, cell in zip(variables, row.cells, strict=True):
            unit = table.units.get(variable.name) or (entries[variable.name].unit if variable.name in entries else None)
            text = cell.replace(",", ".") if table.decimal and variable.kind == "Real" else cell
            columns[variable.name].append(_cell(text, variable, unit, f"{file}, line {row.line}"))
    if not columns[names[0]]:
        raise HostError(f"The table {file} has no points; it needs a heading and at least one row.")
    return points_of_columns(columns)


def points_of_columns(columns: Mapping[str, list[Value]]) -> Points:
    """Points of the columns of a table, all of the same length."""
    return Points(len(next(iter(columns.values()))), partial(_block_of_columns, columns))


def _block_of_columns(columns: Mapping[str, list[Value]], first: int, count: int) -> Mapping[str, list[Value]]:
    return {name: values[first : first + count] for name, values in columns.items()}


def _cell(text: str, variable: Variable, unit: str | None, where: str) -> Value:
    if unit is None or unit == variable.unit or variable.kind != "Real":
        return variable.read(text, where)
    try:
        number = number_of(text)
    except ValueError:
        raise HostError(f"{where}: '{variable.name}': {brief(text)} is not a number.") from None
    return in_fmu_unit(number, unit, variable, where)
