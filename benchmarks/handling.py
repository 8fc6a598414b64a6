"""Ride, roll, understeer and performance of cars: ``python -m benchmarks.handling [CAR ...] [--json FILE]``.

A CAR is the name of one of the package, a folder with a car.toml, or such a file; by default all of the package that
have links. Each number stands beside what cars of the small class have; what it means is in `benchmarks.car.measures`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car.measures import MEASURES, measure, usual_words
from benchmarks.car.rig import kinematics
from benchmarks.car.rig_chart import draw
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from mbs.vehicle import car_names, load


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("handling", __doc__, chart="travel of the wheels on the rig")
    parser.add_argument("cars", nargs="*", metavar="CAR", help="name, folder or file; default: those of the package")
    options = parser.parse_args(arguments)
    cars = {name: load(name) for name in options.cars or car_names()}
    if not options.cars:  # axles by curves have no links to be measured
        cars = {name: car for name, car in cars.items() if car.linked}
    measured = {name: measure(cars[name]) for name in watched(list(cars))}
    rows = []
    for m in MEASURES:
        values = {name: found[m.name] for name, found in measured.items()}
        rows.append({"measure": m.name, "unit": m.unit, **values, "usual": usual_words(m), "meaning": m.meaning})
    print_table(rows, {"measure": "", "unit": "", **dict.fromkeys(cars, ".2f"), "usual": "", "meaning": ""})
    save_rows(options.json, "handling", rows, kinematics={n: kinematics(cars[n]) for n in cars})
    if options.chart:
        draw(cars, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
