"""Start values of a car from the first samples of a log in motion, and the initial pedal of its driver."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from hosts.common.numbers import Value
from hosts.compare.segment_fmu import SegmentFmu
from hosts.compare.segments import Segment
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.named_fmu import NamedFmu
from hosts.measures.signal import Signal

_AVERAGED = 0.1  # s at the start of a log
_AT_REFERENCE = " (where the reference point is to be)"
_MIN_SPEED = 0.5  # m/s
_MIN_YAW_RATE = 0.02  # rad/s
_SETTLING = "initial.settling"
_SETTLED = 2.0  # s, after which the roll of a car on soft springs and dampers has settled to 1 %
_DURATION = 0.5  # s from the start, after which the speed is met
_TOLERANCE = 0.005  # of the pedal


def start_values_of_log(
    fmu: NamedFmu,
    signals: Mapping[str, Signal],
    set_values: Mapping[str, Value],
    run_start: Mapping[str, Value] | None = None,
) -> tuple[dict[str, Value], list[str]]:
    """Start values of speeds and pose as measured, as far as the FMU has such parameters.

    Parameters
    ----------
    fmu : NamedFmu
        Not initialised.
    signals : mapping of str to Signal
        Of the log, which begins at time 0.
    set_values : mapping of str to float, int, bool or str
        Start values of the user, which take precedence.
    run_start : mapping of str to float, int, bool or str, optional
        Start values of the run whose result the log is; they take the place of measured ones.

    Returns
    -------
    start : dict
        Start values in addition to `set_values`.
    notes : list of str
        Sentences on the start.
    """
    if run_start is not None:
        return _start_values_of_run(fmu, run_start, set_values)
    start: dict[str, Value] = {}
    notes, overridden = [], []
    speed = next((value_at_start(signals[n]) for n in ("speed", "chassis.vx") if n in signals), None)
    lateral_speed, rate = (_value_at_start(signals, f"chassis.{n}") for n in ("vy", "wz"))
    for name, value in (
        ("initial.speed", speed),
        ("initial.yaw", _value_at_start(signals, "chassis.yaw")),
        ("initial.lateral_speed", lateral_speed),
        ("initial.yaw_rate", rate),
        *((f"initial.{axis}", _value_at_start(signals, f"chassis.{axis}")) for axis in "xy"),
    ):
        if value is None or name not in fmu.variables:
            continue
        if name in set_values:
            overridden.append(f"{name} = {float(set_values[name]):.4g} ({value:.4g} in the log)")
        else:
            start[name] = value
    if start:
        message = ", ".join(f"{n} = {v:.4g}" for n, v in start.items())
        notes.append(f"The start is as measured: {message}{_AT_REFERENCE if 'initial.x' in start else ''}.")
    all_values = {**start, **set_values}
    is_moving = abs(float(all_values.get("initial.speed", 0.0))) > _MIN_SPEED and "initial.yaw_rate" in all_values
    if is_moving and _SETTLING in fmu.variables and _SETTLING not in set_values:
        start[_SETTLING] = _SETTLED
        notes.append(
            f"Before it the car is held in this motion for {_SETTLED:g} s ({_SETTLING}), so that roll, pitch, tyres "
            "and steering, which were not measured, have settled."
        )
    if overridden:
        notes.append(f"The start is not as measured but as given: {', '.join(overridden)}.")
    return start, notes + _notes_on_missing_values(fmu, speed, rate, all_values)


def _start_values_of_run(
    fmu: NamedFmu, run_start: Mapping[str, Value], set_values: Mapping[str, Value]
) -> tuple[dict[str, Value], list[str]]:
    """Start values of the run whose result the log is, and a note."""
    names = [n for n in run_start if n.startswith("initial.") and n in fmu.variables and n not in set_values]
    message = ", ".join(f"{n} = {run_start[n]}" for n in names) or "as drawn"
    note = f"The log is a result of ali3 run, and the start is that of its record: {message}."
    return {n: run_start[n] for n in names}, [note]


def _notes_on_missing_values(
    fmu: NamedFmu, speed: float | None, rate: float | None, values: Mapping[str, Value]
) -> list[str]:
    """Notes on a measured speed, m/s, or yaw rate, rad/s, that is not a start value, and on a missing speed."""
    notes = []
    if speed is not None and abs(speed) > _MIN_SPEED and "initial.speed" not in values:
        notes.append(
            f"The log begins at {speed:.3g} m/s; the FMU has no parameter initial.speed, and starts at its own "
            "speed. Let the log begin at rest (--from), or do not compare the first seconds (--skip)."
        )
    if speed is None and "initial.speed" in fmu.variables and "initial.speed" not in values:
        notes.append(
            "The log has no 'speed': the car starts at rest; if it moved, set it by --set initial.speed=VALUE."
        )
    if rate is not None and abs(rate) > _MIN_YAW_RATE and "initial.yaw_rate" not in values:
        notes.append(
            f"The log begins in a turn of {rate:.3g} rad/s; the FMU has no parameter initial.yaw_rate and "
            "starts straight: the first seconds differ (--from begins elsewhere, --skip leaves them out)."
        )
    return notes


def reference_point(fmu: FmuSource, start: Mapping[str, Value]) -> tuple[float, float]:
    """Position of the reference point of the car at rest from the origin of its drawing, forward and to the left, m.

    `start`: start values; pose and speed are not used. Zero if the FMU does not provide the position.
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


