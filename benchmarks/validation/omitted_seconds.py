"""Kinds of seconds left out in turn: corners, ranges of speed and of longitudinal acceleration.

From the numbers of the fitted seconds a model is taken to where all seconds without a kind lead, to first order, and
judged on that kind: one step of Gauss and Newton (`hosts.compare.cross_validation`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.shared.command import watched
from benchmarks.validation.bank import PIECE, distance_and_lap, pieces
from benchmarks.validation.bicycle import Body, Model
from benchmarks.validation.drive import LENGTH, Array, Drive, Spans
from benchmarks.validation.fitting import SCALES, Windows, begins, fit
from benchmarks.validation.multibody import LATERAL, YAW, task_of
from benchmarks.validation.refit import read_ranges
from hosts.compare.cross_validation import Parts, left_out_residuals
from hosts.compare.fit_unknowns import fitted_parameters
from hosts.compare.replay import Replay
from hosts.compare.residuals import Residuals
from hosts.compare.segments import GAP
from hosts.driving.result import Result

Kinds = NDArray[np.intp]
CURVED = 1.0 / 250.0  # 1/m, least mean curvature of the path in a corner
SPEEDS = 5  # ranges of speed with equal times
ACCELERATIONS = -4.0, -1.0, 1.0, 3.0  # m/s2, limits of the ranges
COLUMNS = {
    "model": "",
    **{f"{family}, {what}": ".4f" for family in ("corners", "speed", "acceleration") for what in ("mean", "worst")},
    "worst kind": "",
}
_DIFFERENCE = 5e-3  # step of the one-sided difference quotients relative to the range of a parameter


@dataclass(frozen=True)
class Family:
    """A partition of the seconds into kinds, such as ranges of speed."""

    names: list[str]
    number: Kinds
    """Index of the kind of each sample, shape (n,); the index after the last name is not a kind."""


def families(drive: Drive) -> dict[str, Family]:
    """Corners by place, ranges of speed, ranges of longitudinal acceleration. Raises `ValueError` without laps."""
    distance, lap = distance_and_lap(drive)
    piece, count = pieces(distance, lap), round(lap / PIECE)
    curvature = np.bincount(piece, drive.yaw_rate / drive.vx, count) / np.maximum(
        np.bincount(piece, minlength=count), 1
    )
    side = np.where(np.abs(curvature) > CURVED, np.sign(curvature), 0.0)
    shift = int(np.flatnonzero(side == 0.0)[0])  # the lap is rotated to begin on a straight
    rotated_side = np.roll(side, -shift)
    first = np.flatnonzero((rotated_side != 0.0) & (rotated_side != np.roll(rotated_side, 1)))
    of_piece = np.where(rotated_side == 0.0, len(first), np.searchsorted(first, np.arange(count), side="right") - 1)
    corners = [f"corner at {PIECE * ((k + shift) % count):.0f} m" for k in first]
    speeds = np.quantile(drive.vx, np.linspace(0.0, 1.0, SPEEDS + 1))
    return {
        "corners": Family(corners, np.roll(of_piece, shift)[piece]),
        "speed": _ranges(drive.vx, speeds[1:-1], "m/s"),
        "acceleration": _ranges(drive.ax, ACCELERATIONS, "m/s² forward"),
    }


def _ranges(values: Array, edges: Sequence[float] | Array, unit: str) -> Family:
    ends = [f"{e:.3g}" for e in edges]
    names = [f"below {ends[0]}", *(f"{a} to {b}" for a, b in pairwise(ends)), f"above {ends[-1]}"]
    return Family([f"{n} {unit}" for n in names], np.searchsorted(edges, values))


def without_kinds(jacobian: Array, residual: Array, rows: Kinds, families: Mapping[str, Family]) -> dict[str, Any]:
    """Mean and largest yaw-rate error over the omitted kinds, rad/s, by the columns of `COLUMNS`.

    `jacobian`, `residual`: rows of yaw rate, then of lateral velocity in `SCALES`, shapes (2 m, p) and (2 m,); `rows`:
    indices of the samples of either, shape (m,).
    """
    row: dict[str, Any] = {}
    worst = []
    for name, family in families.items():
        number = family.number[rows]
        parts = Parts(np.tile(number, 2), np.arange(len(family.names) + 1.0), 1.0)
        yaw_rate_errors = left_out_residuals(jacobian, residual, parts)[: len(rows)] * SCALES[0]
        sizes = [float(np.sqrt(np.mean(yaw_rate_errors[number == k] ** 2))) for k in range(len(family.names))]
        row |= {f"{name}, mean": float(np.mean(sizes)), f"{name}, worst": max(sizes)}
        worst.append((max(sizes), family.names[int(np.argmax(sizes))]))
    return row | {"worst kind": max(worst)[1]}


def row_of_simple_model(model: Model, body: Body, drive: Drive, families: Mapping[str, Family]) -> dict[str, Any]:
    """Row of `COLUMNS` of a simple model."""
    numbers = fit(model, body, drive).numbers
    windows = Windows(model, body, drive, _all_seconds(drive), LENGTH)
    jacobian, residual = windows.jacobian(numbers), windows.residuals(numbers)
    return {"model": model.name} | without_kinds(jacobian, residual, windows.samples.ravel(), families)


def row_of_car(
    car: str,
    log: Path,
    aliases: Path,
    settings: dict[str, float],
    bounds: Path,
    drive: Drive,
    families: Mapping[str, Family],
) -> dict[str, Any]:
    """Row of `COLUMNS` of the multibody car: by the parameters that `refit` fits, from the values of its file."""
    ranges = read_ranges(bounds)
    task = task_of(car, log, aliases, settings, _all_seconds(drive))
    unknowns = fitted_parameters([f"{n}={span}" for n, span in ranges.items()], task.parameters, task.set_values)
    outputs = {name: task.outputs[name] for name in (YAW, LATERAL)}
    steps = np.array([_DIFFERENCE * (u.high - u.low) for u in unknowns])
    with Replay(task.fmu, task.segments, task.step) as replay:

        def simulate(values: Mapping[str, float]) -> Result | str:
            return replay.run(dict(values))

        residuals = Residuals(outputs, unknowns, dict(zip(outputs, SCALES, strict=True)), simulate, steps)
        p = np.array([u.start for u in unknowns])
        residual, jacobian = residuals(p), residuals.one_sided_jacobian(p)
    time = outputs[YAW].time
    window = np.floor((time + 0.5 * GAP) / (LENGTH + GAP)).astype(np.intp)
    first = begins(drive, _all_seconds(drive), LENGTH)
    rows = first[window] + np.round((time - window * (LENGTH + GAP)) / drive.interval).astype(np.intp)
    return {"model": "multibody car"} | without_kinds(jacobian, residual, rows, families)


def _all_seconds(drive: Drive) -> Spans:
    return ((0.0, float(drive.time[-1])),)


def rows_of(models: Sequence[Model], body: Body, drive: Drive, car: Sequence[Any]) -> list[dict[str, Any]]:
    """Rows of `COLUMNS`. `car`: the first five arguments of `row_of_car`."""
    result = families(drive)
    return [*(row_of_simple_model(m, body, drive, result) for m in watched(models)), row_of_car(*car, drive, result)]
