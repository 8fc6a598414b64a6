"""Points of a study that a table gives."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from ali3.tables import TextTable, number_of
from ali3.words import brief
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.variables import Variable
from hosts.study.parameters import in_unit
from hosts.study.study_file import ParameterEntry


class TablePoints:
    """Points of a table."""

    drawn = False

    def __init__(self, columns: Mapping[str, list[Value]]) -> None:
        self._columns = columns
        self.count = len(next(iter(columns.values())))

    def block(self, first: int, count: int) -> Mapping[str, list[Value]]:
        """See `hosts.study.points.Points`."""
        return {name: values[first : first + count] for name, values in self._columns.items()}


def table_points(
    file: Path, variable_of: Callable[[str, str], Variable], entries: Mapping[str, ParameterEntry]
) -> TablePoints:
    """Points of a CSV file whose heading names parameters.

    `variable_of`: of a name and of words for messages; raises `HostError` where there is no such variable that can be
    set; `entries`: units of columns whose heading has none. Raises `HostError` with the line, the name and the value.
    """
    table = TextTable(file, HostError, f"The table {file}", units=True)
    names = table.names
    variables = [variable_of(name, f"{file}, heading") for name in names]
    unknown = next((name for name in entries if name not in names), None)
    if unknown is not None:
        raise HostError(f"parameters.'{unknown}' is no column of {file}; its columns are {', '.join(names)}.")
    columns: dict[str, list[Value]] = {name: [] for name in names}
    for row in table.rows():
        for variable, cell in zip(variables, row.cells, strict=True):
            unit = table.units.get(variable.name) or (entries[variable.name].unit if variable.name in entries else None)
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
