"""The points of a study: values of its parameters by a grid, at random or from a table, a block at a time."""

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
from hosts.study.parameters import Parameter, in_unit
from hosts.study.study_file import ParameterEntry, SamplingEntry

if TYPE_CHECKING:
    from hosts.study.random_points import Places

_MOST = 10**9
_DIGESTED = 256  # drawn points at both ends that tell one plan from another


@dataclass(frozen=True)
class Points:
    """The interface of a source of points."""

    count: int
    block: Callable[[int, int], Mapping[str, list[Value]]]
    """Of the number of a point and how many: their values by name."""
    parameters: tuple[Parameter, ...] = ()
    """Those that a rule draws; of a table none, any row of which can change by itself."""


def grid(lengths: Sequence[int]) -> Places:
    """All combinations, the last dimension fastest: middles of equal parts of [0, 1), one for each value."""

    def block(first: int, count: int) -> NDArray[np.float64]:
        indices = np.unravel_index(np.arange(first, first + count), lengths)
        return (np.stack(indices, axis=1) + 0.5) / np.array(lengths, dtype=np.float64)

    return block


def sampled_points(parameters: tuple[Parameter, ...], sampling: SamplingEntry, file: str) -> Points:
    """Points of a grid, or random ones. `file`: how messages call the study file.

    Raises `HostError`: there would be too many.
    """
    if sampling.method == "grid":
        parameters = tuple(p.of_grid() for p in parameters)
        lengths = tuple(p.length for p in parameters)
        count, places = math.prod(lengths), grid(lengths)
        if count > _MOST:
            product = " x ".join(map(str, lengths))
            raise HostError(f"{file}: the grid has {product} = {count:.3g} points; at most {_MOST:.0e} can be.")
    else:
        count, places = _drawn(len(parameters), sampling, file)

    def block(first: int, size: int) -> Mapping[str, list[Value]]:
        u = places(first, size)
        return {p.name: p.at(u[:, k]) for k, p in enumerate(parameters)}

    return Points(count, block, parameters)


def _drawn(d: int, sampling: SamplingEntry, file: str) -> tuple[int, Places]:
    """How many random points of d dimensions, and where they lie."""
    from hosts.study.random_points import latin_hypercube, saltelli, sobol_sequence

    n, seed = sampling.runs or 0, sampling.seed
    if sampling.method == "sobol":
        return n, sobol_sequence(d, seed)
    if sampling.method == "saltelli":
        return n * (d + 2), saltelli(d, seed)
    if n * d > _MOST:
        raise HostError(
            f"{file}: a Latin hypercube of {n} points of {d} parameters needs {8e-9 * n * d:.3g} GB of memory; "
            "take the method sobol."
        )
    return n, latin_hypercube(d, n, seed)


def digest(points: Points) -> str:
    """A hash of all points of a table, of the first and last where a rule draws them, which distinguishes plans."""
    limit = _DIGESTED if points.parameters else points.count
    ends = [points.block(0, min(points.count, limit))]
    if points.count > limit:
        ends.append(points.block(points.count - _DIGESTED, _DIGESTED))
    return hashlib.sha256(json.dumps([dict(end) for end in ends]).encode()).hexdigest()


def table_points(
    file: Path, variable_of: Callable[[str, str], Variable], entries: Mapping[str, ParameterEntry]
) -> Points:
    """Points of a CSV file whose heading names parameters.

    `variable_of`: of a name and of words for messages; raises `HostError` where there is no such variable that can be
    set; `entries`: units of columns whose heading has none. Raises `HostError` with the line, the name and the value.
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
    return Points(len(next(iter(columns.values()))), partial(_rows, columns))


def _rows(columns: Mapping[str, list[Value]], first: int, count: int) -> Mapping[str, list[Value]]:
    return {name: values[first : first + count] for name, values in columns.items()}


def _cell(text: str, variable: Variable, unit: str | None, where: str) -> Value:
    if unit is None or unit == variable.unit or variable.kind != "Real":
        return variable.read(text, where)
    try:
        number = number_of(text)
    except ValueError:
        raise HostError(f"{where}: '{variable.name}': {brief(text)} is not a number.") from None
    return in_unit(number, unit, variable, where)
