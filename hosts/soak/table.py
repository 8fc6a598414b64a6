"""The table of a soak test."""

import shlex
from collections.abc import Callable, Sequence

from ali3.columns import in_columns
from ali3.processes import command_name
from hosts.common.options import set_arguments
from hosts.soak.drive import LARGEST_GROWTH, Outcome, Task

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
