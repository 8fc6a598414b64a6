"""Checks the plausibility of a log before it is simulated."""

import math
from collections.abc import Mapping

import numpy as np

from ali3.units import misread
from hosts.common.errors import HostError
from hosts.compare.curve import Curve
from hosts.compare.deviations import deviations
from hosts.fmu.input_ranges import beyond_range
from hosts.fmu.named_fmu import NamedFmu
from hosts.measures.signal import Signal

MAX_GAP = 0.2
"""Default of the longest gap between samples of an input that is bridged, s."""
_GAP = 5.0  # median intervals
_RATIO_TOLERANCE = 1.12
MIN_CORRELATION = 0.8
"""Correlation from which two signals are taken to be the same quantity."""


def check_inputs(fmu: NamedFmu, inputs: Mapping[str, Signal], longest_gap: float, notes: list[str]) -> None:
    """Refuse inputs with gaps and values that the FMU cannot take.

    `longest_gap`: longest gap that is bridged by a straight line, s; `notes`: a sentence on each such gap is added.
    Raises `HostError` with the input, the time and a remedy.
    """
    for name, signal in inputs.items():
        steps = np.diff(signal.time)
        k, interval = int(np.argmax(steps)), signal.interval
        begin, end, label = signal.time[k], signal.time[k + 1], f"input '{signal.source}' ({name})"
        if steps[k] > max(longest_gap, 1.5 * interval):
            raise HostError(
                f"The log has no samples of the {label} from {begin:.6g} s to {end:.6g} s ({steps[k]:.3g} s; usual are "
                f"{interval:.3g} s): compare the time before (--to {begin:.6g}) or after (--from {end:.6g}), or "
                f"bridge it by a straight line with --longest-gap {math.ceil(100.0 * steps[k]) / 100.0:g}."
            )
        if steps[k] > _GAP * interval:
            notes.append(
                f"A gap of {steps[k]:.3g} s in the {label}, at {begin:.6g} s, is bridged by a straight line "
                f"(usual are {interval:.3g} s)."
            )
        if message := beyond_range(fmu.table[name], signal.values, "sample"):
            raise HostError(f'The log\'s {label} {message} An alias file gives a unit, such as unit = "%" or "deg".')


def note_gaps(outputs: Mapping[str, Signal], notes: list[str]) -> None:
    """Add a sentence to the notes for each compared signal with a gap, where nothing is compared."""
    for name, signal in outputs.items():
        steps = np.diff(signal.time)
        k = int(np.argmax(steps))
        if steps[k] > max(_GAP * signal.interval, MAX_GAP):
            notes.append(
                f"'{signal.source}' ({name}) has no samples from {signal.time[k]:.6g} s to {signal.time[k + 1]:.6g} s; "
                "nothing is compared there."
            )


def scale_mistake(signal: Signal, curve: Curve, delay: float = 0.0) -> str:
    """A sentence if a measured signal seems to have another unit or the opposite sign; otherwise empty.

    `delay`: delay of the signal, s.
    """
    x, y = curve(signal.time - (delay if math.isfinite(delay) else 0.0)), signal.values
    deviation = deviations(signal.time, y, x)
    label = f"'{signal.source}' ({signal.name})"
    if (inverted := inverted_correlation(signal, curve, delay)) is not None:
        return (
            f"{label} has the opposite sign of the simulation (correlation {inverted:.2f}): factor = -1.0 in the alias "
            "file turns it."
        )
    if not abs(deviation.correlation) >= MIN_CORRELATION:
        return ""
    # The ratio of standard deviations; noise lowers the slope of a regression.
    ratio = float(np.std(y) / np.std(x))
    by_unit = [(m, f'it looks like {m.words}: unit = "{m.unit}" in the alias file.') for m in misread(signal.unit)]
    by_factor = [(m, "is it in another unit, or is a factor missing?") for m in misread("")]
    for m, text in (*by_unit, *by_factor):
        if m.usual and 1.0 / _RATIO_TOLERANCE < ratio * m.factor < _RATIO_TOLERANCE:
            return f"{label} is {ratio:.4g} times as large as in the simulation: {text}"
    return ""


def inverted_correlation(signal: Signal, curve: Curve, delay: float = 0.0) -> float | None:
    """The negative correlation of a measured signal with the opposite sign of the simulation; otherwise None.

    `delay`: delay of the signal, s.
    """
    x, y = curve(signal.time - (delay if math.isfinite(delay) else 0.0)), signal.values
    # An inverted wave also resembles one with a delay of half a period, but less. A speed that falls where the
    # simulated one rises is not inverted: both are positive.
    simulated = curve(signal.time)
    correlation = deviations(signal.time, y, simulated).correlation
    late = deviations(signal.time, y, x).correlation
    return (
        correlation
        if correlation < -MIN_CORRELATION and not late > 0.05 - correlation and float(y @ simulated) < 0.0
        else None
    )
