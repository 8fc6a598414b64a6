"""Cars whose suspensions are tables against those with links: ``python -m benchmarks.tables [--json FILE]``.

The same manoeuvres with the same step. Path: largest distance of the reference points over the length of the way;
loads: largest difference over the largest change of a wheel load. What steps cost:
`python -m benchmarks.instructions`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from ali3.running import run_command
from benchmarks.car import manoeuvres
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.machine import describe
from benchmarks.shared.tables import print_table
from mbs import Settings, System, compile
from mbs.vehicle import load

STEPS = (0.002, 0.005, 0.01)  # s
NAMES = (
    "slalom",
    "double_lane_change_replay",
    "step_steer",
    "steady_cornering",
    "full_lock",
    "launch_and_brake",
    "drop",
)
WHEELS = ("FL", "FR", "RL", "RR")
COLUMNS = {
    "car": "",
    "manoeuvre": "",
    "h_s": "g",
    "way_m": ".0f",
    "path": ".1e",
    "path_m": ".1e",
    "load": ".1e",
    "load_N": ".2g",
    "iterations": ".2f",
    "iterations_links": ".2f",
}
CARS = (manoeuvres.PROTOTYPE, "hatchback")
"""Those of decision 90."""


@cache
def tabled(car: str) -> System:
    """A car by tables."""
    return compile(load(car).model(fidelity="table"))


def compare(car: str, name: str, h: float) -> dict[str, Any]:
    """A row of errors."""
    manoeuvre = manoeuvres.load(name, car)
    one, other = (manoeuvres.run_on(s, manoeuvre, h) for s in (tabled(car), manoeuvres.system_of(name, car)))
    assert one.report is not None
    assert other.report is not None
    gap = np.hypot(*(one[f"chassis.{c}"] - other[f"chassis.{c}"] for c in "xy")).max()
    way = float(np.hypot(*(np.diff(other[f"chassis.{c}"]) for c in "xy")).sum())
    loads = [(one[f"wheel_{w}.Fz"], other[f"wheel_{w}.Fz"]) for w in WHEELS]
    change = max(float(np.abs(b - b[0]).max()) for _, b in loads)
    off = max(float(np.abs(a - b).max()) for a, b in loads)
    return {
        "car": car,
        "manoeuvre": name,
        "h_s": h,
        "way_m": way,
        "path": gap / max(way, 1.0),
        "path_m": gap,
        "load": off / change,
        "load_N": off,
        "iterations": one.report.mean_iterations,
        "iterations_links": other.report.mean_iterations,
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("tables", __doc__)
    parser.add_argument("--cars", nargs="+", default=CARS, choices=manoeuvres.CARS, metavar="CAR")
    parser.add_argument("--manoeuvres", nargs="+", default=NAMES, choices=NAMES, metavar="NAME")
    options = parser.parse_args(arguments)

    def work() -> int:
        todo = [(car, name, h) for car in options.cars for name in options.manoeuvres for h in STEPS]
        rows = [compare(car, name, h) for car, name, h in watched(todo)]
        print_table(rows, COLUMNS)
        save_rows(options.json, describe("tables", Settings()), rows)
        return 0

    return run_command(work, (RuntimeError,))


if __name__ == "__main__":
    sys.exit(main())
