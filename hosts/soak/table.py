"""The table of a soak test."""

from __future__ import annotations

from collections.abc import Sequence

from ali3.columns import in_columns
from ali3.running import command_name
from hosts.soak.drive import Outcome, Task
from hosts.soak.memory import LARGEST_GROWTH

_HEADINGS = (
    *("seed", "fidelity", "s", "runs", "km/h", "km away", "jumps", "longest", "rolled", "upright", "rewound"),
    *("failed", "balance", "open", "iterations", "halved", "capped", "memory", "grown", "wall s"),
)


def is_good(outcome: Outcome) -> bool:
    """Whether nothing failed and the memory did not grow."""
    return not outcome.failures and outcome.memory_growth <= LARGEST_GROWTH


def print_outcomes(tasks: Sequence[Task], outcomes: Sequence[Outcome], prog: str) -> None:
    """Print a row for each drive, the failures with the commands that repeat them, and the sum.

    `outcomes`: one for each task; `prog`: how the user typed the command.
    """
    print("\n".join(in_columns([_HEADINGS, *map(_row, outcomes)], range(len(_HEADINGS)))))
    for task, outcome in zip(tasks, outcomes, strict=True):
        _print_failures(task, outcome, prog)
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


def _row(outcome: Outcome) -> tuple[str, ...]:
    counts = outcome.counts
    return (
        f"{outcome.seed}",
        "-" if outcome.fidelity is None else f"{outcome.fidelity}",
        f"{outcome.simulated:.0f}",
        f"{outcome.runs}",
        f"{3.6 * counts.top_speed:.0f}",
        f"{1e-3 * counts.farthest:.0f}",
        f"{counts.jumps}",
        f"{counts.longest_jump:.2f} s",
        f"{counts.rollovers}",
        f"{outcome.uprights}",
        f"{outcome.rewinds}",
        f"{len(outcome.failures)}",
        f"{counts.largest_balance:.4f}",
        f"{counts.largest_open_energy:.4f}",
        f"{counts.most_iterations:.0f}",
        f"{counts.halvings:.0f}",
        f"{counts.capped:.0f}",
        f"{outcome.memory_last:.1f} MB",
        f"{outcome.memory_growth:+.2f} MB",
        f"{outcome.wall:.0f}",
    )


def _print_failures(task: Task, outcome: Outcome, prog: str) -> None:
    where = f"seed {outcome.seed}" + ("" if outcome.fidelity is None else f", fidelity {outcome.fidelity}")
    for failure in outcome.failures:
        road = failure.road or "the built-in road"
        print(f"{where}, run {failure.run}, {failure.time:g} s on {road}: {failure.kind}: {failure.text}")
        if failure.manoeuvre:
            again = f"{task.fmu} -m {failure.manoeuvre} --step {task.step:g}"
            print(f"  the last seconds again: {command_name('run')} {again}")
    if outcome.failures or outcome.memory_growth > LARGEST_GROWTH:
        fidelity = "" if outcome.fidelity is None else f" --fidelity {outcome.fidelity}"
        again = f"{task.fmu} --seed {task.seed}{fidelity} --stop-time {task.seconds!r} --drives 1"
        print(f"  the whole drive again: {prog} {again}")
