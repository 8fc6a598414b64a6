"""The paper's test on the kerb in figures: ``python -m benchmarks.kerb [--json FILE] [--steps H ...] [--rungs N ...]``.

Size of the model, Newton iterations and time beside those of the paper (293 variables, 239 constraints, 65 modes; 2
iterations on average and 3 at most; 48 s for the 15 s). Peaks are the largest changes of the bending moments from rest
before and after a low-pass of 10 Hz, front (SG1) and rear (SG3), with their errors against those of all steps of the
reference. The
last two columns: what is left of the moments at the end, as a part of the peak, while the tyres hold the car sideways,
and after their grip is let go.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmarks import ladder_runs
from benchmarks.command import parser_of, save_rows, watched
from benchmarks.common import describe, print_table
from benchmarks.ladder import RUNGS, size_of
from mbs import Settings, Simulation, Trajectory
from mbs.scenes import kerb_test
from mbs.scenes.prototype_car.chassis import RIGID

GAUGES = ("SG1", "SG3")
RELEASE = 13.0  # s: tyres let go
COLUMNS = {
    "rung": "",
    "h_s": ".3f",
    "coordinates": "d",
    "rows": "d",
    "modes": "d",
    "iterations_mean": ".2f",
    "iterations_max": "d",
    "seconds": ".2f",
    "realtime_factor": ".1f",
    **{f"{what}_{g}": ".2f" for g in GAUGES for what in ("peak", "filtered")},
    "peak_error": ".1e",
    "filtered_error": ".1e",
    "left_held": ".1e",
    "left_free": ".1e",
}


def changes(t: Trajectory, h: float) -> dict[str, float]:
    """Largest changes from rest, N m."""
    found = ladder_runs.peaks(t, h)
    shown = {f"peak_{g}": found[f"bending_moment.{g}"] for g in GAUGES}
    return shown | {f"filtered_{g}": found[f"{ladder_runs.FILTERED}bending_moment.{g}"] for g in GAUGES}


def left_at_the_end(rung: int | str, h: float) -> tuple[float, float]:
    """Largest change of a moment that stays, over its peak: as the car stands, and with its tyres let go."""
    car = Simulation(ladder_runs.system_of("kerb_test", rung))
    names = [f"bending_moment.{g}" for g in GAUGES]
    t = car.run(RELEASE, h, progress=False)
    peaks = {n: float(np.abs(t[n] - t[n][0]).max()) for n in names}
    held = car.sensors
    car.set_parameter("road.friction", 0.0)
    car.run(kerb_test.DURATION, h, progress=False)
    free = car.sensors
    one, other = (max(abs(s[n] - float(t[n][0])) / peaks[n] for n in names) for s in (held, free))
    return one, other


def measure(rung: int | str, h: float, repeats: int) -> dict[str, Any]:
    """One row; on the rigid rung there are no moments."""
    found = ladder_runs.run("kerb_test", rung, h)
    report = found.report
    assert report is not None
    spent = ladder_runs.cpu_time("kerb_test", rung, h, repeats)
    row: dict[str, Any] = {
        "rung": str(rung),
        "h_s": h,
        **size_of("kerb_test", rung),
        "iterations_mean": report.mean_iterations,
        "iterations_max": report.max_iterations,
        "seconds": spent,
        "realtime_factor": kerb_test.DURATION / spent,
    }
    if rung == RIGID:
        return row | {name: None for name in COLUMNS if name not in row}
    reference = ladder_runs.read_peaks("kerb_test")
    peaks = changes(found, h)
    errors = {"peak": 0.0, "filtered": 0.0}
    for g in GAUGES:
        for what, prefix in (("peak", ""), ("filtered", ladder_runs.FILTERED)):
            size = reference[f"{prefix}bending_moment.{g}"]
            errors[what] = max(errors[what], abs(peaks[f"{what}_{g}"] - size) / size)
    held, free = left_at_the_end(rung, h)
    return row | peaks | {f"{k}_error": v for k, v in errors.items()} | {"left_held": held, "left_free": free}


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("kerb", __doc__)
    parser.add_argument(
        "--steps", type=float, nargs="+", default=[kerb_test.STEP], metavar="H", help="s; default: 0.01"
    )
    parser.add_argument("--rungs", nargs="+", default=[str(r) for r in RUNGS], choices=[str(r) for r in RUNGS])
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="timed runs per row; default: 3")
    options = parser.parse_args(arguments)
    todo = [(int(r) if r.isdigit() else r, h) for r in options.rungs for h in options.steps]
    rows = [measure(rung, h, options.repeats) for rung, h in watched(todo)]
    print_table(rows, COLUMNS)
    save_rows(options.json, describe("kerb", Settings(), repeats=options.repeats), rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
