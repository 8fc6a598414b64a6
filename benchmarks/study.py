"""Studies of many runs: ``python -m benchmarks.study [--fmu FILE] [--runs N] [--sizes N ...] [--json FILE]``.

Measured are the time that Dask takes beside runs of a car of about 0.1 s, on one and on two workers; the memory of the
process with client, scheduler and writer as runs of a small FMU grow in number; bytes of a row; the start of a study
that is there; and, for `docs/scale.md`, the parts of it that one process does for all: plan, tasks, rows.
With 20 000 runs of the car it takes about an hour on two cores; the default is some minutes.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from ali3.running import run_command
from benchmarks.methods import studies
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from hosts.common.errors import HostError

PARTS = ("overhead", "memory", "single")
_LOOP = 50
TABLES: dict[str, dict[str, str]] = {
    "loop": {"case": "", "runs": "d", "run_s": ".4f"},
    "runs": {
        "case": "", "workers": "d", "runs": "d", "failed": "d", "run_s": ".4f", "elapsed_s": ".1f", "rate": ".1f",
        "overhead_ms": ".2f", "overhead": ".2%", "chunks": "d", "main_ms": ".3f", "before_mb": ".0f", "main_mb": ".0f",
        "worker_mb": ".0f", "bytes": ".0f", "parts": "d", "start_s": ".1f",
    },
    "start again": {"case": "", "runs": "d", "start_s": ".1f"},
    "plan": {"method": "", "runs": "d", "start_s": ".2f", "main_ms": ".4f", "main_mb": ".0f"},
    "rows": {
        "case": "", "runs": "d", "main_ms": ".4f", "bytes": ".0f", "found_s": ".2f", "read_s": ".2f", "read_mb": ".0f"
    },
    "empty tasks": {"runs": "d", "workers": "d", "task_ms": ".3f", "main_ms": ".3f"},
}  # fmt: skip
WORDS = """run_s: in the worker; overhead: workers x elapsed less the time in runs, as a part of the latter; main_ms:
processor time of the process with client, scheduler and writer, of a run, row or task; before_mb, main_mb: its memory
before the first run and at most; bytes: on the disk, of a row; found_s: to find which runs are there; read_s, read_mb:
to open all rows"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("study", __doc__)
    parser.add_argument("--fmu", type=Path, default=Path("dist", "PrototypeCar.fmu"), metavar="FILE", help="of the car")
    parser.add_argument("--runs", type=int, default=200, metavar="N", help="of the car; default: 200")
    parser.add_argument("--seconds", type=float, default=0.1, metavar="S", help="of a run of the car; default: 0.1")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2], metavar="N", help="default: 1 2")
    parser.add_argument(
        "--sizes",
        type=int,
        nargs="+",
        default=[500, 2000],
        metavar="N",
        help="runs of the small FMU; default: 500 2000",
    )
    parser.add_argument("--rows", type=int, default=100_000, metavar="N", help="of the plan and the writer alone")
    parser.add_argument("--tasks", type=int, default=2000, metavar="N", help="that are empty; default: 2000")
    parser.add_argument("--part", choices=PARTS, action="append", help="only this one; repeatable")
    options = parser.parse_args(arguments)
    if min(options.runs, options.rows, options.tasks, *options.sizes, *options.workers) < 1 or options.seconds <= 0.0:
        parser.error("numbers of runs, workers and seconds are positive")
    parts = options.part or PARTS
    if "overhead" in parts and not options.fmu.is_file():
        raise HostError(f"There is no file {options.fmu}; build it, or give --fmu.")
    with tempfile.TemporaryDirectory(prefix="study-") as folder:
        rows = [work() for work in watched(list(_works(options, parts, Path(folder))))]
    for what, columns in TABLES.items():
        mine = [row for row in rows if row["what"] == what]
        if mine:
            print(f"\n{what}")
            print_table(mine, columns)
    print(f"\n{WORDS}")
    save_rows(options.json, "studies", rows, seconds=options.seconds)
    return 0


def _works(options: Any, parts: Sequence[str], folder: Path) -> Iterator[Callable[[], dict[str, Any]]]:
    """What is measured, each in a process of its own."""
    if "overhead" in parts:
        car = options.fmu.absolute()
        stop = studies.alone(studies.stop_time_for, "car", car, options.seconds, folder / "calibration")
        yield lambda: studies.alone(studies.loop, "car", car, _LOOP, stop, folder / "loop")
        for workers in options.workers:
            arguments = ("car", car, options.runs, workers, stop, folder / f"car-{workers}")
            yield lambda arguments=arguments: studies.alone(studies.study_runs, *arguments)
    if not set(parts) & {"memory", "single"}:
        return
    spring = studies.spring_fmu(folder)
    if "memory" in parts:
        for runs in options.sizes:
            place = folder / f"spring-{runs}"
            yield lambda runs=runs, place=place: studies.alone(
                studies.study_runs, "spring", spring, runs, max(options.workers), 1.0, place
            )
            yield lambda runs=runs, place=place: studies.start_again("spring", spring, runs, 1.0, place)
    if "single" in parts:
        for method in ("sobol", "latin_hypercube"):
            place = folder / f"plan-{method}"
            yield lambda method=method, place=place: studies.alone(
                studies.plan_alone, "spring", spring, options.rows, method, place
            )
        yield lambda: studies.alone(studies.rows_written, "spring", spring, options.rows, folder / "rows")
        yield lambda: studies.alone(studies.empty_tasks, options.tasks, max(options.workers))


if __name__ == "__main__":
    sys.exit(run_command(main))
