"""Checks the samples of a log: constant stretches, values for missing samples, joined drives."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ali3.plausibility import Value, far_values
from hosts.measures.log_signals import (
    MIN_LONGITUDINAL_ACCELERATION,
    MIN_SPEED,
    PATH,
    QUANTITIES,
    SPEEDS,
    WHEELS,
    Array,
    Signals,
    columns_of,
    speed_of,
)
from hosts.measures.signal import Signal

MIN_EQUAL_SAMPLES = 10  # samples
MOVED = {"speed": 1.5, "ay": 1.0, "yaw": 0.15, "way": 5.0}
"""Changes from which a sensor must respond, m/s, m/s2, rad, m."""
CLIPPED = ("chassis.ax", "chassis.ay", "chassis.wz")
"""Signals of sensors with a limited range."""
PEAK = 4.0
"""Ratio of the samples at the end of a range and at the next value; at a rounded peak it is about 1 + sqrt(2)."""
ENDS = 1e-3
"""Relative difference of the ends of a symmetric range: integers of 12 bits range from -2048 to 2047."""
BLOCK = 30
"""Samples of a block that does not repeat by chance."""


def sample_values(signals: Signals) -> Iterator[Value]:
    """Values for missing samples, samples at the ends of a range and constant stretches of each signal."""
    speed_name = speed_of(signals)
    for name, s in signals.items():
        columns = columns_of(signals, name)
        yield Value(QUANTITIES["sentinel"], float(far_values(s.values).sum()), columns, f"'{s.source}',")
        if name in CLIPPED:
            yield Value(QUANTITIES["clipped"], float(_clipped_count(s.values)), columns, f"'{s.source}',")
        if speed_name is not None:
            yield Value(QUANTITIES["stands"], _longest_constant(s, signals, speed_name), columns, f"'{s.source}',")


def joint_sample_values(signals: Sequence[Signal]) -> Iterator[Value]:
    """Numbers of repeated samples, and of times at which most signals jump."""
    keys = {"rows": "all rows of the log"}
    yield Value(QUANTITIES["repeats"], float(_repeated_count(signals)), keys)
    yield Value(QUANTITIES["jumps"], float(_joint_jump_count(signals)), keys)


def _clipped_count(values: Array) -> int:
    """Number of samples at the ends of a symmetric range at which a sensor saturates."""
    result = 0
    for signed_values in (values, -values):
        levels, counts = np.unique(signed_values, return_counts=True)
        if len(levels) < 2 or abs(levels[-1] + levels[0]) > ENDS * levels[-1]:
            return 0
        if counts[-1] < max(MIN_EQUAL_SAMPLES, PEAK * counts[-2]):
            return 0
        result += int(counts[-1])
    return result


def _longest_constant(signal: Signal, signals: Signals, speed_name: str) -> float:
    """Duration of the longest constant stretch in which the signal must change by others, s."""
    ends = np.flatnonzero(np.concatenate([[True], np.diff(signal.values) != 0.0, [True]]))
    longest = 0.0
    for k in np.flatnonzero(np.diff(ends) >= MIN_EQUAL_SAMPLES):
        first, last = ends[k], ends[k + 1] - 1
        begin, end = float(signal.time[first]), float(signal.time[last])
        if end - begin > longest and _changes(signal, signals, speed_name, begin, end, float(signal.values[first])):
            longest = end - begin
    return longest


def _changes(signal: Signal, signals: Signals, speed_name: str, begin: float, end: float, value: float) -> bool:
    """Whether a signal with one value between two times, s, must have changed by other signals of the log."""

    def of(name: str) -> Array:
        return signals[name].between(begin, end).values if name in signals else np.zeros(0)

    speed, ax, ay, wz, duration = of(speed_name), of("chassis.ax"), of("chassis.ay"), of("chassis.wz"), end - begin
    if signal.name in SPEEDS:
        distance = (
            math.hypot(*(float(np.ptp(of(n))) for n in PATH)) if all(len(of(n)) for n in PATH) else value * duration
        )
        slower = distance > duration * (abs(value) + MOVED["speed"])  # the distance of both ends is a lower bound
        return bool(slower) or (len(ax) > 0 and abs(float(ax.mean())) * duration > MOVED["speed"])
    if signal.name in WHEELS:
        return len(speed) > 0 and float(np.ptp(speed)) > MOVED["speed"]
    if signal.name == "chassis.ax":
        least = MOVED["speed"] + MIN_LONGITUDINAL_ACCELERATION * duration  # a sensor has an offset
        return len(speed) > 0 and abs(float(speed[-1] - speed[0]) - value * duration) > least
    if signal.name == "chassis.wz":
        return len(ay) > 0 and float(np.ptp(ay)) > MOVED["ay"]
    if signal.name == "chassis.ay":
        return len(wz) > 0 and len(speed) > 0 and float(np.ptp(wz)) * float(speed.mean()) > MOVED["ay"]
    if signal.name == "chassis.yaw":
        return len(wz) > 0 and abs(float(wz.mean())) * duration > MOVED["yaw"]
    if signal.name in PATH and len(speed) > 0:
        other_axes = [float(np.ptp(of(n))) for n in PATH if n != signal.name and len(of(n))]
        # a sensor may drift at standstill
        rolling_speed = np.where(np.abs(speed) > MIN_SPEED, np.abs(speed), 0.0)
        return float(rolling_speed.mean()) * duration > MOVED["way"] + 1.5 * sum(other_axes)
    return False


def _repeated_count(signals: Sequence[Signal]) -> int:
    """Number of samples in blocks that repeat an earlier block, in the signal with the most values."""
    if not signals:
        return 0
    s = max(signals, key=lambda signal: len(np.unique(signal.values)))
    x = s.values
    if len(x) < 3 * BLOCK or len(np.unique(x)) < len(x) // 4:
        return 0
    positions: dict[bytes, int] = {}
    repeated = 0
    for k in range(0, len(x) - BLOCK, BLOCK):
        positions.setdefault(x[k : k + BLOCK].tobytes(), k)
    for k in range(BLOCK, len(x) - BLOCK + 1):
        first = positions.get(x[k : k + BLOCK].tobytes())
        if first is not None and first + BLOCK <= k and len(np.unique(x[k : k + BLOCK])) > BLOCK // 2:
            repeated += BLOCK
    return min(repeated, len(x))


def _joint_jump_count(signals: Sequence[Signal]) -> int:
    """Number of times at which most of at least three signals jump."""
    changing = [s for s in signals if len(np.unique(s.values)) > len(s.values) // 4]
    if len(changing) < 3:
        return 0
    times: dict[float, int] = {}
    for s in changing:
        steps = np.abs(np.diff(s.values))
        usual = float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else np.inf
        padded = np.pad(steps, 2)
        # a quick motion takes several steps
        neighbours = np.max([padded[:-4], padded[1:-3], padded[3:-1], padded[4:]], axis=0)
        for t in s.time[1:][(steps > 30.0 * usual) & (steps > 5.0 * neighbours)].tolist():
            times[t] = times.get(t, 0) + 1
    return sum(count > 0.6 * len(changing) for count in times.values())
