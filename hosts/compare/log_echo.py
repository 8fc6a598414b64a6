"""What was understood of a log: whether what belongs together by physics does, and whether its samples are a drive's.

A relation is the ratio of two ways to the same quantity, as speed times yaw rate over lateral acceleration, and their
correlation. A mistake in one signal moves all relations that it is in, so that it is named only where undoing it mends
them all.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.echo import Echo, Mistake, Value, echo_of, quantities_of
from hosts.compare.log import Log, Signal

Array: TypeAlias = NDArray[np.float64]
Signals: TypeAlias = Mapping[str, Signal]
WINDOW = 1.0  # s over which rates are compared
LEAST = {"turn": 0.6, "accelerate": 0.3, "move": 2.0, "yaw": 0.03}
"""m/s2, m/s2, m/s, rad/s: of less nothing is said."""
STILL = {"chassis.ax": LEAST["accelerate"], "chassis.ay": LEAST["turn"], "chassis.wz": LEAST["yaw"]} | {
    "chassis.x": 0.5, "chassis.y": 0.5}  # fmt: skip
"""m/s2, rad/s, m: spreads that are less are those of a car that stands."""
SPINS = 2.0  # rad/s: a wheel that is faster rolls
FEWEST_EQUAL = 10  # samples
MOVED = {"speed": 1.5, "ay": 1.0}
"""m/s, m/s2: of more than that a sensor tells something."""
FINE, CLEAR = 0.02, 0.03  # s between delays that are tried; gain of a correlation by one
LATEST = 1.0  # s: delay that is looked for
QUANTITIES = quantities_of("log")
SPEEDS = ("speed", "chassis.vx")
WHEELS = tuple(f"wheel_{w}.omega" for w in ("FL", "FR", "RL", "RR"))
_DEG = 180.0 / np.pi
FACTORS: dict[str, tuple[tuple[float, str], ...]] = {  # what undoes a mistake, by the signal's unit
    "m/s": ((1.0 / 3.6, "km/h in place of m/s"), (0.44704, "mph in place of m/s"), (3.6, "m/s taken for km/h")),
    "rad/s": (
        (1.0 / _DEG, "deg/s in place of rad/s"),
        (_DEG, "rad/s taken for deg/s"),
        (np.pi / 30.0, "rpm in place of rad/s"),
        (2.0 * np.pi, "turns per second in place of rad/s"),
    ),
    "m/s2": ((9.80665, "g in place of m/s2"), (1.0 / 9.80665, "m/s2 taken for g"), (1e-3, "mm/s2 in place of m/s2")),
    "rad": ((1.0 / _DEG, "degrees in place of radians"), (_DEG, "radians taken for degrees")),
    "m": ((1e-3, "mm in place of m"), (1e3, "km in place of m"), (0.3048, "feet in place of m")),
}
TIMES = (
    (2.0, "time twice as fast"),
    (0.5, "time half as fast"),
    (1e-3, "ms in place of s"),
    (60.0, "minutes in place of s"),
)
PAIRS = (("chassis.ax", "chassis.ay"), ("chassis.x", "chassis.y"), *pairwise(WHEELS))


def log_echo(what: str, signals: Signals) -> Echo:
    """What was understood of a log. `what`: its file; `signals`: by our names, in SI units."""

    def values(signals: Signals) -> list[Value]:
        return [*log_values(signals), *_of_samples(signals)]

    echo = Echo(what, [*values(signals), *_of_all(list(signals.values()))])
    if not echo.outside:  # nothing that a mistake would explain
        return echo
    undone = [Mistake(words, frozenset(keys), partial(values, altered)) for words, keys, altered in _undone(signals)]
    return replace(echo, mistakes=undone)


def consistent(echo: Echo) -> set[str]:
    """Names of signals that are in a relation, and all relations of which hold: no factor, no sign is wrong."""
    inside: dict[str, bool] = {}
    for value in echo.values:
        if value.quantity in _RELATIONS:
            for name in value.keys:
                inside[name] = inside.get(name, True) and value.inside(echo.kind)
    return {name for name, holds in inside.items() if holds}


_RELATIONS = [
    QUANTITIES[k]
    for k in ("turn", "turn_alike", "accelerate", "accelerate_alike", "way", "heading", "heading_alike", "wheel")
]


def log_values(signals: Signals) -> list[Value]:
    """Relations between signals, and how large each is."""
    found: list[Value] = []
    v = _speed(signals)
    if v is not None:
        found += _turning(signals)
        found += _ratio_of_rates(signals, "accelerate", v, "chassis.ax", LEAST["accelerate"])
        found += _way(signals, v)
        for name in WHEELS:
            if name in signals:
                spin = _on(signals[name], signals[v].time)
                moving = (np.abs(signals[v].values) > LEAST["move"]) & (spin != 0.0)  # one that is locked says nothing
                if moving.sum() > 10:
                    radius = float(np.median(signals[v].values[moving] / spin[moving]))
                    found.append(Value(QUANTITIES["wheel"], abs(radius), _keys(signals, v, name), name))
    found += _ratio_of_rates(signals, "heading", "chassis.yaw", "chassis.wz", LEAST["yaw"])
    for key, name in (("speed", v or "speed"), ("ay", "chassis.ay"), ("ax", "chassis.ax"), ("yaw", "chassis.wz")):
        if name in signals and not (key == "speed" and _stood(signals)):
            share = 1.0 if key == "speed" else 0.99
            largest = float(np.quantile(np.abs(signals[name].values), share))
            found.append(Value(QUANTITIES[key], largest, _keys(signals, name)))
    return found


def _stood(signals: Signals) -> bool:
    """Whether the signals beside the speed are those of a car that stands; False where there are none."""
    still = [float(np.std(signals[n].values)) < least for n, least in STILL.items() if n in signals]
    still += [float(np.abs(signals[n].values).max()) < SPINS for n in WHEELS if n in signals]
    return bool(still) and all(still)


def _keys(signals: Signals, *names: str) -> dict[str, str]:
    """What a value follows from, with the columns; time is in all that is a rate."""
    return {name: f"'{signals[name].source}'" for name in names if name in signals}


def _on(signal: Signal, time: Array) -> Array:
    return np.asarray(np.interp(time, signal.time, signal.values))


def _speed(signals: Signals) -> str | None:
    return next((n for n in SPEEDS if n in signals), None)


def _turn(signals: Signals) -> tuple[str, Signal, Array] | None:
    """Name of the speed, lateral acceleration, and at its times speed times yaw rate; None without one of them."""
    v = _speed(signals)
    if v is None or not {"chassis.wz", "chassis.ay"} <= signals.keys():
        return None
    ay = signals["chassis.ay"]
    return v, ay, _on(signals[v], ay.time) * _on(signals["chassis.wz"], ay.time)


def _turning(signals: Signals) -> Iterator[Value]:
    if (turn := _turn(signals)) is None:
        return
    v, ay, other = turn
    names = (v, "chassis.wz", "chassis.ay")
    found = list(_compared(signals, "turn", names, other, ay.values, LEAST["turn"]))
    yield from found
    if found:
        yield Value(QUANTITIES["turn_late"], _delay(ay, other), _keys(signals, *names))


def _delay(late: Signal, early: Array) -> float:
    """By how much a signal is behind values at its times, s; 0 where that is not clear."""
    if np.std(early) <= 0.0:
        return 0.0
    delays = np.arange(-LATEST, LATEST + 1e-9, FINE)
    alike = []
    for delay in delays:
        own = np.interp(late.time + delay, late.time, late.values)
        alike.append(abs(float(np.corrcoef(own, early)[0, 1])) if np.std(own) > 0.0 else 0.0)
    return float(delays[int(np.argmax(alike))]) if max(alike) > alike[len(delays) // 2] + CLEAR else 0.0


def _ratio_of_rates(signals: Signals, key: str, state: str, rate: str, least: float) -> Iterator[Value]:
    """Change of a state over windows against the mean of its rate."""
    if not {state, rate} <= signals.keys():
        return
    begin, end = (pick(signals[state].time[k], signals[rate].time[k]) for pick, k in ((max, 0), (min, -1)))
    if end - begin < 5.0 * WINDOW:
        return
    times = np.arange(begin, end, 0.5 * WINDOW)
    edges = times[:-2], times[2:]
    x = signals[state].values if key != "heading" else np.unwrap(signals[state].values)
    changes = np.interp(edges[1], signals[state].time, x) - np.interp(edges[0], signals[state].time, x)
    whole = np.concatenate(
        [[0.0], np.cumsum(0.5 * np.diff(signals[rate].time) * (signals[rate].values[1:] + signals[rate].values[:-1]))]
    )
    means = np.interp(edges[1], signals[rate].time, whole) - np.interp(edges[0], signals[rate].time, whole)
    yield from _compared(signals, key, (state, rate, "time"), changes / WINDOW, means / WINDOW, least)


def _compared(
    signals: Signals, key: str, names: Sequence[str], one: Array, other: Array, least: float
) -> Iterator[Value]:
    spread, there = float(np.std(one)), float(np.std(other))
    if max(spread, there) < least or min(spread, there) <= 0.0 or len(one) < 6:
        return
    keys = _keys(signals, *names) | ({"time": "the times of the log"} if "time" in names else {})
    yield Value(QUANTITIES[key], spread / there, keys)
    yield Value(QUANTITIES[f"{key}_alike"], float(np.corrcoef(one, other)[0, 1]), keys)


def _way(signals: Signals, v: str) -> Iterator[Value]:
    if not {"chassis.x", "chassis.y"} <= signals.keys():
        return
    x = signals["chassis.x"]
    y, speed = _on(signals["chassis.y"], x.time), np.abs(_on(signals[v], x.time))
    moving = 0.5 * (speed[1:] + speed[:-1]) > LEAST["move"]
    travelled, way = (
        np.hypot(np.diff(x.values), np.diff(y))[moving].sum(),
        (0.5 * np.diff(x.time) * (speed[1:] + speed[:-1]))[moving].sum(),
    )
    if moving.sum() > 10 and way > 0.0:
        keys = _keys(signals, "chassis.x", "chassis.y", v) | {"time": "the times of the log"}
        yield Value(QUANTITIES["way"], float(travelled / way), keys)


def _undone(signals: Signals) -> Iterator[tuple[str, set[str], Signals]]:
    """Words, names and the log without each common mistake."""
    for factor, words in TIMES:
        yield words, {"time"}, {n: replace(s, time=factor * s.time) for n, s in signals.items()}
    for name, signal in signals.items():
        if (far := _far(signal)).any():
            kept = replace(signal, time=signal.time[~far], values=signal.values[~far])
            value = f"{signal.values[far][0]:g} in the place of no value in '{signal.source}' ({name})"
            yield value, {name}, {**signals, name: kept}
    turn = _turn(signals)
    delay = 0.0 if turn is None else _delay(*turn[1:])
    for name in (*SPEEDS, "chassis.ax", "chassis.ay", "chassis.wz", "chassis.yaw", *WHEELS):
        if name not in signals:
            continue
        s = signals[name]
        for factor, words in (*FACTORS.get(s.unit, ()), (-1.0, "the other sign")):
            yield f"{words} of '{s.source}' ({name})", {name}, {**signals, name: replace(s, values=factor * s.values)}
        if delay and name in ("chassis.wz", "chassis.ay"):
            late = delay if name == "chassis.ay" else -delay
            words = f"a delay of {late:.2f} s (within {FINE:g} s) of '{s.source}' ({name})"
            yield words, {name}, {**signals, name: replace(s, time=s.time - late)}
    if "chassis.x" in signals and "chassis.y" in signals:
        for factor, words in FACTORS["m"]:
            both = {n: replace(signals[n], values=factor * signals[n].values) for n in ("chassis.x", "chassis.y")}
            yield f"{words} of the path", {"chassis.x", "chassis.y"}, {**signals, **both}
    for a, b in PAIRS:
        if a in signals and b in signals:
            swapped = {a: replace(signals[b], name=a), b: replace(signals[a], name=b)}
            yield f"'{signals[a].source}' and '{signals[b].source}' exchanged", {a, b}, {**signals, **swapped}


def _of_samples(signals: Signals) -> Iterator[Value]:
    """Stretches that stand, and values far from all others."""
    v = _speed(signals)
    for name, s in signals.items():
        yield Value(QUANTITIES["sentinel"], float(_far(s).sum()), _keys(signals, name), f"'{s.source}',")
        if v is not None and name in (*SPEEDS, "chassis.ax", "chassis.ay", "chassis.wz", *WHEELS):
            yield Value(QUANTITIES["stands"], _stands(s, signals, v), _keys(signals, name), f"'{s.source}',")


def _of_all(signals: Sequence[Signal]) -> Iterator[Value]:
    keys = {"rows": "all rows of the log"}
    yield Value(QUANTITIES["repeats"], float(_repeats(signals)), keys)
    yield Value(QUANTITIES["jumps"], float(_jumps(signals)), keys)


def _far(signal: Signal) -> NDArray[np.bool_]:
    """Which samples have the one value that lies farther from the others than ten times their range."""
    levels = np.unique(signal.values)
    for level, rest in ((levels[0], levels[1:]), (levels[-1], levels[:-1])):
        if len(rest) >= FEWEST_EQUAL and np.abs(level - rest).min() > 10.0 * np.ptp(rest) > 0.0:
            return np.asarray(signal.values == level)
    return np.zeros(len(signal.values), bool)


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
        return len(ax) > 0 and abs(float(ax.mean())) * long > MOVED["speed"]
    if signal.name in WHEELS:
        return len(speed) > 0 and float(np.ptp(speed)) > MOVED["speed"]
    if signal.name == "chassis.ax":
        return len(speed) > 0 and abs(float(speed[-1] - speed[0]) - value * long) > MOVED["speed"]
    if signal.name == "chassis.wz":
        return len(ay) > 0 and float(np.ptp(ay)) > MOVED["ay"]
    return len(wz) > 0 and len(speed) > 0 and float(np.ptp(wz)) * float(speed.mean()) > MOVED["ay"]


RUN = 30
"""Samples that are alike by chance in no drive."""


def _repeats(signals: Sequence[Signal]) -> int:
    """How many samples are those of an earlier stretch, one by one, in the signal that has the most values."""
    if not signals:
        return 0
    s = max(signals, key=lambda one: len(np.unique(one.values)))
    x = s.values
    if len(x) < 3 * RUN or len(np.unique(x)) < len(x) // 4:
        return 0
    where: dict[bytes, int] = {}
    most = 0
    for k in range(0, len(x) - RUN, RUN):
        where.setdefault(x[k : k + RUN].tobytes(), k)
    for k in range(RUN, len(x) - RUN + 1):
        first = where.get(x[k : k + RUN].tobytes())
        if first is not None and first + RUN <= k and len(np.unique(x[k : k + RUN])) > RUN // 2:
            most += RUN
    return min(most, len(x))


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


@echo_of.register
def _echo_of_log(log: Log) -> list[Echo]:
    return [log_echo("", log.outputs)]
