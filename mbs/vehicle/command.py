"""Command `ali3 car`: copies a car of the package to a folder, or checks a car file and prints its plausibility.

With --kinematics: draws its wheel travel and steer curves in the terms of ISO 8855, and prints their values in
the drawn position. With --cheapest: measures error and cost of each fidelity and step, and names the cheapest within
tolerances.
"""

import argparse
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path

from ali3.columns import in_columns
from ali3.command_run import run_command
from ali3.errors import UserError
from ali3.extras import command_needs
from ali3.files import atomic_file, write_json
from ali3.options import Parser, add_option, name_and_text, options_given
from ali3.units import quantity
from mbs.common.errors import ModelError

_KINEMATICS_OPTIONS = ("travel", "fidelity", "points", "out")


def main(arguments: Sequence[str] | None = None, prog: str = "python -m mbs.vehicle.command") -> int:
    """Run the command, which the user typed as `prog`; returns the exit code."""
    parser = Parser(prog=prog, description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("car", nargs="?", metavar="CAR", help="a car of the package, or the folder or file of a car")
    parser.add_argument("folder", nargs="?", type=Path, metavar="FOLDER", help="copy the car there; it must not exist")
    add_option(parser, "--list")
    add_option(parser, "--show-parameters")
    curves = parser.add_argument_group("kinematics, cheapest level")
    curves.add_argument("--kinematics", action="store_true", help="draw the curves of the axles")
    curves.add_argument(
        "--travel",
        type=quantity("mm"),
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="range of wheel travel, mm, positive in bump; default: -80 80",
    )
    curves.add_argument("--points", type=int, metavar="N", help="of each curve; default: 81")
    add_option(curves, "--fidelity", "with a flexible frame, if there is one")
    add_option(curves, "--out", "out/kinematics/CAR")
    curves.add_argument(
        "--cheapest",
        type=name_and_text,
        nargs="*",
        metavar="NAME=VALUE",
        help="find the cheapest fidelity and step: path=1 loads=3 moments=P, in percent; drive=FILE, a CSV table of "
        "inputs over time, speed=V, m/s at its start; default: path=1 loads=3, three drives",
    )
    add_option(parser, "--json", "none")
    add_option(parser, "--picture", "none; points of the file, from the side and above")
    options = parser.parse_args(arguments)
    if not options.list and options.car is None:
        parser.error("a CAR is needed, or --list")
    if options.kinematics and not options.list:
        command_needs("hosts")
        return run_command(lambda: _kinematics(options, parser), (ModelError,), options)
    if options.cheapest is not None and not options.list:
        return run_command(lambda: _cheapest(options, parser), (ValueError, RuntimeError), options)
    return run_command(lambda: _run(options, parser), (ValueError,), options)


def _cheapest(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    """Measure the levels of a car; returns the exit code."""
    from mbs.vehicle.levels.report import report

    if options.folder is not None:
        raise UserError("A car is copied to a FOLDER, or its levels are compared by --cheapest; give one of them.")
    _check_unused(options_given(parser, options, _KINEMATICS_OPTIONS), "--kinematics")
    return report(options)


def _check_unused(options: Sequence[str], requirement: str) -> None:
    """Raise `UserError` if there are options that need another one."""
    if options:
        raise UserError(f"{options[0]} needs {requirement}.")


def _kinematics(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    """Draw the kinematics of a car; returns the exit code."""
    from mbs.vehicle.kinematics.report import report

    if options.folder is not None:
        raise UserError("A car is copied to a FOLDER, or its curves are drawn by --kinematics; give one of them.")
    _check_unused(options_given(parser, options, ("cheapest",)), "a call without --kinematics")
    return report(options)


def _run(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    """List, copy or check cars; returns the exit code."""
    from mbs.vehicle.copy_car import copy_car
    from mbs.vehicle.read_car import car_names, load

    _check_unused(options_given(parser, options, _KINEMATICS_OPTIONS), "--kinematics")
    if not options.list and options.folder is None:
        return _check(options)
    _check_unused(options_given(parser, options, ("json", "picture")), "a CAR alone, --kinematics or --cheapest")
    if options.list:
        print("\n".join(in_columns([(name, load(name).description) for name in car_names()])))
        return 0
    for file in copy_car(options.car, options.folder):
        print(file)
    return 0


def _check(options: argparse.Namespace) -> int:
    """Check a car and print its summary; returns the exit code."""
    from ali3.plausibility import summary_of, tables_of
    from mbs.vehicle.errors import CarWarning
    from mbs.vehicle.picture import draw_car
    from mbs.vehicle.read_car import load
    from mbs.vehicle.summary import parameter_table, summary

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", CarWarning)
        car = load(options.car)
    plausibilities = car.plausibility()
    print(f"{summary(car)}\n\n{summary_of(plausibilities)}")
    if options.json is not None:
        write_json(options.json, tables_of(plausibilities))
    if options.picture is not None:
        with atomic_file(options.picture) as target:
            draw_car(car, target)
        print(f"written: {options.picture}")
    if options.show_parameters:
        print("\n" + parameter_table(car))
    for warning in caught:
        print(f"warning: {warning.message}", file=sys.stderr)
    return 0
