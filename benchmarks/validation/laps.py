"""Laps of a drive that repeats its path: distance along the track, length of a lap, pieces of the track."""

import numpy as np
from numpy.typing import NDArray

from benchmarks.validation.drive import Array, Drive

PIECE = 10.0  # m, length of a piece of the track
_MIN_LAP = 1000.0  # m, shortest lap
_MAX_LAP = 6000.0  # m, longest lap
_MIN_SPEED = 5.0  # m/s, least speed in the curvature of the path
_MIN_CORRELATION = 0.9  # of the curvatures of two laps
_NEARLY = 0.02  # largest difference from the best correlation


def distance_and_lap(drive: Drive) -> tuple[Array, float]:
    """Distance along the track at each sample, shape (n,), and lap length, m. Raises `ValueError` without laps."""
    distance = drive.interval * np.concatenate([[0.0], np.cumsum(0.5 * (drive.vx[1:] + drive.vx[:-1]))])
    return distance, _lap(distance, drive.yaw_rate / np.maximum(drive.vx, _MIN_SPEED))


def pieces(distance: Array, lap: float) -> NDArray[np.intp]:
    """Number of the lap piece of each sample, shape (n,). `distance`, `lap`: see `distance_and_lap`."""
    count = round(lap / PIECE)
    return np.asarray(((distance % lap) / lap * count).astype(np.intp) % count)


def _lap(distance: Array, curvature: Array) -> float:
    """Length of a lap, m: the shift with the largest autocorrelation of the path's curvature."""
    even = np.interp(np.arange(0.0, distance[-1]), distance, curvature)
    shifts = np.arange(int(_MIN_LAP), int(min(_MAX_LAP, distance[-1] - _MIN_LAP)))
    correlations = np.array([np.corrcoef(even[:-k], even[k:])[0, 1] for k in shifts])
    if not correlations.max() > _MIN_CORRELATION:
        raise ValueError(
            f"The drive does not repeat its path: the best correlation of its curvature is {correlations.max():.2f}."
        )
    near = np.flatnonzero(correlations > correlations.max() - _NEARLY)
    first = near[near <= near[0] + _MIN_LAP / 2.0]  # one lap, not several
    return float(shifts[first[np.argmax(correlations[first])]])
