"""Drives a car for hours by itself: ``ali3 check FMU --soak``; the table of its drives.

A drive is a seed: runs of 15 to 60 s from random starts, up to 40 m/s and 100 km away, with jumps, sudden turns,
roll-overs, resets and rewinds, all in one process. The same seed gives the same drive. Every step is checked.
"""

import argparse
import shlex
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import asdict
from pathlib import Path

from ali3.columns import in_columns
from ali3.cores import available_cores
from ali3.files import make_folder, write_json
from ali3.isolated_processes import Lost
from ali3.processes import command_name
from hosts.common.errors import HostError
from hosts.common.options import fmu_options, set_arguments
from hosts.experiment.experiment import Experiment
from hosts.experiment.store import ResultStore, report_resumed, run_key
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_file import fmu_file
from hosts.fmu.own_process import files_of
from hosts.fmu.settings import settings_of
from hosts.soak.drive import LARGEST_GROWTH, Failure, Outcome, Task, drive
from hosts.soak.soak_roads import IN_THE_FMU, Ground, jump_ground, world_ground

_COLUMNS: dict[str, Callable[[Outcome], str]] = {
    "seed": lambda o: f"{o.seed}",
    "fidelity": lambda o: "-" if o.fidelity is None else f"{o.fidelity}",
    "s": lambda o: f"{o.simulated:.0f}",
    "runs": lambda o: f"{o.runs}",
    "km/h": lambda o: f"{3.6 * o.counts.top_speed:.0f}",
    "km away": lambda o: f"{1e-3 * o.counts.farthest:.0f}",
    "jumps": lambda o: f"{o.counts.jumps}",
    "longest": lambda o: f"{o.counts.longest_jump:.2f} s",
    "rolled": lambda o: f"{o.counts.rollovers}",
    "upright": lambda o: f"{o.uprights}",
    "rewound": lambda o: f"{o.rewinds}",
    "failed": lambda o: f"{len(o.failures)}",
    "balance": lambda o: f"{o.counts.largest_balance:.4f}",
    "open": lambda o: f"{o.counts.largest_open_energy:.4f}",
    "iterations": lambda o: f"{o.counts.most_iterations:.0f}",
    "halved": lambda o: f"{o.counts.halvings:.0f}",
    "capped": lambda o: f"{o.counts.capped:.0f}",
    "memory": lambda o: f"{o.memory_last:.1f} MB",
    "grown": lambda o: f"{o.memory_growth:+.2f} MB",
    "wall s": lambda o: f"{o.wall:.0f}",
}


def is_good(outcome: Outcome) -> bool:
    """Whether nothing failed and the memory did not grow."""
    return not outcome.failures and outcome.memory_growth <= LARGEST_GROWTH


def print_outcomes(tasks: Sequence[Task], outcomes: Sequence[Outcome], prog: str, worlds: Sequence[str] = ()) -> None:
    """Print a row for each drive, the failures with the commands that repeat them, and the sum.

    `outcomes`: one for each task; `prog`: how the user typed the command; `worlds`: those of ``--world``.
    """
    rows = [[cell(outcome) for cell in _COLUMNS.values()] for outcome in outcomes]
    print("\n".join(in_columns([[*_COLUMNS], *rows], range(len(_COLUMNS)))))
    for task, outcome in zip(tasks, outcomes, strict=True):
        _print_failures(task, outcome, prog, worlds)
    messages: dict[str, int] = {}
    for outcome in outcomes:
        for message, count in outcome.messages.items():
            messages[message] = messages.get(message, 0) + count
    for message, count in sorted(messages.items(), key=lambda item: -item[1])[:10]:
        print(f"FMU, {count} times: {message}")
    hours = sum(outcome.simulated for outcome in outcomes) / 3600.0
    bad = sum(len(outcome.failures) for outcome in outcomes)
    grown = sum(outcome.memory_growth > LARGEST_GROWTH for outcome in outcomes)
    steps = sum(outcome.counts.steps for outcome in outcomes)
    print(f"{hours:.3g} h simulated in {steps} steps: {bad} failures, {grown} drives whose memory grew.")


def _print_failures(task: Task, outcome: Outcome, prog: str, worlds: Sequence[str]) -> None:
    where = f"seed {outcome.seed}" + ("" if outcome.fidelity is None else f", fidelity {outcome.fidelity}")
    for failure in outcome.failures:
        road = failure.road or "the built-in road"
        print(f"{where}, run {failure.run}, {failure.time:g} s on {road}: {failure.kind}: {failure.text}")
        if failure.manoeuvre:
            arguments = [task.fmu, "-m", failure.manoeuvre, "--step", repr(task.step)]
            print(f"  the last seconds again: {command_name('run')} {shlex.join(arguments)}")
    if outcome.failures or outcome.memory_growth > LARGEST_GROWTH:
        arguments = [task.fmu, "--seed", str(task.seed), "--stop-time", repr(task.seconds), "--drives", "1", "--again"]
        arguments += [] if outcome.fidelity is None else ["--fidelity", str(outcome.fidelity)]
        arguments += ["--step", repr(task.step), *(part for name in worlds for part in ("--world", name))]
        print(f"  the whole drive again: {prog} {shlex.join([*arguments, *set_arguments(task.start)])}")


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
