"""Detects inputs with the wrong sign and speeds in the wrong unit, each by a run without the mistake.

An input with the wrong sign inverts signals; a speed in the wrong unit changes the initial speed of the car.
"""

from collections.abc import Collection
from dataclasses import replace

from ali3.message_text import word_list
from ali3.units import Misread, misread
from hosts.common.errors import HostError
from hosts.compare.comparison import ComparedSignal, Comparison
from hosts.compare.curve import Curve
from hosts.compare.deviations import Deviations, deviations
from hosts.compare.plausibility import MIN_CORRELATION, inverted_correlation
from hosts.compare.replay import Replay
from hosts.compare.segments import Segment
from hosts.compare.task import Task
from hosts.measures.log_signals import SPEEDS

_SPEED = "initial.speed"
_LATERAL_SPEED = "initial.lateral_speed"
_NEARER = 3.0  # times as far off is a speed in the present unit; parameters of a car change a coasting speed less


def inverted_signals(compared: Comparison) -> dict[str, ComparedSignal]:
    """Signals with the opposite sign of the simulation, by name."""
    return {
        n: s
        for n, s in compared.signals.items()
        if inverted_correlation(s.measured, s.simulated, s.alignment.delay) is not None
    }


def inverted_input(task: Task, compared: Comparison, inverted: dict[str, ComparedSignal]) -> str:
    """A sentence on the input whose inversion gives all signals the sign of the simulation; otherwise empty.

    Each input that can be inverted is tried in a run. `inverted`: result of `inverted_signals`.
    """
    for name in task.invertible if inverted else ():
        signal = task.inputs[name]
        with Replay(task.fmu, [_with_inverted_input(s, name) for s in task.segments], task.step) as replay:
            result = replay.run()
        curves = {n: Curve(result, n) for n in compared.signals}
        unexplained = [
            n
            for n, s in compared.signals.items()
            if inverted_correlation(s.measured, curves[n], s.alignment.delay) is not None
        ]
        if result.failed_steps or unexplained:
            continue
        label = f"input '{signal.source}' ({name})"
        if len(inverted) == 1:
            return f"Or the {label} has the opposite sign: with the other sign the signal has that of the simulation."
        return (
            f"The {label} has the opposite sign: only with the other sign {word_list(list(inverted))} have the signs "
            "of the simulation. factor = -1.0 in the alias file changes it."
        )
    return ""


def misread_speed(task: Task, compared: Comparison, right: Collection[str]) -> str:
    """A sentence on the unit of the measured speed with which all other signals correlate; otherwise empty.

    Units are tried where no other signal correlates. Without other signals the speed itself has to correlate in that
    unit and deviate much less than in the present one. `right`: signals that agree with others of the log.
    """
    speeds = {n: s for n, s in compared.signals.items() if n in SPEEDS and n not in right}
    others = {n: s for n, s in compared.signals.items() if n not in SPEEDS}
    is_held = any(s.speed is not None for s in task.segments)  # a driver makes the simulated speed the measured one
    signals = others or ({} if is_held else speeds)
    begins = any(_SPEED in s.manoeuvre.start for s in task.segments)
    if not speeds or not signals or not begins or any(_is_like(s.deviations) for s in others.values()):
        return ""
    speed = next(iter(speeds.values())).measured
    alike: list[tuple[float, float, Misread]] = []
    for mistake in misread(speed.unit):
        try:
            with Replay(task.fmu, [_with_scaled_speed(s, mistake.factor) for s in task.segments], task.step) as replay:
                result = replay.run()
        except HostError:  # the FMU does not start so fast
            continue
        found = {n: _deviations(s, Curve(result, n), mistake.factor) for n, s in signals.items()}
        nearer = all(_NEARER * d.normalised < signals[n].deviations.normalised for n, d in found.items())
        if not result.failed_steps and all(map(_is_like, found.values())) and (others or nearer):
            alike.append(
                (max(d.normalised for d in found.values()), min(d.correlation for d in found.values()), mistake)
            )
    if not alike:
        return ""
    normalised, correlation, mistake = min(alike, key=lambda one: one[0])  # signals of near speeds correlate, too
    present = max(s.deviations.normalised for s in signals.values())
    reason = (
        f"the other signals are like those of the simulation (correlation {correlation:.2f} and more), as none is with "
        "the present unit."
        if others
        else f"it deviates by {normalised:.2g} of its standard deviation, with the present unit by {present:.2g}."
    )
    return (
        f"'{speed.source}' ({speed.name}) looks like {mistake.words}: with a car that starts so {reason} "
        f'unit = "{mistake.unit}" in the alias file.'
    )


def _is_like(deviation: Deviations) -> bool:
    return deviation.correlation >= MIN_CORRELATION


def _deviations(compared: ComparedSignal, curve: Curve, speed_factor: float) -> Deviations:
    """Deviations of a simulated signal from the measured one; a measured speed is scaled by `speed_factor`."""
    measured = curve.with_nearest_turns(compared.measured.between(0.0, curve.end))
    factor = speed_factor if measured.name in SPEEDS else 1.0
    return deviations(measured.time, factor * measured.values, curve(measured.time))


def _with_scaled_speed(segment: Segment, factor: float) -> Segment:
    """The segment with `factor` times the measured speed."""
    manoeuvre, speed = segment.manoeuvre, segment.speed
    start = {n: factor * float(v) if n in (_SPEED, _LATERAL_SPEED) else v for n, v in manoeuvre.start.items()}
    scaled = None if speed is None else replace(speed, values=factor * speed.values)
    return replace(segment, manoeuvre=replace(manoeuvre, start=start), speed=scaled)


def _with_inverted_input(segment: Segment, name: str) -> Segment:
    manoeuvre = segment.manoeuvre
    start = {n: -v if n == name and not isinstance(v, str) else v for n, v in manoeuvre.start.items()}
    return replace(
        segment,
        manoeuvre=replace(manoeuvre, inputs=dict(manoeuvre.inputs) | {name: -manoeuvre.inputs[name]}, start=start),
    )
