"""Drives a car for hours by itself: ``ali3 check FMU --soak``.

A drive is a seed: runs of 15 to 60 s from random starts, up to 40 m/s and 100 km away, with jumps, sudden turns,
roll-overs, resets and rewinds, all in one process. The same seed gives the same drive. Every step is checked.
"""

import argparse
import math
from collections.abc import Generator, Sequence
from contextlib import closing
from dataclasses import asdict
from pathlib import Path

from ali3.cores import available_cores
from ali3.files import check_writable, make_folder, write_json
from ali3.isolated_processes import Lost
from hosts.common.errors import HostError
from hosts.common.options import fmu_options
from hosts.experiment.experiment import Experiment
from hosts.experiment.store import ResultStore, report_resumed, run_key
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_file import fmu_file
from hosts.fmu.own_process import files_of
from hosts.fmu.settings import settings_of
from hosts.soak.drive import Failure, Outcome, Task, drive
from hosts.soak.soak_roads import IN_THE_FMU, Ground, jump_ground, world_ground
from hosts.soak.table import is_good, print_outcomes

SEEDS = 10
SEED = 1
SECONDS = 1000.0
STEP = 0.002
OUT = Path("out", "soak")
_FIDELITIES = (0, 2)


def soak(options: argparse.Namespace, prog: str) -> int:
    """Make the drives of the options of the command. `prog`: the command as the user typed it.

    Result: exit code, 1 if a drive has failed.
    """
    seconds = SECONDS if options.stop_time is None else options.stop_time
    step = STEP if options.step is None else options.step
    if not 0.0 < seconds < math.inf or not 0.0 < step < math.inf:
        raise HostError(f"A drive of {seconds:g} s in steps of {step:g} s; both must be positive and finite.")
    fraction = next((n for n in options.fidelity if not float(n).is_integer()), None)
    if fraction is not None:
        raise HostError(f"--fidelity is {fraction:g}; it must be a whole number.")
    if options.json is not None:
        check_writable(options.json)
    path, out = fmu_file(options.fmu).absolute(), make_folder(options.out or OUT).absolute()
    with Fmu(path) as fmu:
        start = settings_of(fmu.table, fmu_options(options)).start
        fidelities = _fidelities(fmu, [int(n) for n in options.fidelity])
        roads = "road.file" in fmu.variables and "road.file" not in start
    grounds = tuple(_grounds(out, options.world)) if roads else ()
    seed = SEED if options.seed is None else options.seed
    tasks = [
        Task(str(path), seed + k // len(fidelities), fidelity, seconds, step, start, grounds, str(out))
        for k in range(options.drives or SEEDS * len(fidelities))
        for fidelity in (fidelities[k % len(fidelities)],)
    ]
    keys = [run_key(path, task, files=_files_of_task(task)) for task in tasks]
    with ResultStore[Outcome](out, Outcome, "drives", options.again) as store:
        stored = [store.find(key, key) for key in keys]
        outcomes = [outcome or Outcome(task.seed, task.fidelity) for task, outcome in zip(tasks, stored, strict=True)]
        pending = [index for index, outcome in enumerate(stored) if outcome is None]
        report_resumed(len(tasks) - len(pending), len(tasks), "drives")
        try:
            for index in _make_drives(tasks, outcomes, pending, options.jobs or available_cores()):
                store.add(keys[index], keys[index], outcomes[index])
        finally:  # also after Ctrl-C, for the finished drives
            print_outcomes(tasks, outcomes, f"{prog} --soak", options.world)
            if options.json is not None:
                record = {
                    "tasks": [asdict(task) for task in tasks],
                    "outcomes": [asdict(outcome) for outcome in outcomes],
                }
                write_json(options.json, record)
                print(f"written: {options.json}", flush=True)
    return 0 if all(map(is_good, outcomes)) else 1


def _files_of_task(task: Task) -> list[Path]:
    roads = (file for ground in task.grounds for file in files_of({"road.file": ground.road}))
    return [*files_of(task.start), *roads]


def _make_drives(tasks: Sequence[Task], outcomes: list[Outcome], pending: Sequence[int], jobs: int) -> Generator[int]:
    """Make the drives of pending tasks; yields the index of each that reached its end.

    The outcome of a drive that is lost has its simulated seconds.
    """
    experiment: Experiment[Task, Outcome] = Experiment(
        "soak",
        drive,
        Outcome,
        lambda task: f"soak, seed {task.seed}",
        [file for task in tasks for file in (Path(task.fmu), *_files_of_task(task))],
        lambda task: task.seconds,
    )

    def report(position: int, seconds: float) -> None:
        outcomes[pending[position]].simulated = seconds

    with closing(experiment.results([tasks[index] for index in pending], experiment.pool(jobs), report)) as results:
        for position, _, outcome in results:
            if isinstance(outcome, Lost):
                partial, message = outcomes[pending[position]], f"The process of the drive {outcome.how}."
                partial.failures.append(Failure("crash", message, -1, partial.simulated, ""))
            else:
                outcomes[pending[position]] = outcome
                yield pending[position]


def _fidelities(fmu: Fmu, requested: Sequence[int]) -> list[int | None]:
    if "fidelity" not in fmu.variables:
        if requested:
            raise HostError(f"{fmu.path} has no choice of fidelity.")
        return [None]
    for fidelity in requested:
        fmu.table["fidelity"].check(fidelity, "--fidelity")
    return list(requested or _FIDELITIES)


def _grounds(out: Path, worlds: Sequence[str]) -> list[Ground]:
    folder = out / "roads"
    jumps = [jump_ground(folder), jump_ground(folder, (1e5, -1e5))]
    return [*2 * jumps, *2 * [world_ground(name) for name in worlds], *IN_THE_FMU]
