"""Drives a car for hours by itself: the work of ``ali3 check FMU --soak``.

A drive is a seed: runs of 15 to 60 s from random starts, up to 40 m/s and 100 km away, with jumps, sudden turns,
roll-overs, resets and rewinds, all in one process. The same seed gives the same drive. Every step is checked.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.bars import bar as bar_of
from ali3.cores import available_cores
from ali3.files import check_writable, make_folder, write_text
from ali3.isolated import Lost
from ali3.locks import locked
from hosts.common.errors import HostError
from hosts.common.options import wishes
from hosts.experiment.journal import Journal
from hosts.experiment.pool import Pool
from hosts.experiment.run_key import run_key
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_file import fmu_file
from hosts.fmu.own_process import files_of
from hosts.fmu.settings import settings_of
from hosts.soak.drive import Failure, Outcome, Task, drive
from hosts.soak.grounds import IN_THE_FMU, jump_ground, world_ground
from hosts.soak.table import is_good, print_outcomes

if TYPE_CHECKING:
    from hosts.soak.grounds import Ground

SEEDS = 10
SEED = 1
SECONDS = 1000.0
STEP = 0.002
OUT = Path("out", "soak")
_FIDELITIES = (0, 2)


def soak(options: argparse.Namespace, prog: str) -> int:
    """Do the drives that the options of the command say. `prog`: how the user typed the command.

    Result: exit code: 1 if something failed.
    """
    seconds = SECONDS if options.stop_time is None else options.stop_time
    step = STEP if options.step is None else options.step
    if not 0.0 < seconds < math.inf or not 0.0 < step < math.inf:
        raise HostError(f"A drive of {seconds:g} s in steps of {step:g} s; both must be positive and finite.")
    odd = next((n for n in options.fidelity if not float(n).is_integer()), None)
    if odd is not None:
        raise HostError(f"--fidelity is {odd:g}; it must be a whole number.")
    if options.json is not None:
        check_writable(options.json)
    path, out = fmu_file(options.fmu).absolute(), make_folder(options.out or OUT).absolute()
    with Fmu(path) as fmu:
        start = settings_of(fmu.table, wishes(options)).start
        fidelities = _fidelities(fmu, [int(n) for n in options.fidelity])
        roads = "road.file" in fmu.variables and "road.file" not in start
    records = [ground.record for ground in _grounds(out, options.world)] if roads else []
    seed = SEED if options.seed is None else options.seed
    tasks = [
        Task(str(path), seed + k // len(fidelities), fidelity, seconds, step, start, records, str(out))
        for k in range(options.drives or SEEDS * len(fidelities))
        for fidelity in (fidelities[k % len(fidelities)],)
    ]
    busy = f"Another program drives in {out}; wait for it, or give another --out."
    with locked(out, busy), Journal[Outcome](out / "done", Outcome) as journal:
        if options.again:
            journal.clear()
        kept = journal.read()
        before = [kept.get(_key(task)) for task in tasks]
        outcomes = [made or Outcome(task.seed, task.fidelity) for task, made in zip(tasks, before, strict=True)]
        left = [place for place, outcome in enumerate(before) if outcome is None]
        if len(left) < len(tasks):
            print(f"{len(tasks) - len(left)} of {len(tasks)} drives are there; --again makes them again.", flush=True)
        return _drive(options, prog, tasks, outcomes, left, journal)


def _key(task: Task) -> str:
    roads = [Path(ground["road"]) for ground in task.grounds]
    return run_key(Path(task.fmu), task, files=[*files_of(task.start), *roads])


def _drive(
    options: argparse.Namespace,
    prog: str,
    tasks: Sequence[Task],
    outcomes: list[Outcome],
    left: Sequence[int],
    journal: Journal[Outcome],
) -> int:
    """Make the drives that are left, and tell of all; the exit code."""
    try:
        _drive_all(tasks, outcomes, left, options.jobs or available_cores(), journal)
    finally:  # after Ctrl-C too, of what is done
        print_outcomes(tasks, outcomes, f"{prog} --soak", options.world)
        if options.json is not None:
            record = {"tasks": [asdict(task) for task in tasks], "outcomes": [asdict(outcome) for outcome in outcomes]}
            write_text(options.json, json.dumps(record, indent=1) + "\n")
            print(f"written: {options.json}", flush=True)
    return 0 if all(map(is_good, outcomes)) else 1


def _drive_all(
    tasks: Sequence[Task], outcomes: list[Outcome], left: Sequence[int], jobs: int, journal: Journal[Outcome]
) -> None:
    """Make drives under a progress bar, each in a process; of one that is not done its outcome has the seconds.

    `left`: places of those that are made; each outcome is kept as soon as it is there.
    """
    form = "{desc}: {percentage:3.0f} % {bar} {n_fmt} of {total_fmt} s, {elapsed} so far, {remaining} to go"
    total = math.ceil(sum(task.seconds for task in tasks))
    with bar_of(total=total, desc="soak", bar_format=form, delay=0.0) as bar:

        def progress(number: int, seconds: float) -> None:
            place = left[number]
            outcomes[place].simulated = min(seconds, tasks[place].seconds)
            bar.update(min(int(sum(outcome.simulated for outcome in outcomes)), total) - bar.n)

        with Pool(drive, Outcome, jobs) as pool:
            for number, outcome in pool.results([tasks[place] for place in left], progress):
                place = left[number]
                if isinstance(outcome, Lost):
                    seconds, words = outcomes[place].simulated, f"The process of the drive {outcome.how}."
                    outcomes[place].failures.append(Failure("crash", words, -1, seconds, ""))
                else:
                    outcomes[place] = outcome
                progress(number, outcomes[place].simulated)
                if not isinstance(outcome, Lost):
                    journal.add(_key(tasks[place]), outcome)


def _fidelities(fmu: Fmu, asked: Sequence[int]) -> list[int | None]:
    if "fidelity" not in fmu.variables:
        if asked:
            raise HostError(f"{fmu.path} has no choice of fidelity.")
        return [None]
    for fidelity in asked:
        fmu.table["fidelity"].check(fidelity, "--fidelity")
    return list(asked or _FIDELITIES)


def _grounds(out: Path, worlds: Sequence[str]) -> list[Ground]:
    folder = out / "roads"
    jumps = [jump_ground(folder), jump_ground(folder, (1e5, -1e5))]
    named = [world_ground(name, folder / f"world_{k}") for k, name in enumerate(worlds)]
    return [*2 * jumps, *2 * named, *IN_THE_FMU]
