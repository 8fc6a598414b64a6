"""How near the multibody car is to a spin: starts beside the measured state, a small disturbance, more speed."""

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

BESIDE = 0.5, 0.3, 0.024  # m/s along, m/s across, rad/s: what the car may be off by (docs/validation.md)
DISTURBED = 1e-3  # rad/s, of the yaw rate at the start
FASTER = 1.05, 1.10, 1.15
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
_SINCE = 0.1  # s after the start, from which on a disturbance has grown


def margins(car: str, log: Path, aliases: Path, settings: dict[str, float]) -> list[dict[str, Any]]:
    """Rows of `COLUMNS`, for windows that were fitted and for the others.

    `car`: what ``ali3 compare`` takes. Starts are the corners of a box about the measured state, `BESIDE` to either
    side, at the reference point of the car; a driver holds the measured speed, or that times `FASTER`.
    """
    rows = []
    for name, seconds in watched(list(_SECONDS.items())):
        task = task_of(car, log, aliases, settings, seconds)
        point, segments = reference_point(task.fmu, task.set_values), task.segments
        corners = [np.array(signs) * BESIDE for signs in product((-1.0, 1.0), repeat=3)]
        with closing(SegmentFmu(task.fmu, task.step)) as fmu:
            beside = [_driven(fmu, [moved(s, *corner, point) for s in segments]) for corner in corners]
            rates = [_driven(fmu, [moved(s, 0.0, 0.0, rate, point) for s in segments])[1] for rate in (0.0, DISTURBED)]
            quick = [_driven(fmu, [quickened(s, factor) for s in segments]) for factor in FASTER]
        growth = np.abs(rates[1] - rates[0])[:, round(_SINCE / INTERVAL) :] / DISTURBED
        values = (len(segments), len(corners) * len(segments), sum(_departed(task, driven) for driven in beside))
        values += (float(growth.max()), float(growth[:, -1].max()), *(_departed(task, driven) for driven in quick))
        rows.append({"windows": name} | dict(zip(list(COLUMNS)[1:], values, strict=True)))
    return rows


def moved(segment: Segment, along: float, across: float, rate: float, point: tuple[float, float]) -> Segment:
    """A segment that starts beside its state.

    `along`, `across`, `rate`: m/s and rad/s, of the reference point; `point`: its place from the origin of the drawing,
    for which the start values hold, m.
    """
    by = {
        "initial.speed": along + rate * point[1],
        "initial.lateral_speed": across - rate * point[0],
        "initial.yaw_rate": rate,
    }
    start = segment.manoeuvre.start
    return _started(segment, {name: float(start[name]) + value for name, value in by.items()})


def quickened(segment: Segment, factor: float) -> Segment:
    """A segment with another speed, held and at the start, and the steering as it is."""
    assert segment.speed is not None
    speed = replace(segment.speed, values=factor * segment.speed.values)
    name = "initial.speed"
    return replace(_started(segment, {name: factor * float(segment.manoeuvre.start[name])}), speed=speed)


def _started(segment: Segment, start: dict[str, float]) -> Segment:
    return replace(segment, manoeuvre=replace(segment.manoeuvre, start={**segment.manoeuvre.start, **start}))


def _driven(fmu: SegmentFmu, segments: Sequence[Segment]) -> tuple[Array, Array]:
    """Lateral velocity and yaw rate in windows, each of shape (w, m); one that is refused keeps its last values."""
    at = INTERVAL * np.arange(round(LENGTH / INTERVAL) + 1)
    runs = [fmu.drive(segment) for segment in segments]
    across, turning = (np.array([np.interp(at, run.time, run[name]) for run in runs]) for name in (LATERAL, YAW))
    return across, turning


def _departed(task: Task, driven: tuple[Array, Array]) -> int:
    """How many windows have departed, as ``ali3 compare`` counts them: by more than the range of what was measured."""
    gone = np.zeros(len(task.segments), dtype=np.bool_)
    for name, values in zip((LATERAL, YAW), driven, strict=True):
        signal = task.outputs[name]
        measured = in_windows(signal.time, signal.values, len(values))
        gone |= ~(np.abs(values - measured).max(axis=1) <= np.ptp(signal.values))
    return int(gone.sum())
