"""Results of windows of a log: deviations of each, which have departed, and deviations by speed and acceleration."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hosts.compare.comparison import Comparison
from hosts.compare.deviations import rms
from hosts.compare.segment_fmu import SLIDING
from hosts.compare.segments import PEDALS, Segment
from hosts.driving.result import Result
from hosts.measures.signal import Signal

_FULL = 0.999  # of a pedal
_LEAST = 20  # samples of a bin that is shown
_BINS: Mapping[str, tuple[str, float]] = {"speed": ("m/s", 10.0), "lateral acceleration": ("m/s2", 2.0)}


@dataclass(frozen=True)
class Window:
    """A window that was driven from the measured state."""

    begin: float
    end: float
    """`begin`, `end`: in the log, s."""
    rms: dict[str, float]
    """Of the deviation of each signal, in its unit."""
    departed: str
    """The signal whose deviation exceeds the range of what was measured in all windows; empty: none."""


@dataclass(frozen=True)
class Bin:
    """Deviations of a signal where a measured quantity lies between two values."""

    signal: str
    quantity: str
    unit: str
    """`quantity`, `unit`: that the deviations are sorted by, and its unit."""
    low: float
    high: float
    samples: int
    rms: float
    mean: float


def windows(comparison: Comparison, segments: Sequence[Segment]) -> list[Window]:
    """Deviations of each window."""
    results = []
    ranges = {n: float(np.ptp(s.measured.values)) for n, s in comparison.signals.items()}
    for segment in segments:
        sizes, departed = {}, ""
        for name, s in comparison.signals.items():
            measured = s.measured.between(segment.place, segment.place + segment.end)
            error = s.simulated(measured.time) - measured.values
            sizes[name] = rms(error)
            if not np.max(np.abs(error)) <= ranges[name]:
                departed = departed or name
        results.append(Window(segment.begin, segment.begin + segment.end, sizes, departed))
    return results


def window_text(windows: Sequence[Window]) -> str:
    """How many windows there are, and which have departed, in a sentence."""
    departed = [w for w in windows if w.departed]
    if not departed:
        return f"{len(windows)} windows; none has departed."
    which = ", ".join(f"{w.begin:g} s ({w.departed})" for w in departed)
    count = f"{len(windows)} windows; {len(departed)} departed"
    return f"{count}, by more than the range of what was measured: those from {which}."


def scales_of(signals: Mapping[str, Signal]) -> dict[str, Signal]:
    """Measured speed, and size of the lateral acceleration: as measured, else yaw rate times speed."""
    speed = next((signals[n] for n in ("speed", "chassis.vx") if n in signals), None)
    results = {} if speed is None else {"speed": speed}
    rate, ay = signals.get("chassis.wz"), signals.get("chassis.ay")
    if rate is not None and speed is not None:
        values = np.abs(rate.values * np.interp(rate.time, speed.time, speed.values))
        results["lateral acceleration"] = Signal("", "", "m/s2", rate.time, values)
    elif ay is not None:
        results["lateral acceleration"] = Signal("", "", "m/s2", ay.time, np.abs(ay.values))
    return results


def bins(comparison: Comparison, scales: Mapping[str, Signal]) -> list[Bin]:
    """Deviations by speed and by lateral acceleration. `scales`: of `scales_of`, at the places of what is compared."""
    results = []
    for name, s in comparison.signals.items():
        error = s.simulated(s.measured.time) - s.measured.values
        for quantity, scale in scales.items():
            unit, width = _BINS[quantity]
            number = np.floor(np.interp(s.measured.time, scale.time, scale.values) / width)
            for k in np.unique(number):
                e = error[number == k]
                if len(e) >= _LEAST:
                    low = float(k * width)
                    results.append(Bin(name, quantity, unit, low, low + width, len(e), rms(e), float(np.mean(e))))
    return results


def held_text(result: Result, segments: Sequence[Segment]) -> list[str]:
    """How well a driver has held the speed, how much of the time he could not, and by which forces, in a sentence; none
    where no driver did.
    """
    demands = [(s.place + s.speed.time, s.speed.values) for s in segments if s.speed is not None]
    if not demands or "speed" not in result:
        return []
    time, values = (np.concatenate(parts) for parts in zip(*demands, strict=True))
    error = np.interp(time, result.time, result["speed"]) - values
    text = f"The driver held the speed within {rms(error):.2g} m/s rms ({np.mean(error):+.1g} on the mean)"
    pedals = np.max([result[n] for n in PEDALS if n in result], axis=0)
    full = np.interp(time, result.time, pedals) > _FULL
    if full.any() and not full.all():
        elsewhere = f"{rms(error[~full]):.2g} m/s rms elsewhere"
        text += f", a pedal at its end for {100.0 * np.mean(full):.0f} % of the time and {elsewhere}"
    if (slid := _sliding(result)).any():
        eased = np.mean(np.interp(time, result.time, slid))
        text += f", eased the throttle over a sliding axle for {100.0 * eased:.2g} % of the time"
    forces = [_axle(result, axle) for axle in "FR"]
    if any(f is None for f in forces):
        return [f"{text}."]
    front, rear = (rms(f) for f in forces if f is not None)
    return [f"{text}, by forces along the wheels of {front:.3g} N rms in front and {rear:.3g} N behind."]


def _sliding(result: Result) -> NDArray[np.bool_]:
    """Where both wheels of an axle slip by more than a driver holds the speed against."""
    slips = [[f"wheel_{axle}{side}.slip" for side in "LR"] for axle in "FR"]
    smaller_slips = [
        np.minimum(result[left], result[right]) for left, right in slips if left in result and right in result
    ]
    return (
        np.any([slip > SLIDING for slip in smaller_slips], axis=0)
        if smaller_slips
        else np.zeros(len(result.time), dtype=np.bool_)
    )


def _axle(result: Result, axle: str) -> NDArray[np.float64] | None:
    names = [f"wheel_{axle}{side}.Fx" for side in "LR"]
    return sum((result[n] for n in names), np.zeros(len(result.time))) if all(n in result for n in names) else None