def start_values_of_origin(
    start: Mapping[str, Value], measured: Collection[str], point: tuple[float, float]
) -> dict[str, Value]:
    """Start values of the origin of the car's drawing, from start values of its reference point.

    `measured`: names of values of the reference point; `point`: result of `reference_point`.
    """
    of_drawing = dict(start)
    yaw, rate = (float(start.get(f"initial.{n}", 0.0)) for n in ("yaw", "yaw_rate"))
    c, s = math.cos(yaw), math.sin(yaw)
    offsets = {
        "initial.x": c * point[0] - s * point[1],
        "initial.y": s * point[0] + c * point[1],
        "initial.speed": -rate * point[1],
        "initial.lateral_speed": rate * point[0],
    }
    for name, offset in offsets.items():
        if name in measured:
            of_drawing[name] = float(start[name]) - offset
    return of_drawing


def value_at_start(signal: Signal) -> float:
    """Value at time 0 of a regression line through the first samples."""
    first = signal.time <= max(_AVERAGED, signal.time[0] + 4.5 * signal.interval)
    slope, value = np.polyfit(signal.time[first], signal.values[first], 1)
    value = value if math.isfinite(slope) else signal.values[0]
    return 0.0 if abs(value) < 1e-9 else float(value)  # rounding errors of the line


def _value_at_start(signals: Mapping[str, Signal], name: str) -> float | None:
    return value_at_start(signals[name]) if name in signals else None


def starting_pedals(fmu: FmuSource, segments: Sequence[Segment], step: float) -> list[Segment]:
    """The segments with the constant pedals at which the FMU has the measured speed half a second after the start.

    `step`: communication step, s. A positive pedal is that of the throttle, a negative one that of the brake; 1 or -1
    where the measured speed is not reached.
    """
    pedals = fmu.run_isolated(_solve_pedals, (list(segments), step), list[float | None], {})
    return [s if pedal is None else _with_pedal(s, pedal) for s, pedal in zip(segments, pedals, strict=True)]


def _solve_pedals(
    task: tuple[FmuSource, tuple[list[Segment], float]], tell: Callable[[float], None]
) -> list[float | None]:
    source, (segments, step) = task
    fmu = SegmentFmu(source, step)
    try:
        return [None if s.speed is None else _solve_pedal(fmu, step, s, s.speed) for s in segments]
    finally:
        fmu.close()


def _with_pedal(segment: Segment, pedal: float) -> Segment:
    start = {**segment.manoeuvre.start, **_pedal_inputs(pedal)}
    return replace(segment, pedal=pedal, manoeuvre=replace(segment.manoeuvre, start=start))


def _pedal_inputs(pedal: float) -> dict[str, float]:
    return {"throttle": max(pedal, 0.0), "brake": max(-pedal, 0.0)}


def _solve_pedal(fmu: SegmentFmu, step: float, segment: Segment, speed: Signal) -> float:
    manoeuvre = replace(segment.manoeuvre, stop_time=max(step, min(_DURATION, segment.length)))
    short = Segment(manoeuvre)

    def excess(pedal: float) -> float:
        result = fmu.drive(short, _pedal_inputs(pedal))
        return float(result["speed"][-1] - np.interp(result.time[-1], speed.time, speed.values))

    coasting = excess(0.0)
    limit = -1.0 if coasting > 0.0 else 1.0
    if coasting == 0.0 or not coasting * excess(limit) < 0.0:
        return 0.0 if coasting == 0.0 else limit
    return float(brentq(excess, min(0.0, limit), max(0.0, limit), xtol=_TOLERANCE))
