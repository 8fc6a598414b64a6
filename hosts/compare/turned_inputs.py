"""An input of a log with the other sign turns all that it moves: it is told, not each of these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hosts.compare.comparison import ComparedSignal, Comparison
from hosts.compare.curve import Curve
from hosts.compare.plausibility import turned
from hosts.compare.replay import Replay
from hosts.compare.stretches import Stretch
from hosts.compare.task import Task


def turned_signals(compared: Comparison) -> dict[str, ComparedSignal]:
    """Signals that have the opposite sign of the simulation, by name."""
    return {n: s for n, s in compared.signals.items() if turned(s.measured, s.simulated, s.alignment.delay) is not None}


def turned_input(task: Task, compared: Comparison, odd: dict[str, ComparedSignal]) -> str:
    """A sentence on the input with which all these signals, turned, have the sign of the simulation; else empty.

    Each input that can be turned is tried in a run. `odd`: from `turned_signals`.
    """
    for name in task.turnable if odd else ():
        signal = task.inputs[name]
        with Replay(task.fmu, [_turned(s, name) for s in task.stretches], task.step) as replay:
            result = replay.run()
        curves = {n: Curve(result, n) for n in compared.signals}
        left = [n for n, s in compared.signals.items() if turned(s.measured, curves[n], s.alignment.delay) is not None]
        if result.failed_steps or left:
            continue
        what = f"input '{signal.source}' ({name})"
        if len(odd) == 1:
            return f"Or the {what} has the opposite sign: the signal has that of the simulation when it is turned."
        return (
            f"The {what} has the opposite sign: when it is turned, {_listed(list(odd))} have the sign of the "
            "simulation, which they have not as it is. factor = -1.0 in the alias file turns it."
        )
    return ""


def _turned(stretch: Stretch, name: str) -> Stretch:
    made = stretch.manoeuvre
    start = {n: -v if n == name and not isinstance(v, str) else v for n, v in made.start.items()}
    return replace(stretch, manoeuvre=replace(made, inputs=dict(made.inputs) | {name: -made.inputs[name]}, start=start))


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:-1]) + f" and {names[-1]}"
