"""Relations between signals of a log: one quantity computed in two ways.

The values of a relation are the ratio of both, as speed times yaw rate over lateral acceleration, their correlation,
the delay of one behind the other, and the difference of their means.
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
MAX_WINDOWS = 4000  # windows of a log that are compared
MIN_VALUES = {"turn": 0.6, "accelerate": 0.3, "move": 2.0, "yaw": 0.03}
"""Smallest values that are evaluated, m/s2, m/s2, m/s, rad/s."""
STILL = {"chassis.ax": MIN_VALUES["accelerate"], "chassis.ay": MIN_VALUES["turn"], "chassis.wz": MIN_VALUES["yaw"]} | {
    "chassis.x": 0.5, "chassis.y": 0.5}  # fmt: skip
"""Standard deviations below which a car stands, m/s2, rad/s, m."""
SPINS = 2.0  # rad/s: speed from which a wheel rolls
COARSE = 0.1  # s: steps of delays in the first search
FINE = 0.02  # s: steps of delays in the second search
CLEAR = 0.03  # least increase of a correlation by a delay
LATEST = 1.0  # s: largest delay
QUANTITIES = quantities_of("log")
SPEEDS = ("speed", "chassis.vx")
WHEELS = tuple(f"wheel_{w}.omega" for w in wheels.WHEELS)
PATH = ("chassis.x", "chassis.y")
STEERING = "steering_wheel_angle"
RELATIONS: dict[str, dict[str, int]] = {
    "turn": {"speed": 1, "chassis.wz": 1, "chassis.ay": -1},
    "accelerate": {"speed": 1, "chassis.ax": -1, "time": -1},
    "heading": {"chassis.yaw": 1, "chassis.wz": -1, "time": -1},
    "way": {**dict.fromkeys(PATH, 1), "speed": -1, "time": -1},
    "course": {"chassis.wz": -1, **dict.fromkeys(PATH, 1)},
    "steer": {STEERING: -1, "chassis.wz": 1},
    "wheel": {"speed": 1, **dict.fromkeys(WHEELS, -1)},
}
"""Exponents of signals and times in the ratio of each relation; "speed" stands for either speed."""


def log_values(signals: Signals) -> list[Value]:
    """Values of the relations between signals, and the largest values of signals."""
    results: list[Value] = []
    speed_name = speed_of(signals)
    if speed_name is not None:
        results += [*_turn_values(signals, speed_name), *_steering_values(signals)]
        results += _rate_values(signals, "accelerate", signals[speed_name], "chassis.ax", MIN_VALUES["accelerate"])
        results += _path_values(signals, speed_name)
        if (path_direction := _path_direction(signals)) is not None:
            results += _rate_values(signals, "course", path_direction, "chassis.wz", MIN_VALUES["yaw"])
        for name in WHEELS:
            if name in signals:
                wheel_speed = interpolated(signals[name], signals[speed_name].time)
                is_moving = (np.abs(signals[speed_name].values) > MIN_VALUES["move"]) & (
                    wheel_speed != 0.0
                )  # a locked wheel has no radius
                if is_moving.sum() > 10:
                    radius = float(np.median(signals[speed_name].values[is_moving] / wheel_speed[is_moving]))
                    results.append(Value(QUANTITIES["wheel"], abs(radius), keys_of(signals, speed_name, name), name))
    if "chassis.yaw" in signals:
        yaw = signals["chassis.yaw"]
        results += _rate_values(
            signals, "heading", replace(yaw, values=np.unwrap(yaw.values)), "chassis.wz", MIN_VALUES["yaw"]
        )
    for key, name in (
        ("speed", speed_name or "speed"),
        ("ay", "chassis.ay"),
        ("ax", "chassis.ax"),
        ("yaw", "chassis.wz"),
    ):
        if name in signals and not (key == "speed" and _stands(signals)):
            quantile = 1.0 if key == "speed" else 0.99
            largest = float(np.quantile(np.abs(signals[name].values), quantile))
            results.append(Value(QUANTITIES[key], largest, keys_of(signals, name)))
    return results


def _stands(signals: Signals) -> bool:
    """Whether the signals beside the speed show that the car stands; False if there are none."""
    still = [float(np.std(signals[n].values)) < least for n, least in STILL.items() if n in signals]
    still += [float(np.abs(signals[n].values).max()) < SPINS for n in WHEELS if n in signals]
    return bool(still) and all(still)


def keys_of(signals: Signals, *names: str) -> dict[str, str]:
    """Names of the signals of a value, with their columns."""
    return {name: f"'{signals[name].source}'" for name in names if name in signals}


def interpolated(signal: Signal, time: Array) -> Array:
    """Values of a signal at other times, s, shape (n,)."""
    return np.asarray(np.interp(time, signal.time, signal.values))


def speed_of(signals: Signals) -> str | None:
    """Name of the speed of a log; None if it has none."""
    return next((n for n in SPEEDS if n in signals), None)


def _steering_values(signals: Signals) -> Iterator[Value]:
    """Correlation of the steering-wheel angle with the yaw rate."""
    if not {STEERING, "chassis.wz"} <= signals.keys():
        return
    wz = signals["chassis.wz"]
    angle = interpolated(signals[STEERING], wz.time)
    if np.std(wz.values) > MIN_VALUES["yaw"] and np.std(angle) > MIN_VALUES["yaw"]:
        correlation = _correlation(angle, wz.values)
        yield Value(QUANTITIES["steer_alike"], correlation, keys_of(signals, STEERING, "chassis.wz"))


def _turn_values(signals: Signals, speed_name: str) -> Iterator[Value]:
    """Speed times yaw rate against lateral acceleration."""
    if not {"chassis.wz", "chassis.ay"} <= signals.keys():
        return
    ay = signals["chassis.ay"]
    product = interpolated(signals[speed_name], ay.time) * interpolated(signals["chassis.wz"], ay.time)

    def delayed(delay: float) -> Array:
        return np.asarray(np.interp(ay.time + delay, ay.time, ay.values))

    yield from _relation_values(
        keys_of(signals, speed_name, "chassis.wz", "chassis.ay"), "turn", product, delayed, MIN_VALUES["turn"]
    )


def _path_direction(signals: Signals) -> Signal | None:
    """Direction of the path over half a window, rad; None without a path, or if the car does not move."""
    if not set(PATH) <= signals.keys():
        return None
    x, y = (signals[n] for n in PATH)
    begin, end = max(x.time[0], y.time[0]), min(x.time[-1], y.time[-1])
    if not 3.0 < (end - begin) / WINDOW < MAX_WINDOWS:
        return None
    t = np.arange(begin, end, 0.5 * WINDOW)
    dx, dy = (np.diff(interpolated(s, t)) for s in (x, y))
    is_moving = np.hypot(dx, dy) > MIN_VALUES["move"] * 0.5 * WINDOW
    if is_moving.sum() < len(t) - 1 or len(t) < 6:
        return None
    return Signal(x.name, x.source, "rad", t[:-1] + 0.25 * WINDOW, np.unwrap(np.arctan2(dy, dx)))


def _rate_values(signals: Signals, key: str, state: Signal, rate: str, least: float) -> Iterator[Value]:
    """Change of a state over windows against the mean of its rate."""
    if rate not in signals:
        return
    r = signals[rate]
    begin, end = max(state.time[0], r.time[0]), min(state.time[-1], r.time[-1])
    if end - begin < 5.0 * WINDOW:
        return
    starts = np.linspace(begin, end - WINDOW, min(int(2.0 * (end - begin) / WINDOW), MAX_WINDOWS))
    summed_rate = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(r.time) * (r.values[1:] + r.values[:-1]))])

    def change(at: Array, of: Array, delay: float = 0.0) -> Array:
        first, last = (np.interp(starts + delay + offset, at, of) for offset in (0.0, WINDOW))
        return np.asarray((last - first) / WINDOW)

    names = (*PATH, rate) if key == "course" else (state.name, rate)
    keys = keys_of(signals, *names) | {"time": "the times of the log"}
    changes = change(state.time, state.values)
    yield from _relation_values(keys, key, changes, lambda delay: change(r.time, summed_rate, delay), least)


def _relation_values(
    keys: Mapping[str, str], key: str, first: Array, delayed: Callable[[float], Array], least: float
) -> Iterator[Value]:
    """Ratio, correlation, offset and delay of a quantity computed in two ways.

    `first`: values by the first way, shape (n,); `delayed`: values by the second way, as a function of a delay that is
    removed, s.
    """
    second = delayed(0.0)
    first_spread, second_spread = float(np.std(first)), float(np.std(second))
    if max(first_spread, second_spread) < least or min(first_spread, second_spread) <= 0.0 or len(first) < 6:
        return
    values = {
        "": first_spread / second_spread,
        "_alike": _correlation(first, second),
        "_off": float(np.mean(first) - np.mean(second)),
        "_late": _delay(first, delayed),
    }
    for suffix, value in values.items():
        if (quantity := QUANTITIES.get(key + suffix)) is not None:
            yield Value(quantity, value, keys)


def _correlation(first: Array, second: Array) -> float:
    return float(np.corrcoef(first, second)[0, 1]) if np.std(second) > 0.0 else 0.0


def _delay(first: Array, delayed: Callable[[float], Array]) -> float:
    """Delay of the second signal behind the first, s; 0 if it is not significant."""
    undelayed, best = abs(_correlation(first, delayed(0.0))), 0.0
    for step, reach in ((COARSE, LATEST), (FINE, COARSE)):
        delays = best + np.arange(-reach, reach + 1e-9, step)
        correlations = [abs(_correlation(first, delayed(float(delay)))) for delay in delays]
        best, highest = float(delays[int(np.argmax(correlations))]), max(correlations)
    return best if highest > undelayed + CLEAR else 0.0


def _path_values(signals: Signals, speed_name: str) -> Iterator[Value]:
    if not set(PATH) <= signals.keys():
        return
    x = signals["chassis.x"]
    y, speed = interpolated(signals["chassis.y"], x.time), np.abs(interpolated(signals[speed_name], x.time))
    is_moving = 0.5 * (speed[1:] + speed[:-1]) > MIN_VALUES["move"]
    travelled = np.hypot(np.diff(x.values), np.diff(y))[is_moving].sum()
    distance = (0.5 * np.diff(x.time) * (speed[1:] + speed[:-1]))[is_moving].sum()
    if is_moving.sum() > 10 and distance > 0.0:
        keys = keys_of(signals, "chassis.x", "chassis.y", speed_name) | {"time": "the times of the log"}
        yield Value(QUANTITIES["way"], float(travelled / distance), keys)
