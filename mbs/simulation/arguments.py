"""Checks of the arguments of a run: each function returns the converted value or raises an error."""

import math
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.checks import array, flag, instance_of, is_finite, is_number, mapping, number, shown
from mbs.kernel.header.enumerations import Status
from mbs.results.accuracy import AccuracyWarning
from mbs.results.simulation_error import PoseError
from mbs.settings.settings import Settings
from mbs.settings.tolerance import Tolerance, check_tolerance
from mbs.simulation.prepared_system import length_of, prepared
from mbs.simulation.state import Pose
from mbs.system.system import System

LATEST = 1e10
"""Largest absolute time, s; there double precision resolves two microseconds."""
MIN_STEP = 1e3
"""Shortest step in units of the round-off of the time."""
MAX_VALUES = 10**9
"""Largest number of values that one run may record: 8 gigabytes."""
MAX_ESTIMATE_COST = 1e6
"""Largest number for `estimate_error`, in runs."""
INTERVALS = 200
"""Number of intervals of a record to a tolerance for which the caller gives none."""
MAX_OMITTED_FRACTION = 0.01
"""Largest fraction of a run that equal steps may omit at its end without a warning."""


def check_step(h: float) -> float:
    """Return the step h, s; raise `ValueError` unless it is positive and finite."""
    if not is_number(h):
        raise ValueError(f"The step h must be a number of seconds, not {shown(h)}.")
    if not (is_finite(h) and h > 0.0):
        raise ValueError(f"The step h is {shown(h)} s; it must be positive and finite.")
    return float(h)


def check_time(t: float, subject: str) -> float:
    """Return a time, s; raise `ValueError` unless it is a number within `LATEST`. `subject`: begins the message."""
    time = number(t, subject, ValueError)
    if abs(time) > LATEST:
        raise ValueError(f"{subject} is {time:g} s; it must lie within {LATEST:g} s of zero, where round-off is small.")
    return time


def check_end(t0: float, t_end: float) -> float:
    """Return the end of a run, s; raise `ValueError` if it is before the start `t0`, s."""
    if not is_number(t_end):
        raise ValueError(f"The end t_end must be a number of seconds, not {shown(t_end)}.")
    if not (is_finite(t_end) and t_end >= t0):
        raise ValueError(f"The end t_end is {shown(t_end)} s; it must be finite and not before {t0:g} s.")
    return check_time(t_end, "The end t_end")


def check_estimate(value: object) -> bool | float | None:
    """Return `estimate_error` of `simulate`: a flag, None or a largest cost; raise `ValueError` for anything else."""
    cost = float(value) if is_finite(value) else 0.0  # type: ignore[arg-type]
    if 0.0 < cost <= MAX_ESTIMATE_COST:
        return cost
    if value is not None and not isinstance(value, (bool, np.bool_)):
        raise ValueError(
            f"estimate_error = {shown(value)}; it must be True, False or None (suspects only), or a number above 0, up "
            f"to {MAX_ESTIMATE_COST:g}: what refined runs may cost, in runs."
        )
    return None if value is None else bool(value)


def check_every(every: int) -> int:
    """Return the interval of the record, in steps; raise `ValueError` unless it is a positive whole number."""
    if not is_finite(every) or int(every) != every or not 1 <= every <= MAX_VALUES:
        raise ValueError(
            f"every = {shown(every)}; it must be at least 1, a whole number of steps up to {MAX_VALUES:g}."
        )
    return int(every)


def check_resolution(t: float, h: float) -> None:
    """Raise `ValueError` for a step `h`, s, that is lost in the round-off of the time `t`, s."""
    min_step = MIN_STEP * math.ulp(t)
    if h < min_step:
        raise ValueError(
            f"At t = {t:g} s a step of {h:g} s is lost in the round-off of the time; start nearer to zero or take a "
            f"step above {min_step:.1g} s."
        )


def count_steps(t0: float, t_end: float, h: float) -> int:
    """Number of whole steps of `h` from `t0` to `t_end`, s, up to round-off, also that of numbers of 32 bits.

    Raises `ValueError` if the end is before the start, or the step is longer than the run or lost in the round-off of
    the time.
    """
    end = check_end(t0, t_end)
    steps = math.floor((end - t0) / h * (1.0 + 1e-7) + 1e-6)
    if steps == 0 and end > t0:
        raise ValueError(f"The step h is {h:g} s, longer than the run of {end - t0:g} s; take a shorter step.")
    if steps:
        check_resolution(max(abs(t0), abs(end)), h)
    return steps


