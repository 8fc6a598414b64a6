"""Detects inputs with the wrong sign and speeds in the wrong unit: each is tried in a run.

An input with the other sign turns signals; a speed in another unit lets the car start slower or faster than it was.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace

from ali3.units import misread
from hosts.common.errors import HostError
from hosts.compare.comparison import ComparedSignal, Comparison
from hosts.compare.curve import Curve
from hosts.compare.deviations import deviations
from hosts.compare.plausibility import ALIKE, turned
from hosts.compare.replay import Replay
from hosts.compare.segments import Segment
from hosts.compare.task import Task
from hosts.measures.relations import SPEEDS

_SPEED = "initial.speed"
_ACROSS = "initial.lateral_speed"


def turned_signals(compared: Comparison) -> dict[str, ComparedSignal]:
    """Signals that have the opposite sign of the simulation, by name."""
    return {n: s for n, s in compared.signals.items() if turned(s.measured, s.simulated, s.alignment.delay) is not None}


def turned_input(task: Task, compared: Comparison, odd: dict[str, ComparedSignal]) -> str:
    """A sentence on the input with which all these signals, turned, have the sign of the simulation; else empty.

    Each input that can be turned is tried in a run. `odd`: from `turned_signals`.
    """
    for name in task.turnable if odd else ():
        signal = task.inputs[name]
        with Replay(task.fmu, [_turned(s, name) for s in task.segments], task.step) as replay:
            result = replay.run()
        curves = {n: Curve(result, n) for n in compared.signals}
        unexplained = [
            n for n, s in compared.signals.items() if turned(s.measured, curves[n], s.alignment.delay) is not None
        ]
        if result.failed_steps or unexplained:
            continue
        label = f"input '{signal.source}' ({name})"
        if len(odd) == 1:
            return f"Or the {label} has the opposite sign: with the other sign the signal has that of the simulation."
        return (
            f"The {label} has the opposite sign: only with the other sign {_listed(list(odd))} have the signs of the "
            "simulation. factor = -1.0 in the alias file changes it."
        )
    return ""


def misread_speed(task: Task, compared: Comparison, right: Collection[str]) -> str:
    """A sentence on the unit of the measured speed from which on all other signals are like the simulated; else empty.

    It is tried where none of them is as it stands. `right`: signals that other signals of the log bear out.
    """
    speed = next((s.measured for n, s in compared.signals.items() if n in SPEEDS and n not in right), None)
    signals = {n: s for n, s in compared.signals.items() if n not in SPEEDS}
    begins = any(_SPEED in s.manoeuvre.start for s in task.segments)
    if speed is None or not signals or not begins or any(s.deviations.correlation >= ALIKE for s in signals.values()):
        return ""
    for mistake in misread(speed.unit):
        if not mistake.usual:
            continue
        try:
            with Replay(task.fmu, [_at_speed(s, mistake.factor) for s in task.segments], task.step) as replay:
                result = replay.run()
        except HostError:  # the FMU does not start so fast
            continue
        r_values = [_correlation(s, Curve(result, n)) for n, s in signals.items()]
        if not result.failed_steps and all(one >= ALIKE for one in r_values):
            return (
                f"'{speed.source}' ({speed.name}) looks like {mistake.words}: with a car that starts so the other "
                f"signals are like those of the simulation (correlation {min(r_values):.2f} and more), as none is now. "
                f'unit = "{mistake.unit}" in the alias file.'
            )
    return ""


def _correlation(compared: ComparedSignal, curve: Curve) -> float:
    measured = curve.in_its_turns(compared.measured.between(0.0, curve.end))
    return deviations(measured.time, measured.values, curve(measured.time)).correlation


def _at_speed(segment: Segment, factor: float) -> Segment:
    """The segment from `factor` times the measured speed on."""
    manoeuvre, speed = segment.manoeuvre, segment.speed
    start = {n: factor * float(v) if n in (_SPEED, _ACROSS) else v for n, v in manoeuvre.start.items()}
    scaled = None if speed is None else replace(speed, values=factor * speed.values)
    return replace(segment, manoeuvre=replace(manoeuvre, start=start), speed=scaled)


def _turned(segment: Segment, name: str) -> Segment:
    manoeuvre = segment.manoeuvre
    start = {n: -v if n == name and not isinstance(v, str) else v for n, v in manoeuvre.start.items()}
    return replace(
        segment,
        manoeuvre=replace(manoeuvre, inputs=dict(manoeuvre.inputs) | {name: -manoeuvre.inputs[name]}, start=start),
    )


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:-1]) + f" and {names[-1]}"
