"""Runs an FMU, or drives a car through a manoeuvre: ali3 run [FMU|CAR] [--manoeuvre NAME|FILE] [--stop-time T].

Without a manoeuvre inputs keep their start values. The folder gets a table (CSV), a picture (PNG) and a record of what
was run (JSON).
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.command_run import run_command
from ali3.options import Parser, add_option, name_and_text, options_given
from ali3.units import quantity
from hosts.common.errors import HostError
from hosts.common.options import add_fmu, add_setting_options, fmu_options
from hosts.common.units import unit_of
from hosts.driving.manoeuvres import manoeuvre_names
from hosts.fmu.car import is_car

if TYPE_CHECKING:
    from hosts.driving.simulated_fmu import SimulatedFmu


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 run") -> int:
    """Run the command, which the user typed as `prog`; 0 if every step was accepted."""
    parser = Parser(prog=prog, description=__doc__, epilog=f"manoeuvres: {', '.join(manoeuvre_names())}")
    add_fmu(parser, "?", "dist/PrototypeCar.fmu, else prototype")
    add_option(parser, "--manoeuvre", "none, inputs keep their start values")
    parser.add_argument(
        "--driver",
        action="append",
        default=[],
        type=_driver_setting,
        metavar="NAME=VALUE",
        help="a setting of the manoeuvre's driver, such as wheelbase=2.6 where the FMU does not provide it; repeatable",
    )
    parser.add_argument(
        "--kerb",
        action="store_true",
        help="the paper's kerb test: 15 s of the scene kerb_test, and a picture of the moments of the frame",
    )
    add_option(parser, "--stop-time", "that of the manoeuvre, else that of the FMU")
    add_option(parser, "--step", "that of the FMU; of the kerb test 0.01")
    add_option(parser, "--interval", "the step; stresses that an FMU computes on reading are then read at rows only")
    add_option(parser, "--fidelity", "that of the FMU")
    add_setting_options(parser)
    add_option(parser, "--aliases")
    add_option(parser, "--road")
    add_option(parser, "--confined")
    add_option(parser, "--out", "out", default=Path("out"))
    options = parser.parse_args(arguments)
    return run_command(lambda: _kerb(options, parser) if options.kerb else _run(options), options=options)


def _kerb(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    from hosts.run.kerb import kerb_test

    conflicting = options_given(parser, options, ("manoeuvre", "stop_time", "interval", "aliases", "road", "driver"))
    if conflicting:
        raise HostError(f"{conflicting[0]} cannot be combined with --kerb, which defines the drive.")
    if options.fmu is not None and is_car(options.fmu):
        raise HostError(
            f"--kerb runs the scene kerb_test; --manoeuvre kerb_drop drives the car {options.fmu} down a kerb."
        )
    return kerb_test(options.fmu, options.fidelity, options.step, options.out, fmu_options(options))


def _run(options: argparse.Namespace) -> int:
    from ali3.locks import locked
    from hosts.common.road import options_with_road
    from hosts.driving.driver import driver_of, with_settings
    from hosts.driving.manoeuvre import with_names_of
    from hosts.driving.manoeuvre_settings import apply_settings
    from hosts.driving.run_checks import check_columns, communication_step, steps_of
    from hosts.driving.runs_with_progress import run_with_bar
    from hosts.fmu.fmu import Fmu
    from hosts.fmu.fmu_file import fmu_file, snake_case
    from hosts.fmu.fmu_source import FmuSource
    from hosts.recordings.load_manoeuvre import check_manoeuvre_option, manoeuvre_of
    from hosts.run.course_result import course_result
    from hosts.run.result_files import print_result, result_paths, write_csv, write_record
    from hosts.run.result_plots import plot_page
    from hosts.run.run_summary import energy_balance, pace, summary

    check_manoeuvre_option(options.manoeuvre)
    set_options = options_with_road(options, options.out)
    path = fmu_file(options.fmu)
    with Fmu(path) as opened:
        source = FmuSource.named(opened.path, opened.table, options.aliases)
        fmu: SimulatedFmu = source.seen(opened)
        manoeuvre = manoeuvre_of(fmu, options.manoeuvre, options.stop_time)
        manoeuvre = with_settings(manoeuvre, dict(options.driver), fmu.variables, options.stop_time)
        manoeuvre = with_names_of(manoeuvre, fmu.variables)
        check_columns(fmu, manoeuvre)
        driver = driver_of(fmu, manoeuvre)
        manoeuvre, settings = apply_settings(opened, manoeuvre, set_options, options.fidelity, source.fmu_values)
        manoeuvre = replace(manoeuvre, start=source.ali3_values(manoeuvre.start))
        without_manoeuvre = options.manoeuvre is None
        stem = snake_case(path.stem) if without_manoeuvre else f"{snake_case(path.stem)}_{manoeuvre.name}"
        table, picture, record = result_paths(options.out, stem)
        step = communication_step(fmu, manoeuvre, options.step, options.interval)
        steps_per_row = 1 if options.interval is None else steps_of(options.interval, step, "The interval")
        result = run_with_bar(fmu, manoeuvre, step, driver, steps_per_row)
    course_rows, gates = ([], None) if driver is None else course_result(result, driver)
    rows = summary(result, step, course_rows)
    title = settings.title(path.stem if without_manoeuvre else f"{path.stem}: {manoeuvre.name.replace('_', ' ')}")
    with locked(options.out):  # of several runs into one folder all files of one stay
        write_csv(result, table)
        write_record(fmu, manoeuvre, step, settings, result, record, driver, source.of_record)
        plot_page(result, picture, title, rows, gates)
    printed = (settings.rows(), [*rows, pace(result, step)], energy_balance(result))
    return print_result(printed, result, (table, picture, record))


def _driver_setting(text: str) -> tuple[str, float]:
    """``NAME=VALUE`` with a number, or one with a unit where that of the name is known."""
    name, value = name_and_text(text)
    return name, quantity(unit_of(name) or unit_of(f"vehicle.{name}") or "")(value)
