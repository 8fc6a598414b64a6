"""Start values of a car from the first samples of a log in motion."""

import math
from collections.abc import Callable, Collection, Mapping

import numpy as np

from hosts.common.numbers import Value
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.named_fmu import NamedFmu
from hosts.measures.signal import Signal

_AVERAGED = 0.1  # s at the beginning of a log
_WHERE = " (where the reference point is to be)"
_MOVES = 0.5  # m/s
_TURNS = 0.02  # rad/s
# s: roll of a car on soft springs and dampers has settled to 1 %
_SETTLING = "initial.settling"
_SETTLED = 2.0


def measured_start(
    fmu: NamedFmu,
    signals: Mapping[str, Signal],
    set_values: Mapping[str, Value],
    begun: Mapping[str, Value] | None = None,
) -> tuple[dict[str, Value], list[str]]:
    """Start values of speeds and pose as they are measured, where the FMU has such parameters.

    Parameters
    ----------
    fmu : NamedFmu
        Not initialised.
    signals : mapping of str to Signal
        Of the log, which begins at time 0.
    set_values : mapping of str to float, int, bool or str
        What the user sets, which wins.
    begun : mapping of str to float, int, bool or str, optional
        Start values of the run whose result the log is: then the start is as there, and not as measured.

    Returns
    -------
    start : dict
        What is set in addition to `set_values`.
    notes : list of str
        What the start is, in sentences.
    """
    if begun is not None:
        same = {
            n: v for n, v in begun.items() if n.startswith("initial.") and n in fmu.variables and n not in set_values
        }
        message = ", ".join(f"{n} = {v}" for n, v in same.items()) or "as drawn"
        return same, [f"The log is a result of ali3 run, and the start is that of its record: {message}."]
    start: dict[str, Value] = {}
    notes, unchanged = [], []
    speed = next((at_start(signals[n]) for n in ("speed", "chassis.vx") if n in signals), None)
    across, rate = (_of(signals, f"chassis.{n}") for n in ("vy", "wz"))
    for name, value in (
        ("initial.speed", speed),
        ("initial.yaw", _of(signals, "chassis.yaw")),
        ("initial.lateral_speed", across),
        ("initial.yaw_rate", rate),
        *((f"initial.{axis}", _of(signals, f"chassis.{axis}")) for axis in "xy"),
    ):
        if value is None or name not in fmu.variables:
            continue
        if name in set_values:
            unchanged.append(f"{name} = {float(set_values[name]):.4g} ({value:.4g} in the log)")
        else:
            start[name] = value
    if start:
        message = ", ".join(f"{n} = {v:.4g}" for n, v in start.items())
        notes.append(f"The start is as measured: {message}{_WHERE if 'initial.x' in start else ''}.")
    all_values = {**start, **set_values}
    moves = abs(float(all_values.get("initial.speed", 0.0))) > _MOVES and "initial.yaw_rate" in all_values
    if moves and _SETTLING in fmu.variables and _SETTLING not in set_values:
        start[_SETTLING] = _SETTLED
        notes.append(
            f"Before it the car is held in this motion for {_SETTLED:g} s ({_SETTLING}), so that roll, pitch, tyres "
            "and steering, which were not measured, have settled."
        )
    if unchanged:
        notes.append(f"The start is not as measured but as given: {', '.join(unchanged)}.")
    if speed is not None and abs(speed) > _MOVES and "initial.speed" not in (start | dict(set_values)):
        notes.append(
            f"The log begins at {speed:.3g} m/s; the FMU has no parameter initial.speed, and starts at its own "
            "speed. Let the log begin at rest (--from), or do not compare the first seconds (--skip)."
        )
    if speed is None and "initial.speed" in fmu.variables and "initial.speed" not in set_values:
        notes.append(
            "The log has no 'speed': the car starts at rest; if it moved, set it by --set initial.speed=VALUE."
        )
    if rate is not None and abs(rate) > _TURNS and "initial.yaw_rate" not in (start | dict(set_values)):
        notes.append(
            f"The log begins in a turn of {rate:.3g} rad/s; the FMU has no parameter initial.yaw_rate and "
            "starts straight: the first seconds differ (--from begins elsewhere, --skip leaves them out)."
        )
    return start, notes


def reference_point(fmu: FmuSource, start: Mapping[str, Value]) -> tuple[float, float]:
    """Where the reference point of the car at rest lies from the origin of its drawing, forward and to the left, m.

    `start`: start values; those of pose and speed are not used. Result: zero where the FMU does not provide its place.
    """
    return fmu.run_isolated(_reference_point, dict(start), tuple[float, float], start)


def _reference_point(task: tuple[FmuSource, dict[str, Value]], tell: Callable[[float], None]) -> tuple[float, float]:
    source, start = task
    with source.opened() as fmu:
        names = [f"chassis.{a}" for a in "xy"]
        if any(n not in fmu.variables for n in names):
            return 0.0, 0.0
        fmu.initialise({n: v for n, v in start.items() if not n.startswith("initial.")})
        values = np.empty(len(names))
        fmu.reader(names)(values)
    x, y = np.nan_to_num(values, posinf=0.0, neginf=0.0).tolist()
    return x, y


def of_origin(start: Mapping[str, Value], measured: Collection[str], point: tuple[float, float]) -> dict[str, Value]:
    """Start values of the origin of the car's drawing, from those that were measured of its reference point.

    `point`: of `reference_point`.
    """
    of_drawing = dict(start)
    yaw, rate = (float(start.get(f"initial.{n}", 0.0)) for n in ("yaw", "yaw_rate"))
    c, s = math.cos(yaw), math.sin(yaw)
    moved = {
        "initial.x": c * point[0] - s * point[1],
        "initial.y": s * point[0] + c * point[1],
        "initial.speed": -rate * point[1],
        "initial.lateral_speed": rate * point[0],
    }
    for name, by in moved.items():
        if name in measured:
            of_drawing[name] = float(start[name]) - by
    return of_drawing


def at_start(signal: Signal) -> float:
    """Value at time 0: of a line through the first samples, which noise moves little."""
    few = signal.time <= max(_AVERAGED, signal.time[0] + 4.5 * signal.interval)
    slope, value = np.polyfit(signal.time[few], signal.values[few], 1)
    value = value if math.isfinite(slope) else signal.values[0]
    return 0.0 if abs(value) < 1e-9 else float(value)  # rounding errors of the line


def _of(signals: Mapping[str, Signal], name: str) -> float | None:
    return at_start(signals[name]) if name in signals else None
