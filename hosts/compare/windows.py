"""Results of windows of a log: deviations of each, departed windows, and deviations by speed and acceleration."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hosts.compare.comparison import Comparison
from hosts.compare.deviations import rms
from hosts.compare.measured_speed import SLIP_LIMIT
from hosts.compare.segments import PEDALS, Segment
from hosts.driving.result import Result
from hosts.measures.signal import Signal

_FULL_PEDAL = 0.999
_MIN_SAMPLES = 20  # of a bin
_BINS: Mapping[str, tuple[str, float]] = {"speed": ("m/s", 10.0), "lateral acceleration": ("m/s2", 2.0)}


@dataclass(frozen=True)
class Window:
    """A window that was driven from the measured state."""

    begin: float
    """Start in the log, s."""
    end: float
    """End in the log, s."""
    rms: dict[str, float]
    """Root mean square deviation of each signal, in its unit."""
    departed: str
    """Signal whose deviation exceeds the range of its measured values in all windows; empty: none."""


@dataclass(frozen=True)
class Bin:
    """Deviations of a signal where a measured quantity lies between two values."""

    signal: str
    quantity: str
    """Quantity of the bounds `low` and `high`."""
    unit: str
    """Unit of the bounds `low` and `high`."""
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
        rms_by_signal, departed = {}, ""
        for name, s in comparison.signals.items():
            measured = s.measured.between(segment.offset, segment.offset + segment.length)
            error = s.simulated(measured.time) - measured.values
            rms_by_signal[name] = rms(error)
            if not np.max(np.abs(error)) <= ranges[name]:
                departed = departed or name
        results.append(Window(segment.begin, segment.begin + segment.length, rms_by_signal, departed))
    return results


def window_text(windows: Sequence[Window]) -> str:
    """A sentence on the number of windows and on those that have departed."""
    departed = [w for w in windows if w.departed]
    if not departed:
        return f"{len(windows)} windows; none has departed."
    windows_text = ", ".join(f"{w.begin:g} s ({w.departed})" for w in departed)
    count = f"{len(windows)} windows; {len(departed)} departed"
    return f"{count}, by more than the range of what was measured: those from {windows_text}."


def scales_of(signals: Mapping[str, Signal]) -> dict[str, Signal]:
    """Measured speed and absolute value of the lateral acceleration: yaw rate times speed, otherwise as measured."""
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
    """Deviations by speed and by lateral acceleration. `scales`: of `scales_of`, on the time axis of the comparison."""
    results = []
    for name, s in comparison.signals.items():
        error = s.simulated(s.measured.time) - s.measured.values
        for quantity, scale in scales.items():
            unit, width = _BINS[quantity]
            number = np.floor(np.interp(s.measured.time, scale.time, scale.values) / width)
            for k in np.unique(number):
                e = error[number == k]
                if len(e) >= _MIN_SAMPLES:
                    low = float(k * width)
                    results.append(Bin(name, quantity, unit, low, low + width, len(e), rms(e), float(np.mean(e))))
    return results


def held_speed_text(result: Result, segments: Sequence[Segment]) -> list[str]:
    """A sentence on the accuracy of a held speed, the limits of the pedals and the forces; none without a driver."""
    references = [(s.offset + s.speed.time, s.speed.values) for s in segments if s.speed is not None]
    if not references or "speed" not in result:
        return []
    time, values = (np.concatenate(parts) for parts in zip(*references, strict=True))
    error = np.interp(time, result.time, result["speed"]) - values
    text = f"The driver held the speed within {rms(error):.2g} m/s rms ({np.mean(error):+.1g} on the mean)"
    pedals = np.max([result[n] for n in PEDALS if n in result], axis=0)
    at_limit = np.interp(time, result.time, pedals) > _FULL_PEDAL
    if at_limit.any() and not at_limit.all():
        elsewhere = f"{rms(error[~at_limit]):.2g} m/s rms elsewhere"
        text += f", a pedal at its end for {100.0 * np.mean(at_limit):.0f} % of the time and {elsewhere}"
    if (sliding := _sliding(result)).any():
        fraction = np.mean(np.interp(time, result.time, sliding))
        text += f", eased the throttle over a sliding axle for {100.0 * fraction:.2g} % of the time"
    forces = [_axle_force(result, axle) for axle in "FR"]
    if any(f is None for f in forces):
        return [f"{text}."]
    front, rear = (rms(f) for f in forces if f is not None)
    return [f"{text}, by forces along the wheels of {front:.3g} N rms in front and {rear:.3g} N behind."]


def _sliding(result: Result) -> NDArray[np.bool_]:
    """Rows in which both wheels of an axle exceed the slip at which a driver eases the throttle, shape (n,)."""
    slips = [[f"wheel_{axle}{side}.slip" for side in "LR"] for axle in "FR"]
    smaller_slips = [
        np.minimum(result[left], result[right]) for left, right in slips if left in result and right in result
    ]
    return (
        np.any([slip > SLIP_LIMIT for slip in smaller_slips], axis=0)
        if smaller_slips
        else np.zeros(len(result.time), dtype=np.bool_)
    )


def _axle_force(result: Result, axle: str) -> NDArray[np.float64] | None:
    names = [f"wheel_{axle}{side}.Fx" for side in "LR"]
    return sum((result[n] for n in names), np.zeros(len(result.time))) if all(n in result for n in names) else None
