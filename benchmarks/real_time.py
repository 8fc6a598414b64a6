"""Worst steps of wild driving: ``python -m benchmarks.real_time [--json FILE] [--chart FILE]``.

A car is driven at random over kerbs, rough ground and ramps at each fidelity and step, once without a limit of the
iterations of a step and once with `LIMITS`; the prototype with all modes of its frame makes the paper's kerb test too.
Measured is processor time of the thread, which leaves out what others do in between; the worst steps are repeated from
their saved states by a C program, and their instructions are counted where valgrind is installed. An hour each
(``--seconds 3600``) takes a day; the default is made for two minutes.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import fmpy
import numpy as np

from ali3.running import run_command
from benchmarks.car import limited_fall
from benchmarks.car.step_chart import chart
from benchmarks.car.step_costs import drive, summary
from benchmarks.car.step_replay import REPEATS, Replay
from benchmarks.car.wild_ground import write_ground
from benchmarks.shared.command import parser_of, save_chart, save_rows
from benchmarks.shared.instructions import counter
from benchmarks.shared.tables import print_table
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_fidelities
from mbs import compile
from mbs.common.progress import progress_for
from mbs.scenes import kerb_test
from mbs.vehicle.fidelity import Fidelity

FIDELITIES, STEPS = (0, 1, 2, 3), (1.0, 2.0, 5.0, 10.0)
LIMITS = {0: (6, 8, 12, 12), 1: (4, 6, 12, 12), 2: (3, 3, 8, 12), 3: (3, 3, 8, 12)}
"""Limits of the iterations of a step by fidelity, for each of `STEPS`: what a quarter of the deadline has time for."""
LEFT = {0: (2, 3, 6), 2: (2, 3, 5)}
"""Limits that are compared after a fall, by fidelity."""
WILD, KERB = "wild", "kerb test"
COLUMNS = {
    "drive": "",
    "fidelity": "d",
    "step_ms": "g",
    "limit": "d",
    "mean_us": ".0f",
    "p99_9_us": ".0f",
    "worst_us": ".0f",
    "worst_alone_us": ".0f",
    "replayed_us": ".0f",
    "quarter_us": ".0f",
    "instructions": ",d",
    "iterations": ".2f",
    "most_iterations": "d",
    "halvings": "d",
    "capped": "d",
    "residual_mm": ".2g",
    "refused": "d",
}
WORDS = f"""worst_alone_us: of steps that the system did not interrupt; replayed_us: the worst repeated, the least
of {REPEATS} times; quarter_us: a quarter of the deadline; instructions: of the step with most iterations; capped: steps
that ended at the limit; residual_mm: the largest that they left"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("real_time", __doc__, chart="worst steps and iterations")
    parser.add_argument("--fmu", type=Path, metavar="FILE", help="a native FMU of a car; default: the prototype, built")
    parser.add_argument("--road", type=Path, metavar="FILE", help="a road file; default: rough ground, kerbs and ramps")
    parser.add_argument(
        "--seconds", type=float, default=10.0, metavar="S", help="simulated, of each drive; default: 10"
    )
    parser.add_argument("--fidelity", type=int, action="append", choices=FIDELITIES, help="only this one; repeatable")
    parser.add_argument("--step", type=float, action="append", choices=STEPS, help="ms, only this one; repeatable")
    parser.add_argument("--limit", type=int, action="append", metavar="N", help="in place of none and the usual ones")
    parser.add_argument("--fall", type=Path, metavar="FILE", help="draw what limits leave after a fall from 1 m (PNG)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the driver; default: 1")
    options = parser.parse_args(arguments)
    if not 1.0 <= options.seconds < 1e6:
        parser.error("the time of a drive is at least 1 s")
    fidelities, steps = options.fidelity or FIDELITIES, options.step or STEPS
    cases = [
        (WILD, fidelity, step, limit)
        for fidelity in fidelities
        for step in steps
        for limit in options.limit or (0, LIMITS[fidelity][STEPS.index(step)])
    ]
    if options.fmu is None and Fidelity.DYNAMIC in fidelities:
        cases += [(KERB, int(Fidelity.DYNAMIC), step, 0) for step in steps]
    rows = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        fmu = options.fmu or _built(Path(folder))
        with progress_for(None) as bar:
            road = options.road or Path(folder, "wild.road")
            targets = write_ground(road) if options.road is None else []
            cars = {WILD: fmu} | ({KERB: _kerb(Path(folder))} if cases[-1][0] == KERB else {})
            replays = {name: Replay(car, Path(folder, f"unpacked {name}")) for name, car in cars.items()}
            for k, (name, fidelity, ms, limit) in enumerate(cases):
                start = {"fidelity": fidelity, "solver.step_iterations": limit, "road.file": str(road.resolve())}
                how = (start, options.seconds, targets) if name == WILD else ({}, kerb_test.DURATION, None)
                replay = replays[name]
                costs = drive(
                    *(cars[name], *how, 1e-3 * ms, options.seed),
                    lambda share, k=k: bar.update((k + share) / len(cases)),
                )
                row: dict[str, Any] = {"drive": name, "fidelity": fidelity, "step_ms": ms, "limit": limit}
                rows.append(row | summary(costs, 1e-3 * ms) | replay.measure(costs, 1e-3 * ms))
        if options.fall is not None:
            save_chart(limited_fall.chart(falls(fmu)), options.fall)
    print_table(rows, COLUMNS)
    print(f"\n{WORDS}")
    if counter() is None:
        print("valgrind is not installed: instructions were not counted")
    save_rows(options.json, "real_time", rows, seconds=options.seconds, seed=options.seed)
    if options.chart is not None:
        save_chart(chart([row for row in rows if row["drive"] == WILD]), options.chart)
    return 0


def falls(fmu: Path) -> dict[int, list[limited_fall.Fall]]:
    """Runs by fidelity in steps of 2 ms, the first without a limit."""
    found = {f: [limited_fall.fall(fmu, f, 2e-3, limit) for limit in (0, *LEFT[f])] for f in LEFT}
    for fidelity, runs in found.items():
        for run in runs:
            apart = 1e3 * float(np.linalg.norm(run.place - runs[0].place, axis=1).max())
            print(
                f"fall from 1 m, fidelity {fidelity}, limit {run.limit}: {run.capped} steps capped, at most "
                f"{run.residual.max():.2g} mm left, {apart:.2g} mm off, energy balance {run.balance:.3g}"
            )
    return found


def _kerb(folder: Path) -> Path:
    return build_fmu(compile(kerb_test.build(Fidelity.DYNAMIC)), "kerb_test", folder, [fmpy.platform])


def _built(folder: Path) -> Path:
    name, systems, default = load_fidelities("prototype_car")
    return build_fmu(list(systems.values()), name, folder, [fmpy.platform], kind="native", fidelity=default)


if __name__ == "__main__":
    sys.exit(run_command(main))
