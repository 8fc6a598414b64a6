"""Runs an FMU with the values that are set: ``ali3 run FMU [--parameters SSV] [--set NAME=VALUE] [--input CSV]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.running import run_command
from hosts.common.errors import HostError
from hosts.common.numbers import number
from hosts.common.options import add_road_option, add_setting_options, wishes

if TYPE_CHECKING:
    from hosts.driving.manoeuvre import Manoeuvre
    from hosts.fmu.fmu import Fmu


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.run.run") -> int:
    """Run the command, which the user typed as `prog`; 0 if every step was accepted."""
    parser = argparse.ArgumentParser(
        prog=prog, description="Run any FMU of FMI 2.0 co-simulation, write its outputs as a table and plot them."
    )
    parser.add_argument("fmu", type=Path, metavar="FMU")
    add_setting_options(parser)
    add_road_option(parser)
    parser.add_argument(
        "--input",
        type=Path,
        metavar="CSV",
        help="table of inputs and tunable parameters over time, as for the command drive; without it they keep their "
        "start values",
    )
    parser.add_argument(
        "--stop-time", type=number, metavar="T", help="how long, s; default: that of the table, else that of the FMU"
    )
    parser.add_argument("--step", type=number, metavar="H", help="communication step in s; default: that of the FMU")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    options = parser.parse_args(arguments)
    return run_command(lambda: _run(options))


def _run(options: argparse.Namespace) -> int:
    from hosts.driving.co_simulation import check_columns, communication_step, run_with_bar
    from hosts.driving.manoeuvre_settings import set_in
    from hosts.fmu.fmu import Fmu
    from hosts.run.result_files import print_result, result_paths, write_csv, write_record
    from hosts.run.result_plots import plot_page
    from hosts.run.run_summary import summary

    path = options.fmu
    with Fmu(path) as fmu:
        table, picture, record = result_paths(options.out, path.stem)
        manoeuvre = run_manoeuvre(fmu, options.input, options.stop_time)
        check_columns(fmu, manoeuvre)
        manoeuvre, settings = set_in(fmu, manoeuvre, wishes(options))
        step = communication_step(fmu, manoeuvre, options.step)
        result = run_with_bar(fmu, manoeuvre, step)
    rows = summary(result, step)
    write_csv(result, table)
    write_record(fmu, manoeuvre.name, step, settings, result, record)
    plot_page(result, picture, settings.title(path.stem), rows)
    return print_result((settings.rows(), rows), result, (table, picture, record))


def run_manoeuvre(fmu: Fmu, table: Path | None, stop_time: float | None) -> Manoeuvre:
    """What an FMU is run with: a table of inputs, or none for the time of its default experiment.

    Parameters
    ----------
    fmu : Fmu
    table : Path, optional
        CSV file with time and inputs.
    stop_time : float, optional
        s; by default that of the table or experiment, else 10 s.

    Raises
    ------
    HostError
        The table is none, or needs a driver.
    """
    import numpy as np

    from hosts.driving.manoeuvre import Manoeuvre
    from hosts.recordings.load_manoeuvre import load_manoeuvre

    if table is not None:
        if table.suffix not in (".csv", ".ini"):
            raise HostError(f"{table} is no table of inputs; its name ends in .csv.")
        manoeuvre = load_manoeuvre(str(table))
        if manoeuvre.driver:
            raise HostError(f"{table} has a driver, who drives a car; use the command drive.")
        return manoeuvre if stop_time is None else replace(manoeuvre, stop_time=stop_time)
    if stop_time is None:
        experiment = fmu.description.defaultExperiment
        stop_time = float(experiment.stopTime) if experiment is not None and experiment.stopTime else 10.0
    return Manoeuvre("run", np.zeros(0), {}, stop_time)


if __name__ == "__main__":
    sys.exit(main())
