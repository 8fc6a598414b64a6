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

LONGEST_GAP = 0.2
"""s between samples of an input that is bridged unless the user says otherwise."""
_MANY = 5.0  # median intervals are a gap
_CLOSE = 1.12  # of a ratio
ALIKE = 0.8
"""Correlation from which two signals show the same quantity."""


def check_inputs(fmu: NamedFmu, inputs: Mapping[str, Signal], longest: float, notes: list[str]) -> None:
    """Refuse inputs with gaps and values that the FMU cannot take.

    `longest`: gap that is bridged by a straight line, s; `notes`: gains a sentence for each gap that is bridged. Raises
    `HostError` with the input, where, and what to do.
    """
    for name, signal in inputs.items():
        steps = np.diff(signal.time)
        k, usual = int(np.argmax(steps)), signal.interval
        begin, end, label = signal.time[k], signal.time[k + 1], f"input '{signal.source}' ({name})"
        if steps[k] > max(longest, 1.5 * usual):
            raise HostError(
                f"The log has no samples of the {label} from {begin:.6g} s to {end:.6g} s ({steps[k]:.3g} s; usual are "
                f"{usual:.3g} s): compare what lies before (--to {begin:.6g}) or after (--from {end:.6g}), or bridge "
                f"it by a straight line with --longest-gap {math.ceil(100.0 * steps[k]) / 100.0:g}."
            )
        if steps[k] > _MANY * usual:
            notes.append(
                f"A gap of {steps[k]:.3g} s in the {label}, at {begin:.6g} s, is bridged by a straight line "
                f"(usual are {usual:.3g} s)."
            )
        if beyond := beyond_range(fmu.table[name], signal.values, "sample"):
            raise HostError(f'The log\'s {label} {beyond} An alias file gives a unit, such as unit = "%" or "deg".')


def note_gaps(outputs: Mapping[str, Signal], notes: list[str]) -> None:
    """Tell where signals that are compared have no samples; nothing is compared there."""
    for name, signal in outputs.items():
        steps = np.diff(signal.time)
        k = int(np.argmax(steps))
        if steps[k] > max(_MANY * signal.interval, LONGEST_GAP):
            notes.append(
                f"'{signal.source}' ({name}) has no samples from {signal.time[k]:.6g} s to {signal.time[k + 1]:.6g} s; "
                "nothing is compared there."
            )


def odd_scale(signal: Signal, curve: Curve, delay: float = 0.0) -> str:
    """A sentence if a measured signal looks like one in another unit, or with the other sign; else empty.

    `delay`: of the signal, s.
    """
    x, y = curve(signal.time - (delay if math.isfinite(delay) else 0.0)), signal.values
    deviation = deviations(signal.time, y, x)
    label = f"'{signal.source}' ({signal.name})"
    if (opposite := turned(signal, curve, delay)) is not None:
        return (
            f"{label} has the opposite sign of the simulation (correlation {opposite:.2f}): factor = -1.0 in the alias "
            "file turns it."
        )
    if not abs(deviation.correlation) >= ALIKE:
        return ""
    # Of the spreads, not of the regression, which noise makes smaller.
    ratio = float(np.std(y) / np.std(x))
    by_unit = [(m, f'it looks like {m.words}: unit = "{m.unit}" in the alias file.') for m in misread(signal.unit)]
    by_factor = [(m, "is it in another unit, or is a factor missing?") for m in misread("")]
    for m, message in (*by_unit, *by_factor):
        if m.usual and 1.0 / _CLOSE < ratio * m.factor < _CLOSE:
            return f"{label} is {ratio:.4g} times as large as in the simulation: {message}"
    return ""


def turned(signal: Signal, curve: Curve, delay: float = 0.0) -> float | None:
    """The correlation with the simulation of a measured signal that has its opposite sign; else None.

    `delay`: of the signal, s.
    """
    x, y = curve(signal.time - (delay if math.isfinite(delay) else 0.0)), signal.values
    # A wave of the other sign is also one that is late by half a period, but not as well. One that falls where the
    # other rises has the same sign where both are positive, as a speed.
    now = curve(signal.time)
    still = deviations(signal.time, y, now).correlation
    late = deviations(signal.time, y, x).correlation
    return still if still < -ALIKE and not late > 0.05 - still and float(y @ now) < 0.0 else None
