"""Shows the parameters of an FMU or writes them as a set: ``ali3 parameters FMU [--out SSV] [--diff SSV]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.running import run_command
from hosts.common.options import add_setting_options, wishes

if TYPE_CHECKING:
    from hosts.fmu.settings import Settings
    from hosts.fmu.variables import Variables


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.fmu.parameters") -> int:
    """Run the command, which the user typed as `prog`."""
    parser = argparse.ArgumentParser(
        prog=prog,
        description="Show the parameters of an FMU (FMI 2.0 or 3.0), or write them as a parameter set (SSV file of the "
        "SSP standard) for --parameters.",
    )
    parser.add_argument("fmu", type=Path, metavar="FMU")
    add_setting_options(parser)
    parser.add_argument("--out", type=Path, metavar="SSV", help="write all parameters, with what is set, to this file")
    parser.add_argument(
        "--diff",
        type=Path,
        metavar="SSV",
        help="show only where this set has other values than the FMU or than what is set",
    )
    options = parser.parse_args(arguments)
    return run_command(lambda: _parameters(options))


def _parameters(options: argparse.Namespace) -> int:
    from ali3.files import check_writable
    from ali3.parameter_set import write_parameter_set
    from hosts.fmu.fmu import described
    from hosts.fmu.settings import Settings, settings_of
    from hosts.fmu.variables import Variables

    if options.out is not None:
        check_writable(options.out)
    description = described(options.fmu)
    variables, given = Variables(description), wishes(options)
    settings = settings_of(variables, given)
    if options.diff is not None:
        other = Settings(variables)
        other.add_set(options.diff)
        _print_differences(variables, settings, other, options)
    elif options.out is None:
        _print_table(variables, settings)
    else:
        _print_rows(settings.rows())
    if options.out is not None:
        parameters = variables.parameter_set(description.modelName, settings.start)
        write_parameter_set(parameters, options.out, as_built=not settings.changes)
        print(f"written: {options.out}, {len(parameters.entries)} parameters")
    return 0


def _print_table(variables: Variables, settings: Settings) -> None:
    rows = [("name", "value", "unit", "range", "", "description")]
    for v in variables.parameters:
        value = settings.start.get(v.name, v.start)
        unit = "" if v.unit == "1" or v.kind != "Real" else v.unit
        bounds = v.range.removesuffix(f" {unit}") if unit else v.range
        rows.append((v.name, v.text(value), unit, bounds, v.variability, v.description))
    _print_rows(settings.rows())
    _print_rows(rows)


def _print_differences(variables: Variables, settings: Settings, other: Settings, options: argparse.Namespace) -> None:
    mine, theirs = settings.start, other.start
    rows = []
    for name in variables.names:
        v = variables[name]
        before, after = mine.get(name, v.start), theirs.get(name, mine.get(name, v.start))
        if before != after:
            rows.append((name, f"{v.text(before)} -> {v.with_unit(after)}"))
    _print_rows(rows)
    if not rows:
        print(f"{options.diff} sets nothing to another value than {options.fmu} has.")


def _print_rows(rows: Sequence[Sequence[str]]) -> None:
    """Columns side by side."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip())


if __name__ == "__main__":
    sys.exit(main())
