"""Thins the times of a recording, and computes the error of the motion interpolated between the remaining times."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

_MAX_SAMPLES = 200_000  # times at which poses are compared
_VISIBLE_DISTANCE = 1e-3  # of the size of the scene
_VISIBLE_ANGLE = np.radians(1.0)  # rad


def chosen_times(t: NDArray[np.float64], most: int, epoch: NDArray[np.float64]) -> NDArray[np.intp]:
    """Indices of at most `most` times: the first, the last, and the nearest to a uniform grid.

    Both sides of discontinuities are retained, unless they would be more than half of the times.

    `t`: times, not decreasing, s, shape (n,), with a discontinuity where a time occurs twice; `most`: 2 or more;
    `epoch`: shape (n,), with a discontinuity where it changes.
    """
    if len(t) <= most:
        return np.arange(len(t))
    indices_before = np.flatnonzero((t[1:] == t[:-1]) | (epoch[1:] != epoch[:-1]))
    jumps = np.union1d(indices_before, indices_before + 1)
    if len(jumps) > most // 2:
        jumps = jumps[:0]
    grid = np.linspace(t[0], t[-1], most - len(jumps))
    indices_after = np.clip(np.searchsorted(t, grid), 1, len(t) - 1)
    nearest = np.where(grid - t[indices_after - 1] < t[indices_after] - grid, indices_after - 1, indices_after)
    nearest[0], nearest[-1] = 0, len(t) - 1
    return np.union1d(nearest, jumps)


def interpolation_error_text(
    scene: Mapping[str, Any],
    t: NDArray[np.float64],
    columns: Mapping[str, NDArray[np.float64]],
    indices: NDArray[np.intp],
    epoch: NDArray[np.float64],
) -> str:
    """Text of the error of the motion that is interpolated between the retained times; empty if it is not visible.

    It is a sentence to append to another one, with a blank before it.

    Parameters
    ----------
    scene : mapping
        The scene that is drawn.
    t : array of shape (n,)
        All times, s.
    columns : mapping of str to array of shape (n,)
        Values at all times.
    indices : array of int
        Indices of the retained times.
    epoch : array of shape (n,)
        Number of each time that changes at a discontinuity, such as a rewind; between two retained times of different
        epochs the motion is not interpolated.
    """
    samples = np.unique(np.linspace(0, len(t) - 1, min(len(t), _MAX_SAMPLES)).astype(np.intp))
    intervals = np.clip(np.searchsorted(indices, samples, side="right") - 1, 0, len(indices) - 2)
    a, b = indices[intervals], indices[intervals + 1]
    durations = t[b] - t[a]
    fraction = np.divide(
        t[samples] - t[a], durations, out=np.zeros(len(samples)), where=(durations > 0.0) & (epoch[a] == epoch[b])
    )
    largest_distance, largest_angle, distance_frame, angle_frame = 0.0, 0.0, "", ""
    for name, frame in scene["frames"].items():
        distance, angle = _pose_errors(frame, columns, a, b, samples, fraction)
        if distance > largest_distance:
            largest_distance, distance_frame = distance, name
        if angle > largest_angle:
            largest_angle, angle_frame = angle, name
    notes = []
    if largest_distance > _VISIBLE_DISTANCE * scene["extent"]:
        notes.append(f"the place of {distance_frame!r} by up to {largest_distance:.2g} m")
    if largest_angle > _VISIBLE_ANGLE:
        notes.append(f"the direction of {angle_frame!r} by up to {np.degrees(largest_angle):.2g} deg")
    return f" Between them the drawing differs from the record: {', '.join(notes)}." if notes else ""


def _pose_errors(
    frame: Mapping[str, Any],
    columns: Mapping[str, NDArray[np.float64]],
    a: NDArray[np.intp],
    b: NDArray[np.intp],
    samples: NDArray[np.intp],
    fraction: NDArray[np.float64],
) -> tuple[float, float]:
    """Largest errors of the position, m, and angle, rad, of a frame interpolated between the times `a` and `b`.

    `a`, `b`, `samples`: indices of times, shape (n,); `fraction`: position between `a` and `b`, 0 to 1, shape (n,).
    """
    if "position" in frame:
        squared_distance = np.zeros(len(samples))
        for column in frame["position"]:
            x = columns[column]
            squared_distance += (x[samples] - (x[a] + fraction * (x[b] - x[a]))) ** 2
        q = np.stack([columns[column] for column in frame["quaternion"]])
        angle = _largest_angle_error(q[:, a], q[:, b], q[:, samples], fraction)
        return float(np.sqrt(_largest(squared_distance))), angle
    if "angle" not in frame and "way" not in frame:
        return 0.0, 0.0
    x = columns[frame.get("angle", frame.get("way"))]
    error = _largest(np.abs(x[samples] - (x[a] + fraction * (x[b] - x[a]))))
    return (error, 0.0) if "way" in frame else (0.0, error)


def _largest_angle_error(
    a: NDArray[np.float64], b: NDArray[np.float64], q: NDArray[np.float64], fraction: NDArray[np.float64]
) -> float:
    """Largest angle between `q` and the orientations interpolated from `a` to `b` by great arcs, rad.

    `a`, `b`, `q`: quaternions, shape (4, n); `fraction`: position between `a` and `b`, 0 to 1, shape (n,).
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        a, b, q = (x / np.linalg.norm(x, axis=0) for x in (a, b, q))
        dot = np.einsum("in,in->n", a, b)
        b = np.where(dot < 0.0, -b, b)
        half_angle = np.arccos(np.clip(np.abs(dot), 0.0, 1.0))
        small = half_angle < 1e-6
        sine = np.where(small, 1.0, np.sin(half_angle))
        weight_a = np.where(small, 1.0 - fraction, np.sin((1.0 - fraction) * half_angle) / sine)
        weight_b = np.where(small, fraction, np.sin(fraction * half_angle) / sine)
        interpolated = weight_a * a + weight_b * b
        interpolated /= np.linalg.norm(interpolated, axis=0)
        # The chord is more accurate than the arc cosine of a number near 1.
        chord = np.minimum(np.linalg.norm(interpolated - q, axis=0), np.linalg.norm(interpolated + q, axis=0))
        return _largest(4.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0)))


def _largest(values: NDArray[np.float64]) -> float:
    """Largest finite value, 0 or more."""
    finite_values = values[np.isfinite(values)]
    return float(finite_values.max(initial=0.0))
