"""Accuracy and speed of a car: ``python -m benchmarks.car [--car CAR] [--json FILE] [--no-fmu] [--chart FILE]``.

Per manoeuvre and step, against the stored reference (see `benchmarks.car_references`):

- `path_error_m`: largest distance between the car's reference point and its place in the reference at the same time;
  `path_error_rel`: that over the length of the reference's path.
- `wheel_load_error_rel`: largest error of a wheel load over the largest wheel load of the manoeuvre.
- `us_per_step`, `realtime_factor`: least processor time of the kernel. The `_fmpy` ones go through the FMU: FMPy sets
  the inputs, makes a communication step of the same length and gets four outputs.
- `..._fmpy_held`, `..._fmpy_followed`: the errors through the FMU, with inputs that are held over a communication step,
  and with inputs that follow their first derivatives (fmi2SetRealInputDerivatives).
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ali3.running import run_command
from benchmarks.car import manoeuvres, trajectories
from benchmarks.car.accuracy import LOAD_BOUND, PATH_BOUND, _build_fmu, chart, measure, verdict
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table

STEPS = (0.01, 0.005, 0.002, 0.001)  # s
COLUMNS = {
    "manoeuvre": "",
    "h_s": ".3f",
    "path_error_m": ".2e",
    "path_error_rel": ".1e",
    "wheel_load_error_rel": ".1e",
    "iterations_mean": ".2f",
    "iterations_max": ".0f",
    "halvings": ".0f",
    "us_per_step": ".1f",
    "realtime_factor": ".0f",
    "us_per_step_fmpy": ".1f",
    "realtime_factor_fmpy": ".0f",
    "path_error_rel_fmpy_held": ".1e",
    "wheel_load_error_rel_fmpy_held": ".1e",
    "path_error_rel_fmpy_followed": ".1e",
    "wheel_load_error_rel_fmpy_followed": ".1e",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("car", __doc__, chart="errors against cost")
    parser.add_argument("--no-fmu", action="store_true", help="leave the runs through FMPy out")
    parser.add_argument("--repeats", type=int, default=5, metavar="N", help="timed runs per row; default: 5")
    parser.add_argument("--manoeuvres", nargs="+", default=manoeuvres.NAMES, choices=manoeuvres.NAMES, metavar="NAME")
    parser.add_argument("--car", default=manoeuvres.PROTOTYPE, choices=manoeuvres.CARS, help="default: the prototype")
    options = parser.parse_args(arguments)
    todo = [(name, h) for name in options.manoeuvres for h in STEPS]
    with tempfile.TemporaryDirectory() as folder:
        fmu = None if options.no_fmu else _build_fmu(Path(folder), options.car)
        rows = [measure(name, h, fmu, options.repeats, options.car) for name, h in watched(todo)]
    print_table(rows, COLUMNS)
    print()
    print(
        f"Largest step within {100 * PATH_BOUND:g} % of the path's length and {100 * LOAD_BOUND:g} % of the largest "
        "wheel load:"
    )
    lines = verdict(rows)
    print("\n".join(f"  {line}" for line in lines))
    save_rows(
        options.json,
        "car",
        rows,
        reference=f"own engine, h = {trajectories.STEP:g} s, tests/data/car",
        car=options.car,
        repeats=options.repeats,
        warm_up=1,
        fmpy="set 3 inputs, one communication step of h, get 4 outputs; null: without FMU or another road",
        verdict=lines,
    )
    if options.chart:
        chart(rows, options.chart, options.car)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