def warn_of_end(t0: float, t_end: float, h: float) -> None:
    """Warn, for the caller's caller, if whole steps omit more than `MAX_OMITTED_FRACTION` of the run at its end."""
    covered, duration = count_steps(t0, t_end, h) * h, t_end - t0
    if duration - covered > MAX_OMITTED_FRACTION * duration + 1e-6 * h:
        warnings.warn(
            f"The run ends at {t0 + covered:g} s, a whole number of steps of {h:g} s, instead of {t_end:g} s; h = "
            f"{duration / math.ceil(duration / h):.9g} ends there.",
            AccuracyWarning,
            stacklevel=3,
        )


def check_record(samples: int, sensors: int) -> None:
    """Raise `ValueError` for a record of more than `MAX_VALUES` values."""
    if samples * max(sensors, 1) > MAX_VALUES:
        raise ValueError(
            f"The run would record {samples:.3g} samples of {sensors} sensors, more than {MAX_VALUES:g} values; "
            "record less often (every), take longer steps or an earlier end (t_end)."
        )


def check_system(system: System, subject: str) -> System:
    """Return a System; raise `ArgumentTypeError` for any other object. `subject`: begins the message."""
    return instance_of(System, system, subject, "a System, which compile(model) makes")


def check_settings(settings: Settings | None) -> Settings:
    """Return the settings, by default the kernel's."""
    return Settings() if settings is None else instance_of(Settings, settings, "The settings", "Settings(...)")


def check_pose(pose: Pose | None, meta: Mapping[str, Any]) -> Pose | None:
    """Return the pose; raise `PoseError` if joints tie the System to the ground. `meta`: `System.meta`."""
    if pose is None:
        return None
    instance_of(Pose, pose, "The pose", "a Pose(...)")
    if not meta.get("floating", True):
        raise PoseError(
            f"The starting {pose} was refused: the System {meta['name']!r} takes none, its joints tie it to the "
            "ground. Leave the pose out, or declare the model floating (model.floating = True) where nothing but roads "
            "holds it.",
            0.0,
            Status.BAD_ARGUMENT,
        )
    return pose


def check_values(values: Mapping[str, Any] | None, subject: str) -> Mapping[str, Any]:
    """Return values by name; None stands for an empty mapping. `subject`: begins the message."""
    return mapping(values, subject, "names to values")


def check_progress(progress: bool | Callable[[float], None] | None) -> None:
    """Raise `ValueError` for an argument that is neither a flag, None nor a function."""
    if progress is not None and not callable(progress):
        flag(progress, "The progress", ValueError)


def record_times(t0: float, t_end: float, h: float | None, every: int, times: ArrayLike | None) -> NDArray[np.float64]:
    """Instants of the record, s, shape (n,), beginning with `t0`; `h`, `every` and `times` as in `simulate`."""
    check_end(t0, t_end)
    if times is not None and h is not None:
        raise ValueError("Both times and h are given; one of them says where to record.")
    if times is None:
        if t_end == t0:
            return np.array([t0])
        interval = (t_end - t0) / INTERVALS if h is None else h * every
        samples = count_steps(t0, t_end, interval) + 1
        check_record(samples, 1)
        return t0 + interval * np.arange(samples, dtype=float)
    instants = array(times, (None,), "the times", ValueError, "finite numbers that ascend")
    if not len(instants) or not np.all(np.diff(instants) > 0.0):
        raise ValueError(f"The times must be finite numbers that ascend, not {shown(times)}.")
    if not (instants[0] >= t0 and instants[-1] <= t_end):
        raise ValueError(
            f"The times must lie between {t0:g} and {t_end:g} s; they go from {instants[0]:g} to {instants[-1]:g}."
        )
    return np.concatenate([[t0], instants[instants > t0]])


def requested_tolerance(system: System, tolerance: object) -> Tolerance:
    """Return the tolerance of a run of the System; raise `ValueError` if it is not valid."""
    sensors = prepared(system).meta["sensors"]
    units = {sensor["name"]: sensor["unit"] for sensor in sensors if sensor.get("computed", True)}
    return check_tolerance(tolerance, units, length_of(system))


def check_tolerance_settings(settings: Settings) -> None:
    """Raise `ValueError` for settings that cannot keep a tolerance."""
    if settings.step_iterations > 0:
        raise ValueError(
            f"step_iterations = {settings.step_iterations} with a tolerance: steps that are accepted as they are keep "
            "none; give a step h, or leave the limit out."
        )
