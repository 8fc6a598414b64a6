"""Copies a car of the package to a folder, or checks a car file and prints what the car is: ``ali3 car``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from ali3.running import run_command


def main(arguments: Sequence[str] | None = None, prog: str = "python -m mbs.vehicle.command") -> int:
    """Run the command; `prog` is how the user typed it."""
    parser = argparse.ArgumentParser(
        prog=prog,
        description="Check a car file and print what the car is; with a folder, copy a car of the package there.",
    )
    parser.add_argument("car", nargs="?", metavar="CAR", help="name of a car of the package, or a car's folder or file")
    parser.add_argument("folder", nargs="?", type=Path, metavar="FOLDER", help="copy the car there; it must not exist")
    parser.add_argument("--list", action="store_true", help="list the cars of the package")
    parser.add_argument("--parameters", action="store_true", help="print what the FMU has as parameters too")
    options = parser.parse_args(arguments)
    if not options.list and options.car is None:
        parser.error("a CAR is needed, or --list")
    return run_command(lambda: _run(options), (ValueError,))


def _run(options: argparse.Namespace) -> int:
    from mbs.vehicle.car_file import car_names, load

    if options.list:
        width = max(map(len, car_names()))
        for name in car_names():
            print(f"{name:<{width}}  {load(name).description}")
        return 0
    if options.folder is not None:
        from mbs.vehicle.copy_car import copy_car

        for file in copy_car(options.car, options.folder):
            print(file)
        return 0
    return _check(options.car, options.parameters)


def _check(car: str, parameters: bool) -> int:
    import sys
    import warnings

    from mbs.vehicle.car_file import load
    from mbs.vehicle.errors import CarWarning
    from mbs.vehicle.summary import parameter_table, summary

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", CarWarning)
        loaded = load(car)
    print(summary(loaded))
    if parameters:
        print("\n" + parameter_table(loaded))
    for warning in caught:
        print(f"warning: {warning.message}", file=sys.stderr)
    return 0
