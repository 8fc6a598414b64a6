"""Drives an FMU through a manoeuvre: ``ali3 drive [FMU] --manoeuvre NAME-or-CSV [--fidelity N]``."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ali3.running import run_command
from hosts.common.errors import HostError
from hosts.common.numbers import assignment, number
from hosts.common.options import add_road_option, add_setting_options, wishes
from hosts.driving.manoeuvres import manoeuvre_names

DEFAULT_FMU = Path("dist", "PrototypeCar.fmu")


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.run.drive") -> int:
    """Run the command, which the user typed as `prog`; 0 if every step was accepted."""
    parser = argparse.ArgumentParser(prog=prog, description="Drive an FMU through a manoeuvre.")
    parser.add_argument("fmu", nargs="?", type=Path, default=DEFAULT_FMU, metavar="FMU", help=f"default: {DEFAULT_FMU}")
    parser.add_argument(
        "--manoeuvre",
        "-m",
        required=True,
        help=f"CSV file with time and inputs, or one of: {', '.join(manoeuvre_names())}",
    )
    parser.add_argument("--step", type=number, metavar="H", help="communication step in s; default: that of the FMU")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    parser.add_argument("--fidelity", type=number, metavar="N", help="how much model, where the FMU offers a choice")
    parser.add_argument(
        "--driver",
        action="append",
        default=[],
        type=assignment,
        metavar="NAME=VALUE",
        help="a setting of the manoeuvre's driver, such as wheelbase=2.6 where the FMU does not tell it; repeatable",
    )
    add_setting_options(parser)
    add_road_option(parser)
    options = parser.parse_args(arguments)
    return run_command(lambda: _drive(options))


def _drive(options: argparse.Namespace) -> int:
    from hosts.driving.co_simulation import check_columns, communication_step, driver_of, run_with_bar
    from hosts.driving.manoeuvre import with_names_of
    from hosts.driving.manoeuvre_settings import set_in
    from hosts.fmu.fmu import Fmu
    from hosts.recordings.load_manoeuvre import load_manoeuvre
    from hosts.run.result_files import print_result, result_paths, write_csv, write_record
    from hosts.run.result_plots import plot_page
    from hosts.run.run_summary import energy_balance, summary

    path, known = options.fmu, dict(options.driver)
    manoeuvre = load_manoeuvre(options.manoeuvre)
    if known and not manoeuvre.driver:
        raise HostError(f"The manoeuvre {manoeuvre.name} has no driver, so there is nothing to set by --driver.")
    manoeuvre = replace(manoeuvre, driver=dict(manoeuvre.driver) | {k: repr(v) for k, v in known.items()})
    with Fmu(path) as fmu:
        manoeuvre = with_names_of(manoeuvre, fmu.variables)
        check_columns(fmu, manoeuvre)
        driver = driver_of(fmu, manoeuvre)
        manoeuvre, settings = set_in(fmu, manoeuvre, wishes(options), options.fidelity)
        table, picture, record = result_paths(options.out, f"{_words(path.stem)}_{manoeuvre.name}")
        step = communication_step(fmu, manoeuvre, options.step)
        result = run_with_bar(fmu, manoeuvre, step, driver)
    course = driver.course if driver is not None else None
    outline = (driver.settings.vehicle_length, driver.settings.vehicle_width) if driver is not None else (0.0, 0.0)
    rows = summary(result, step, course, outline)
    write_csv(result, table)
    write_record(fmu, manoeuvre.name, step, settings, result, record)
    title = settings.title(f"{path.stem}: {manoeuvre.name.replace('_', ' ')}")
    plot_page(result, picture, title, rows, course)
    return print_result((settings.rows(), rows, energy_balance(result)), result, (table, picture, record))


def _words(name: str) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


if __name__ == "__main__":
    sys.exit(main())
