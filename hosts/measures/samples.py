"""Checks the samples of a log: constant stretches, values that stand for missing ones, joined drives."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ali3.plausibility import Value, far_values
from hosts.measures.relations import LEAST, PATH, QUANTITIES, SPEEDS, WHEELS, Array, Signals, keys_of, speed_of
from hosts.measures.signal import Signal

FEWEST_EQUAL = 10  # samples
MOVED = {"speed": 1.5, "ay": 1.0, "yaw": 0.15, "way": 5.0}
"""m/s, m/s2, rad, m: of more than that a sensor tells something."""
CLIPPED = ("chassis.ax", "chassis.ay", "chassis.wz")
"""What sensors with a range measure."""
PEAK = 4.0
"""Samples at the end of a range beside those of the next value: a peak that is rounded has up to 1 + sqrt(2) times as
many, and a few more by chance."""
ENDS = 1e-3
"""Of a range, by which its ends are unlike: whole numbers of 12 bits go from -2048 to 2047."""
RUN = 30
"""Samples that are alike by chance in no drive."""


def of_samples(signals: Signals) -> Iterator[Value]:
    """Stretches that stand, values far from all others, and ranges that a sensor does not leave."""
    v = speed_of(signals)
    for name, s in signals.items():
        yield Value(QUANTITIES["sentinel"], float(far_values(s.values).sum()), keys_of(signals, name), f"'{s.source}',")
        if name in CLIPPED:
            yield Value(QUANTITIES["clipped"], float(_clipped(s.values)), keys_of(signals, name), f"'{s.source}',")
        if v is not None:
            yield Value(QUANTITIES["stands"], _stands(s, signals, v), keys_of(signals, name), f"'{s.source}',")


def of_all(signals: Sequence[Signal]) -> Iterator[Value]:
    """Stretches that come again, and jumps of most signals."""
    keys = {"rows": "all rows of the log"}
    yield Value(QUANTITIES["repeats"], float(_repeats(signals)), keys)
    yield Value(QUANTITIES["jumps"], float(_jumps(signals)), keys)


def _clipped(values: Array) -> int:
    """How many samples are at the ends of a range with one size to both sides, which a sensor reaches and stays at."""
    result = 0
    for side in (values, -values):
        levels, counts = np.unique(side, return_counts=True)
        if len(levels) < 2 or abs(levels[-1] + levels[0]) > ENDS * levels[-1]:
            return 0
        if counts[-1] < max(FEWEST_EQUAL, PEAK * counts[-2]):
            return 0
        result += int(counts[-1])
    return result


def _stands(signal: Signal, signals: Signals, v: str) -> float:
    """The longest stretch of equal samples in which others say that it changes, s."""
    ends = np.flatnonzero(np.concatenate([[True], np.diff(signal.values) != 0.0, [True]]))
    longest = 0.0
    for k in np.flatnonzero(np.diff(ends) >= FEWEST_EQUAL):
        first, last = ends[k], ends[k + 1] - 1
        begin, end = float(signal.time[first]), float(signal.time[last])
        if end - begin > longest and _changes(signal, signals, v, begin, end, float(signal.values[first])):
            longest = end - begin
    return longest


def _changes(signal: Signal, signals: Signals, v: str, begin: float, end: float, value: float) -> bool:
    """Whether the others of a log say that a signal changes between two times, s, where it has one value."""

    def of(name: str) -> Array:
        return signals[name].between(begin, end).values if name in signals else np.zeros(0)

    speed, ax, ay, wz, long = of(v), of("chassis.ax"), of("chassis.ay"), of("chassis.wz"), end - begin
    if signal.name in SPEEDS:
        distance = math.hypot(*(float(np.ptp(of(n))) for n in PATH)) if all(len(of(n)) for n in PATH) else value * long
        slower = distance > long * (abs(value) + MOVED["speed"])  # a straight line is the shortest way
        return bool(slower) or (len(ax) > 0 and abs(float(ax.mean())) * long > MOVED["speed"])
    if signal.name in WHEELS:
        return len(speed) > 0 and float(np.ptp(speed)) > MOVED["speed"]
    if signal.name == "chassis.ax":
        least = MOVED["speed"] + LEAST["accelerate"] * long  # a sensor has an offset
        return len(speed) > 0 and abs(float(speed[-1] - speed[0]) - value * long) > least
    if signal.name == "chassis.wz":
        return len(ay) > 0 and float(np.ptp(ay)) > MOVED["ay"]
    if signal.name == "chassis.ay":
        return len(wz) > 0 and len(speed) > 0 and float(np.ptp(wz)) * float(speed.mean()) > MOVED["ay"]
    if signal.name == "chassis.yaw":
        return len(wz) > 0 and abs(float(wz.mean())) * long > MOVED["yaw"]
    if signal.name in PATH and len(speed) > 0:
        beside = [float(np.ptp(of(n))) for n in PATH if n != signal.name and len(of(n))]
        rolls = np.where(np.abs(speed) > LEAST["move"], np.abs(speed), 0.0)  # one that stands may tell a little
        return float(rolls.mean()) * long > MOVED["way"] + 1.5 * sum(beside)
    return False


def _repeats(signals: Sequence[Signal]) -> int:
    """How many samples are those of an earlier stretch, one by one, in the signal that has the most values."""
    if not signals:
        return 0
    s = max(signals, key=lambda one: len(np.unique(one.values)))
    x = s.values
    if len(x) < 3 * RUN or len(np.unique(x)) < len(x) // 4:
        return 0
    where: dict[bytes, int] = {}
    repeated = 0
    for k in range(0, len(x) - RUN, RUN):
        where.setdefault(x[k : k + RUN].tobytes(), k)
    for k in range(RUN, len(x) - RUN + 1):
        first = where.get(x[k : k + RUN].tobytes())
        if first is not None and first + RUN <= k and len(np.unique(x[k : k + RUN])) > RUN // 2:
            repeated += RUN
    return min(repeated, len(x))


def _jumps(signals: Sequence[Signal]) -> int:
    """How many times most of at least three signals jump at one time."""
    moved = [s for s in signals if len(np.unique(s.values)) > len(s.values) // 4]
    if len(moved) < 3:
        return 0
    times: dict[float, int] = {}
    for s in moved:
        steps = np.abs(np.diff(s.values))
        usual = float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else np.inf
        around = np.pad(steps, 2)
        near = np.max(
            [around[:-4], around[1:-3], around[3:-1], around[4:]], axis=0
        )  # a quick motion takes several steps
        for t in s.time[1:][(steps > 30.0 * usual) & (steps > 5.0 * near)].tolist():
            times[t] = times.get(t, 0) + 1
    return sum(count > 0.6 * len(moved) for count in times.values())
