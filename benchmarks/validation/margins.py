"""Margin of the multibody car to a spin: other initial states, a small disturbance, higher speed."""

from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.shared.command import watched
from benchmarks.validation.drive import FITTED, JUDGED, LENGTH, Array, Spans
from benchmarks.validation.multibody import INTERVAL, LATERAL, YAW, in_windows, task_of
from hosts.compare.segment_fmu import SegmentFmu
from hosts.compare.segments import Segment
from hosts.compare.start_values import reference_point
from hosts.compare.task import Task

BESIDE = 0.5, 0.3, 0.024  # m/s along, m/s across, rad/s: errors of the car (docs/validation.md)
DISTURBANCE = 1e-3  # rad/s, of the initial yaw rate
FASTER = 1.05, 1.10, 1.15  # factors of the speed
COLUMNS = {
    "windows": "",
    "number": "d",
    "starts beside": "d",
    "departed": "d",
    "disturbance grows to": ".2f",
    "is after 10 s": ".1e",
    **{f"{100.0 * (f - 1.0):.0f} % faster": "d" for f in FASTER},
}
_SECONDS: dict[str, Spans] = {"fitted": FITTED, "others": JUDGED}
_SINCE = 0.1  # s after the start, from which the growth of the disturbance counts


def margins(car: str, log: Path, aliases: Path, settings: dict[str, float]) -> list[dict[str, Any]]:
    """Rows of `COLUMNS`, for windows that were fitted and for the others.

    `car`: argument of ``ali3 compare``. Initial states are the corners of a box about the measured state with half
    edges `BESIDE`, at the reference point of the car; a driver holds the measured speed, or `FASTER` times it.
    """
    rows = []
    for name, seconds in watched(list(_SECONDS.items())):
        task = task_of(car, log, aliases, settings, seconds)
        point, segments = reference_point(task.fmu, task.set_values), task.segments
        corners = [np.array(signs) * BESIDE for signs in product((-1.0, 1.0), repeat=3)]
        with closing(SegmentFmu(task.fmu, task.step)) as fmu:
            corner_runs = [_simulate(fmu, [with_offset(s, *corner, point) for s in segments]) for corner in corners]
            rates = [
                _simulate(fmu, [with_offset(s, 0.0, 0.0, rate, point) for s in segments])[1]
                for rate in (0.0, DISTURBANCE)
            ]
            fast_runs = [_simulate(fmu, [with_speed(s, factor) for s in segments]) for factor in FASTER]
        growth = np.abs(rates[1] - rates[0])[:, round(_SINCE / INTERVAL) :] / DISTURBANCE
        values = (len(segments), len(corners) * len(segments), sum(_departed(task, results) for results in corner_runs))
        values += (
            float(growth.max()),
            float(growth[:, -1].max()),
            *(_departed(task, results) for results in fast_runs),
        )
        rows.append({"windows": name} | dict(zip(list(COLUMNS)[1:], values, strict=True)))
    return rows


def with_offset(segment: Segment, along: float, across: float, rate: float, point: tuple[float, float]) -> Segment:
    """A segment with offsets of its initial velocities.

    `along`, `across`, `rate`: offsets at the reference point, m/s and rad/s; `point`: position of the reference point
    from the origin of the car, to which the start values refer, m.
    """
    offsets = {
        "initial.speed": along + rate * point[1],
        "initial.lateral_speed": across - rate * point[0],
        "initial.yaw_rate": rate,
    }
    start = segment.manoeuvre.start
    return _with_start(segment, {name: float(start[name]) + value for name, value in offsets.items()})


def with_speed(segment: Segment, factor: float) -> Segment:
    """A segment with its speed, at the start and held, multiplied by a factor."""
    assert segment.speed is not None
    speed = replace(segment.speed, values=factor * segment.speed.values)
    name = "initial.speed"
    return replace(_with_start(segment, {name: factor * float(segment.manoeuvre.start[name])}), speed=speed)


def _with_start(segment: Segment, start: dict[str, float]) -> Segment:
    return replace(segment, manoeuvre=replace(segment.manoeuvre, start={**segment.manoeuvre.start, **start}))


def _simulate(fmu: SegmentFmu, segments: Sequence[Segment]) -> tuple[Array, Array]:
    """Lateral velocity, m/s, and yaw rate, rad/s, in windows, shape (w, m) each; constant after a refused step."""
    at = INTERVAL * np.arange(round(LENGTH / INTERVAL) + 1)
    runs = [fmu.drive(segment) for segment in segments]
    across, turning = (np.array([np.interp(at, run.time, run[name]) for run in runs]) for name in (LATERAL, YAW))
    return across, turning


def _departed(task: Task, results: tuple[Array, Array]) -> int:
    """Number of departed windows by the criterion of ``ali3 compare``: errors above the range of the measured
    signal.
    """
    departed = np.zeros(len(task.segments), dtype=np.bool_)
    for name, values in zip((LATERAL, YAW), results, strict=True):
        signal = task.outputs[name]
        measured = in_windows(signal.time, signal.values, len(values))
        departed |= ~(np.abs(values - measured).max(axis=1) <= np.ptp(signal.values))
    return int(departed.sum())
