"""Smooth functions of one variable for the surfaces of worlds."""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]


def equidistant(first: float, step: float, count: int) -> Float:
    """Return `count` equidistant numbers."""
    return np.asarray(first + step * np.arange(count), np.float64)


def rise(t: Float) -> Float:
    """Two parabolas, from 0 at t <= 0 to 1 at t >= 1: C1, with the least possible second derivative, 4."""
    t = np.clip(t, 0.0, 1.0)
    return np.where(t < 0.5, 2.0 * t * t, 1.0 - 2.0 * (1.0 - t) ** 2)


def soft_rise(t: Float) -> Float:
    """10 t³ - 15 t⁴ + 6 t⁵, from 0 at t <= 0 to 1 at t >= 1: C2."""
    t = np.clip(t, 0.0, 1.0)
    return np.asarray(t * t * t * (10.0 + t * (6.0 * t - 15.0)))


def vertical_curve(s: Float, vertices: Sequence[tuple[float, float]], roundings: Sequence[float]) -> Float:
    """Heights, m, of a line through vertices with a parabola at each; level before the first and behind the last.

    `s`: stations, m; `vertices`: rising station and height, m; `roundings`: length of the parabola at each vertex, m.
    """
    points = np.array(vertices, float)
    grades = np.concatenate([[0.0], np.diff(points[:, 1]) / np.diff(points[:, 0]), [0.0]])
    z = np.full(np.shape(s), points[0, 1])
    for station, change, length in zip(points[:, 0], np.diff(grades), roundings, strict=True):
        if change != 0.0:
            t = np.asarray(s) - station
            inside = np.clip(t + 0.5 * length, 0.0, length)
            z += change * (inside**2 / (2.0 * length) + np.maximum(t - 0.5 * length, 0.0))
    return np.asarray(z)


def steps(s: Float, vertices: Sequence[tuple[float, float]]) -> Float:
    """Values at stations: soft rises between vertices, constant outside.

    `s`: stations, m; `vertices`: rising station, m, and value.
    """
    value = np.full(np.shape(s), float(vertices[0][1]))
    for (a, before), (b, after) in itertools.pairwise(vertices):
        if after != before:
            value += (after - before) * soft_rise((np.asarray(s) - a) / (b - a))
    return np.asarray(value)


def plateau(u: Float, length: float, face: float) -> Float:
    """1 between 0 and `length`, 0 outside, with rises of length `face` at both ends."""
    return np.asarray(rise(u / face) * rise((length - u) / face))
