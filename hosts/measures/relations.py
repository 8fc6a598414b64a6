"""Relations between signals of a log: one quantity computed in two ways, such as speed times yaw rate and lateral
acceleration of a rigid body.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace

import numpy as np

from ali3.plausibility import Value
from hosts.measures.agreement import Agreement, agreement, correlation
from hosts.measures.log_signals import (
    MIN_LATERAL_ACCELERATION,
    MIN_LONGITUDINAL_ACCELERATION,
    MIN_SPEED,
    MIN_YAW_RATE,
    PATH,
    QUANTITIES,
    STEERING,
    WHEELS,
    Array,
    Signals,
    columns_of,
    interpolated,
    speed_of,
    stands,
)
from hosts.measures.signal import Signal

_WINDOW = 1.0  # s over which rates are compared
_MAX_WINDOWS = 4000  # windows of a log that are compared
_MIN_SAMPLES = 10  # of a moving car
_TIMES = {"time": "the times of the log"}
_EXTREMES = {"speed": ("", 1.0), "ay": ("chassis.ay", 0.99), "ax": ("chassis.ax", 0.99), "yaw": ("chassis.wz", 0.99)}
"""By quantity: its signal (empty: the speed of the log), and the quantile of its magnitudes that is its largest one."""


@dataclass(frozen=True)
class Relation:
    """A relation and its values."""

    exponents: Mapping[str, int]
    """Exponents of signals and times in the ratio of both computations; "speed" stands for either speed."""
    values: Callable[[Signals, str], Iterator[Value]]
    """Function of the signals and of the name of the speed; yields nothing if the signals do not show it."""


def log_values(signals: Signals) -> list[Value]:
    """Values of the relations between signals, and the largest magnitudes of signals."""
    speed = speed_of(signals)
    if speed is None:
        related = [*_heading_values(signals, "")]
    else:
        related = [value for relation in RELATIONS.values() for value in relation.values(signals, speed)]
    return [*related, *_extreme_values(signals, speed)]


def _extreme_values(signals: Signals, speed: str | None) -> Iterator[Value]:
    """The largest magnitudes of signals; of a car that stands the speed has none."""
    for key, (signal, quantile) in _EXTREMES.items():
        name = signal or speed
        if name is None or name not in signals or (not signal and stands(signals)):
            continue
        largest = float(np.quantile(np.abs(signals[name].values), quantile))
        yield Value(QUANTITIES[key], largest, columns_of(signals, name))


def _relation_values(name: str, found: Agreement | None, columns: Mapping[str, str]) -> Iterator[Value]:
    """Those parts of an agreement that have a usual range. `name`: of the relation."""
    for part, value in {} if found is None else asdict(found).items():
        if (quantity := QUANTITIES.get(f"{name}.{part}")) is not None:
            yield Value(quantity, value, columns)


def _turn_values(signals: Signals, speed: str) -> Iterator[Value]:
    """Speed times yaw rate against lateral acceleration."""
    if not {"chassis.wz", "chassis.ay"} <= signals.keys():
        return
    ay = signals["chassis.ay"]
    product = interpolated(signals[speed], ay.time) * interpolated(signals["chassis.wz"], ay.time)
    found = agreement(product, lambda delay: interpolated(ay, ay.time + delay), MIN_LATERAL_ACCELERATION)
    yield from _relation_values("turn", found, columns_of(signals, speed, "chassis.wz", "chassis.ay"))


def _steering_values(signals: Signals, speed: str) -> Iterator[Value]:
    """Correlation of the steering-wheel angle with the yaw rate."""
    if not {STEERING, "chassis.wz"} <= signals.keys():
        return
    wz = signals["chassis.wz"]
    angle = interpolated(signals[STEERING], wz.time)
    if np.std(wz.values) > MIN_YAW_RATE and np.std(angle) > MIN_YAW_RATE:
        columns = columns_of(signals, STEERING, "chassis.wz")
        yield Value(QUANTITIES["steer.correlation"], correlation(angle, wz.values), columns)


def _acceleration_values(signals: Signals, speed: str) -> Iterator[Value]:
    """Change of the speed against longitudinal acceleration."""
    found = _agreement_of_rate(signals, signals[speed], "chassis.ax", MIN_LONGITUDINAL_ACCELERATION)
    yield from _relation_values("accelerate", found, columns_of(signals, speed, "chassis.ax") | _TIMES)


def _heading_values(signals: Signals, speed: str) -> Iterator[Value]:
    """Change of the heading against yaw rate."""
    if (yaw := signals.get("chassis.yaw")) is not None:
        heading = replace(yaw, values=np.unwrap(yaw.values))
        found = _agreement_of_rate(signals, heading, "chassis.wz", MIN_YAW_RATE)
        yield from _relation_values("heading", found, columns_of(signals, "chassis.yaw", "chassis.wz") | _TIMES)


def _course_values(signals: Signals, speed: str) -> Iterator[Value]:
    """Change of the direction of the path against yaw rate."""
    if (direction := _path_direction(signals)) is not None:
        found = _agreement_of_rate(signals, direction, "chassis.wz", MIN_YAW_RATE)
        yield from _relation_values("course", found, columns_of(signals, *PATH, "chassis.wz") | _TIMES)


def _distance_values(signals: Signals, speed: str) -> Iterator[Value]:
    """Length of the path against the integral of the speed, while the car moves."""
    if not set(PATH) <= signals.keys():
        return
    x = signals["chassis.x"]
    y, magnitude = interpolated(signals["chassis.y"], x.time), np.abs(interpolated(signals[speed], x.time))
    mean_speed = 0.5 * (magnitude[1:] + magnitude[:-1])
    is_moving = mean_speed > MIN_SPEED
    travelled = np.hypot(np.diff(x.values), np.diff(y))[is_moving].sum()
    distance = (np.diff(x.time) * mean_speed)[is_moving].sum()
    if is_moving.sum() > _MIN_SAMPLES and distance > 0.0:
        yield Value(QUANTITIES["way.ratio"], float(travelled / distance), columns_of(signals, *PATH, speed) | _TIMES)


def _wheel_values(signals: Signals, speed: str) -> Iterator[Value]:
    """Speed over the angular speed of each wheel: its rolling radius."""
    for name in WHEELS:
        if name not in signals:
            continue
        wheel_speed = interpolated(signals[name], signals[speed].time)
        # a locked wheel has no radius
        is_rolling = (np.abs(signals[speed].values) > MIN_SPEED) & (wheel_speed != 0.0)
        if is_rolling.sum() > _MIN_SAMPLES:
            radius = float(np.median(signals[speed].values[is_rolling] / wheel_speed[is_rolling]))
            yield Value(QUANTITIES["wheel.ratio"], abs(radius), columns_of(signals, speed, name), name)


def _path_direction(signals: Signals) -> Signal | None:
    """Direction of the path over half a window, rad; None without a path, or if the car does not always move."""
    if not set(PATH) <= signals.keys():
        return None
    x, y = (signals[n] for n in PATH)
    begin, end = max(x.time[0], y.time[0]), min(x.time[-1], y.time[-1])
    if not 3.0 < (end - begin) / _WINDOW < _MAX_WINDOWS:
        return None
    t = np.arange(begin, end, 0.5 * _WINDOW)
    dx, dy = (np.diff(interpolated(s, t)) for s in (x, y))
    is_moving = np.hypot(dx, dy) > MIN_SPEED * 0.5 * _WINDOW
    if not is_moving.all() or len(t) < 6:
        return None
    return Signal(x.name, x.source, "rad", t[:-1] + 0.25 * _WINDOW, np.unwrap(np.arctan2(dy, dx)))


def _agreement_of_rate(signals: Signals, state: Signal, rate: str, least: float) -> Agreement | None:
    """Change of a state over windows against the mean of its measured rate; None if they are not both in the log.

    `rate`: name of the signal of the rate; `least`: see `agreement`.
    """
    if rate not in signals:
        return None
    r = signals[rate]
    begin, end = max(state.time[0], r.time[0]), min(state.time[-1], r.time[-1])
    if end - begin < 5.0 * _WINDOW:
        return None
    starts = np.linspace(begin, end - _WINDOW, min(int(2.0 * (end - begin) / _WINDOW), _MAX_WINDOWS))
    integral = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(r.time) * (r.values[1:] + r.values[:-1]))])

    def mean_change(time: Array, values: Array, delay: float = 0.0) -> Array:
        first, last = (np.interp(starts + delay + offset, time, values) for offset in (0.0, _WINDOW))
        return np.asarray((last - first) / _WINDOW)

    return agreement(mean_change(state.time, state.values), lambda delay: mean_change(r.time, integral, delay), least)


RELATIONS: Mapping[str, Relation] = {
    "turn": Relation({"speed": 1, "chassis.wz": 1, "chassis.ay": -1}, _turn_values),
    "steer": Relation({STEERING: -1, "chassis.wz": 1}, _steering_values),
    "accelerate": Relation({"speed": 1, "chassis.ax": -1, "time": -1}, _acceleration_values),
    "way": Relation({**dict.fromkeys(PATH, 1), "speed": -1, "time": -1}, _distance_values),
    "course": Relation({"chassis.wz": -1, **dict.fromkeys(PATH, 1)}, _course_values),
    "wheel": Relation({"speed": 1, **dict.fromkeys(WHEELS, -1)}, _wheel_values),
    "heading": Relation({"chassis.yaw": 1, "chassis.wz": -1, "time": -1}, _heading_values),
}
"""Relations in the order of their values in the table of plausibility."""
