"""Relations between signals of a log: the same quantity computed in two ways.

A relation is the ratio of two ways to the same quantity, as speed times yaw rate over lateral acceleration, their
correlation, the delay of one behind the other and the difference of their means.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.plausibility import Value, quantities_of
from hosts.common import wheels
from hosts.measures.signal import Signal

Array: TypeAlias = NDArray[np.float64]
Signals: TypeAlias = Mapping[str, Signal]
WINDOW = 1.0  # s over which rates are compared
MOST = 4000  # windows of a log that are compared
LEAST = {"turn": 0.6, "accelerate": 0.3, "move": 2.0, "yaw": 0.03}
"""m/s2, m/s2, m/s, rad/s: of less nothing is said."""
STILL = {"chassis.ax": LEAST["accelerate"], "chassis.ay": LEAST["turn"], "chassis.wz": LEAST["yaw"]} | {
    "chassis.x": 0.5, "chassis.y": 0.5}  # fmt: skip
"""m/s2, rad/s, m: spreads that are less are those of a car that stands."""
SPINS = 2.0  # rad/s: a wheel that is faster rolls
COARSE = 0.1  # s between delays that are tried first
FINE = 0.02  # s between delays that are tried then
CLEAR = 0.03  # least gain of a correlation by a delay
LATEST = 1.0  # s: delay that is looked for
QUANTITIES = quantities_of("log")
SPEEDS = ("speed", "chassis.vx")
WHEELS = tuple(f"wheel_{w}.omega" for w in wheels.WHEELS)
PATH = ("chassis.x", "chassis.y")
STEERING = "steering_wheel_angle"
RELATIONS: dict[str, dict[str, int]] = {  # exponents of signals and times in the ratio of a relation
    "turn": {"speed": 1, "chassis.wz": 1, "chassis.ay": -1},
    "accelerate": {"speed": 1, "chassis.ax": -1, "time": -1},
    "heading": {"chassis.yaw": 1, "chassis.wz": -1, "time": -1},
    "way": {**dict.fromkeys(PATH, 1), "speed": -1, "time": -1},
    "course": {"chassis.wz": -1, **dict.fromkeys(PATH, 1)},
    "steer": {STEERING: -1, "chassis.wz": 1},
    "wheel": {"speed": 1, **dict.fromkeys(WHEELS, -1)},
}
"""How the value of each relation follows from what is in it; "speed" stands for either speed."""


def log_values(signals: Signals) -> list[Value]:
    """Relations between signals, and how large each is."""
    results: list[Value] = []
    v = speed_of(signals)
    if v is not None:
        results += [*_turning(signals, v), *_steering(signals)]
        results += _rates(signals, "accelerate", signals[v], "chassis.ax", LEAST["accelerate"])
        results += _way(signals, v)
        if (direction := _direction(signals)) is not None:
            results += _rates(signals, "course", direction, "chassis.wz", LEAST["yaw"])
        for name in WHEELS:
            if name in signals:
                spin = on_times(signals[name], signals[v].time)
                moving = (np.abs(signals[v].values) > LEAST["move"]) & (spin != 0.0)  # one that is locked says nothing
                if moving.sum() > 10:
                    radius = float(np.median(signals[v].values[moving] / spin[moving]))
                    results.append(Value(QUANTITIES["wheel"], abs(radius), keys_of(signals, v, name), name))
    if "chassis.yaw" in signals:
        yaw = signals["chassis.yaw"]
        results += _rates(signals, "heading", replace(yaw, values=np.unwrap(yaw.values)), "chassis.wz", LEAST["yaw"])
    for key, name in (("speed", v or "speed"), ("ay", "chassis.ay"), ("ax", "chassis.ax"), ("yaw", "chassis.wz")):
        if name in signals and not (key == "speed" and _stood(signals)):
            share = 1.0 if key == "speed" else 0.99
            largest = float(np.quantile(np.abs(signals[name].values), share))
            results.append(Value(QUANTITIES[key], largest, keys_of(signals, name)))
    return results


def _stood(signals: Signals) -> bool:
    """Whether the signals beside the speed are those of a car that stands; False where there are none."""
    still = [float(np.std(signals[n].values)) < least for n, least in STILL.items() if n in signals]
    still += [float(np.abs(signals[n].values).max()) < SPINS for n in WHEELS if n in signals]
    return bool(still) and all(still)


def keys_of(signals: Signals, *names: str) -> dict[str, str]:
    """What a value follows from, with the columns; time is in all that is a rate."""
    return {name: f"'{signals[name].source}'" for name in names if name in signals}


def on_times(signal: Signal, time: Array) -> Array:
    """Values of a signal at other times, s."""
    return np.asarray(np.interp(time, signal.time, signal.values))


def speed_of(signals: Signals) -> str | None:
    """Name of the speed that a log has."""
    return next((n for n in SPEEDS if n in signals), None)


def _steering(signals: Signals) -> Iterator[Value]:
    """Whether the car turns to the side of the steering wheel."""
    if not {STEERING, "chassis.wz"} <= signals.keys():
        return
    wz = signals["chassis.wz"]
    angle = on_times(signals[STEERING], wz.time)
    if np.std(wz.values) > LEAST["yaw"] and np.std(angle) > LEAST["yaw"]:
        correlation = _alike(angle, wz.values)
        yield Value(QUANTITIES["steer_alike"], correlation, keys_of(signals, STEERING, "chassis.wz"))


def _turning(signals: Signals, v: str) -> Iterator[Value]:
    """Speed times yaw rate against lateral acceleration."""
    if not {"chassis.wz", "chassis.ay"} <= signals.keys():
        return
    ay = signals["chassis.ay"]
    product = on_times(signals[v], ay.time) * on_times(signals["chassis.wz"], ay.time)

    def late(delay: float) -> Array:
        return np.asarray(np.interp(ay.time + delay, ay.time, ay.values))

    yield from _compared(keys_of(signals, v, "chassis.wz", "chassis.ay"), "turn", product, late, LEAST["turn"])


def _direction(signals: Signals) -> Signal | None:
    """Of the path over half a window, rad, where the car moves; None without a path."""
    if not set(PATH) <= signals.keys():
        return None
    x, y = (signals[n] for n in PATH)
    begin, end = max(x.time[0], y.time[0]), min(x.time[-1], y.time[-1])
    if not 3.0 < (end - begin) / WINDOW < MOST:
        return None
    t = np.arange(begin, end, 0.5 * WINDOW)
    dx, dy = (np.diff(on_times(s, t)) for s in (x, y))
    moves = np.hypot(dx, dy) > LEAST["move"] * 0.5 * WINDOW
    if moves.sum() < len(t) - 1 or len(t) < 6:
        return None
    return Signal(x.name, x.source, "rad", t[:-1] + 0.25 * WINDOW, np.unwrap(np.arctan2(dy, dx)))


def _rates(signals: Signals, key: str, state: Signal, rate: str, least: float) -> Iterator[Value]:
    """Change of a state over windows against the mean of its rate."""
    if rate not in signals:
        return
    r = signals[rate]
    begin, end = max(state.time[0], r.time[0]), min(state.time[-1], r.time[-1])
    if end - begin < 5.0 * WINDOW:
        return
    starts = np.linspace(begin, end - WINDOW, min(int(2.0 * (end - begin) / WINDOW), MOST))
    summed_rate = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(r.time) * (r.values[1:] + r.values[:-1]))])

    def change(at: Array, of: Array, delay: float = 0.0) -> Array:
        ends = (np.interp(starts + delay + one, at, of) for one in (0.0, WINDOW))
        first, last = ends
        return np.asarray((last - first) / WINDOW)

    names = (*PATH, rate) if key == "course" else (state.name, rate)
    keys = keys_of(signals, *names) | {"time": "the times of the log"}
    changes = change(state.time, state.values)
    yield from _compared(keys, key, changes, lambda delay: change(r.time, summed_rate, delay), least)


def _compared(
    keys: Mapping[str, str], key: str, one: Array, late: Callable[[float], Array], least: float
) -> Iterator[Value]:
    """Ratio, correlation, offset and delay of two ways to one quantity. `late`: the other with a delay taken off, s."""
    other = late(0.0)
    spread, present = float(np.std(one)), float(np.std(other))
    if max(spread, present) < least or min(spread, present) <= 0.0 or len(one) < 6:
        return
    values = {
        "": spread / present,
        "_alike": _alike(one, other),
        "_off": float(np.mean(one) - np.mean(other)),
        "_late": _delay(one, late),
    }
    for suffix, value in values.items():
        if (quantity := QUANTITIES.get(key + suffix)) is not None:
            yield Value(quantity, value, keys)


def _alike(one: Array, other: Array) -> float:
    return float(np.corrcoef(one, other)[0, 1]) if np.std(other) > 0.0 else 0.0


def _delay(one: Array, late: Callable[[float], Array]) -> float:
    """By how much the other is behind, s; 0 where that is not clear."""
    without_delay, best = abs(_alike(one, late(0.0))), 0.0
    for step, reach in ((COARSE, LATEST), (FINE, COARSE)):
        delays = best + np.arange(-reach, reach + 1e-9, step)
        correlations = [abs(_alike(one, late(float(delay)))) for delay in delays]
        best, highest = float(delays[int(np.argmax(correlations))]), max(correlations)
    return best if highest > without_delay + CLEAR else 0.0


def _way(signals: Signals, v: str) -> Iterator[Value]:
    if not set(PATH) <= signals.keys():
        return
    x = signals["chassis.x"]
    y, speed = on_times(signals["chassis.y"], x.time), np.abs(on_times(signals[v], x.time))
    moving = 0.5 * (speed[1:] + speed[:-1]) > LEAST["move"]
    travelled, distance = (
        np.hypot(np.diff(x.values), np.diff(y))[moving].sum(),
        (0.5 * np.diff(x.time) * (speed[1:] + speed[:-1]))[moving].sum(),
    )
    if moving.sum() > 10 and distance > 0.0:
        keys = keys_of(signals, "chassis.x", "chassis.y", v) | {"time": "the times of the log"}
        yield Value(QUANTITIES["way"], float(travelled / distance), keys)
