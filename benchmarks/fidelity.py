"""How much model a car needs: ``python -m benchmarks.fidelity [--json FILE] [--chart FILE] [--repeats N]``.

The same manoeuvres with every fidelity of the car (`mbs.scenes.prototype_car.Fidelity`). Errors are against the stored
references (`benchmarks.fidelity_references`).
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car.fidelity import COMPARED, chart, measure, verdict
from benchmarks.car.fidelity_runs import NAMES
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table

STEPS = (0.01, 0.005, 0.002)  # s
COLUMNS = {
    "manoeuvre": "",
    "fidelity": "",
    "h_s": ".3f",
    "coordinates": "d",
    "rows": "d",
    "modes": "d",
    "moment": ".3f",
    "moment_unfiltered": ".3f",
    "motion": ".1e",
    "wheel_load": ".3f",
    "iterations_mean": ".2f",
    "iterations_max": "d",
    "us_per_step": ".0f",
    "realtime_factor": ".1f",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("fidelity", __doc__, chart="errors against cost")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="timed runs per row; default: 3")
    parser.add_argument("--manoeuvres", nargs="+", default=NAMES, choices=NAMES, metavar="NAME")
    options = parser.parse_args(arguments)
    todo = [(name, fidelity, h) for name in options.manoeuvres for fidelity in COMPARED for h in STEPS]
    rows = [measure(name, fidelity, h, options.repeats) for name, fidelity, h in watched(todo)]
    print_table(rows, COLUMNS)
    lines = verdict(rows)
    print("\n" + "\n".join(lines))
    save_rows(options.json, "fidelity", rows, repeats=options.repeats, warm_up=1, verdict=lines)
    if options.chart:
        chart(rows, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
