"""The parameters of an FMU, printed or written as a set: ``ali3 check FMU --show-parameters``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.columns import in_columns
from ali3.message_text import shortened
from ali3.units import typeset
from ali3.write_parameter_set import write_parameter_set
from hosts.common.options import FmuOptions
from hosts.fmu.fmu import described
from hosts.fmu.parameter_file_settings import settings_of_file
from hosts.fmu.parameters_as_set import parameter_set_of
from hosts.fmu.settings import settings_of
from hosts.fmu.variables import Variables

if TYPE_CHECKING:
    from hosts.common.numbers import Value
    from hosts.fmu.setting import Setting
    from hosts.fmu.settings import Settings


def report_parameters(fmu: Path, options: FmuOptions, out: Path | None, diff: Path | None, show: bool = False) -> int:
    """Print the parameters of an FMU of FMI 2.0 or 3.0, or their differences from a set, and write them as a set.

    `options`: values that are set first; `out`: file of the written set; `diff`: parameter set of which only differing
    values are printed; `show`: whether the table is printed also when a set is written. Returns the exit code.
    """
    description = described(fmu)
    variables = Variables(description)
    settings = settings_of(variables, options)
    if diff is not None:
        rows = _differences(variables, settings.start, settings_of_file(diff, variables, str(diff)))
        _print_rows(rows)
        if not rows:
            print(f"{diff} sets nothing to another value than {fmu} has.")
    elif out is None or show:
        _print_table(variables, settings)
    else:
        _print_rows(settings.rows())
    if out is not None:
        result = parameter_set_of(variables, description.modelName, settings.start)
        write_parameter_set(result, out, as_built=not settings.changes)
        print(f"written: {out}, {len(result.entries)} parameters")
    return 0


def _print_table(variables: Variables, settings: Settings) -> None:
    rows = [("name", "value", "unit", "range", "", "description")]
    for v in variables.parameters:
        value = settings.start.get(v.name, v.start)
        unit = typeset(v.unit) if v.kind == "Real" else ""
        bounds = v.range.removesuffix(f" {unit}") if unit else v.range
        rows.append((v.name, v.text(value), unit, bounds, v.variability, v.description))
    _print_rows(settings.rows())
    _print_rows(rows)


def _differences(variables: Variables, values: Mapping[str, Value], other: Sequence[Setting]) -> list[tuple[str, str]]:
    rows, other_values = [], {s.variable.name: s.value for s in other}
    for name in variables.names:
        v = variables[name]
        before, after = values.get(name, v.start), other_values.get(name, values.get(name, v.start))
        if before != after:
            rows.append((name, f"{v.text(before)} -> {v.with_unit(after)}"))
    return rows


def _print_rows(rows: Sequence[Sequence[str]]) -> None:
    for line in in_columns([[shortened(cell) for cell in row] for row in rows]):
        print(line)
