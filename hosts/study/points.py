"""The points of a study: values of its parameters, a block at a time."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

from ali3.tables import TextTable, number_of
from ali3.words import brief
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.variables import Variable
from hosts.study.parameters import Parameter, columns_of, in_unit
from hosts.study.sampling import Grid, LatinHypercube, Saltelli, Sampler, SobolSequence
from hosts.study.study_file import ParameterEntry, SamplingEntry

_MOST = 10**9
_DIGESTED = 256  # drawn points at both ends that tell one plan from another


class Points(Protocol):
    """Where points come from."""

    count: int

    def block(self, first: int, count: int) -> Mapping[str, list[Value]]:
        """Values of points `first` to `first + count - 1` by name."""
        ...


class SampledPoints:
    """Points of a sampler."""

    def __init__(self, parameters: tuple[Parameter, ...], sampler: Sampler) -> None:
        self.parameters, self.count, self._sampler = parameters, sampler.count, sampler

    def block(self, first: int, count: int) -> Mapping[str, list[Value]]:
        """See `Points`."""
        return columns_of(self.parameters, self._sampler.block(first, count))


class TablePoints:
    """Points of a table."""

    def __init__(self, columns: Mapping[str, list[Value]]) -> None:
        self._columns = columns
        self.count = len(next(iter(columns.values())))

    def block(self, first: int, count: int) -> Mapping[str, list[Value]]:
        """See `Points`."""
        return {name: values[first : first + count] for name, values in self._columns.items()}


def sampled_points(parameters: tuple[Parameter, ...], sampling: SamplingEntry, file: str) -> SampledPoints:
    """Points of a grid or by chance.

    Parameters
    ----------
    file : str
        How messages call the study file.

    Raises
    ------
    HostError
        There would be too many.
    """
    n, seed, d = sampling.runs or 0, sampling.seed, len(parameters)
    if sampling.method == "grid":
        parameters = tuple(p.of_grid() for p in parameters)
        sampler: Sampler = Grid([p.length for p in parameters])
        if sampler.count > _MOST:
            product = " x ".join(str(p.length) for p in parameters)
            raise HostError(f"{file}: the grid has {product} = {sampler.count:.3g} points; at most {_MOST:.0e} can be.")
    elif sampling.method == "latin_hypercube":
        if n * d > _MOST:
            raise HostError(
                f"{file}: a Latin hypercube of {n} points of {d} parameters needs {8e-9 * n * d:.3g} GB of memory; "
                "take the method sobol."
            )
        sampler = LatinHypercube(d, n, seed)
    elif sampling.method == "sobol":
        sampler = SobolSequence(d, n, seed)
    else:
        sampler = Saltelli(d, n, seed, sampling.second_order)
    return SampledPoints(parameters, sampler)


def table_points(
    file: Path, variable_of: Callable[[str, str], Variable], entries: Mapping[str, ParameterEntry]
) -> TablePoints:
    """Points of a CSV file whose heading names parameters.

    Parameters
    ----------
    variable_of : callable
        Of a name and of words for messages; raises `HostError` where there is no such variable that can be set.
    entries : mapping of str to ParameterEntry
        Units of columns.

    Raises
    ------
    HostError
        With the line, the name and the value.
    """
    table = TextTable(file, HostError, f"The table {file}")
    names = table.names
    variables = [variable_of(name, f"{file}, heading") for name in names]
    unknown = next((name for name in entries if name not in names), None)
    if unknown is not None:
        raise HostError(f"parameters.'{unknown}' is no column of {file}; its columns are {', '.join(names)}.")
    columns: dict[str, list[Value]] = {name: [] for name in names}
    for row in table.rows():
        for variable, cell in zip(variables, row.cells, strict=True):
            unit = entries[variable.name].unit if variable.name in entries else None
            text = cell.replace(",", ".") if table.decimal and variable.kind == "Real" else cell
            columns[variable.name].append(_cell(text, variable, unit, f"{file}, line {row.line}"))
    if not columns[names[0]]:
        raise HostError(f"The table {file} has no points; it needs a heading and at least one row.")
    return TablePoints(columns)


def _cell(text: str, variable: Variable, unit: str | None, where: str) -> Value:
    if unit is None or unit == variable.unit or variable.kind != "Real":
        return variable.read(text, where)
    try:
        number = number_of(text)
    except ValueError:
        raise HostError(f"{where}: '{variable.name}': {brief(text)} is not a number.") from None
    return in_unit(number, unit, variable, where)


def digest(points: Points) -> str:
    """A hash of all points of a table, of the first and last where a rule draws them, which tells two plans apart."""
    whole = points.count if isinstance(points, TablePoints) else _DIGESTED  # any row of a table can change by itself
    ends = [points.block(0, min(points.count, whole))]
    if points.count > whole:
        ends.append(points.block(points.count - _DIGESTED, _DIGESTED))
    return hashlib.sha256(json.dumps([dict(end) for end in ends]).encode()).hexdigest()
