"""Thins the times of a recording, and measures the error of the motion interpolated between the remaining ones."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

_LOOKED_AT = 200_000  # times that the poses are compared at
_FAR = 1e-3  # of the size of the scene: what a reader would see
_TURNED = np.radians(1.0)


def chosen_times(t: NDArray[np.float64], most: int, epoch: NDArray[np.float64]) -> NDArray[np.intp]:
    """Indices of at most so many times, the nearest to a uniform grid; the first and the last are among them.

    Both sides of a step are kept too, unless steps alone would be more than half of the times: between them nothing
    moves, the values jump.

    `t`: in s, not decreasing, shape (n,); a time that stands twice is a step; `most`: 2 or more; `epoch`: shape (n,);
    where it changes is a step.
    """
    if len(t) <= most:
        return np.arange(len(t))
    before = np.flatnonzero((t[1:] == t[:-1]) | (epoch[1:] != epoch[:-1]))
    steps = np.union1d(before, before + 1)
    if len(steps) > most // 2:
        steps = steps[:0]
    grid = np.linspace(t[0], t[-1], most - len(steps))
    after = np.clip(np.searchsorted(t, grid), 1, len(t) - 1)
    nearest = np.where(grid - t[after - 1] < t[after] - grid, after - 1, after)
    nearest[0], nearest[-1] = 0, len(t) - 1
    return np.union1d(nearest, steps)


def largest_gap_of_motion(
    scene: Mapping[str, Any],
    t: NDArray[np.float64],
    columns: Mapping[str, NDArray[np.float64]],
    kept: NDArray[np.intp],
    epoch: NDArray[np.float64],
) -> str:
    """A sentence on how far the motion between the kept times is from the recorded one; empty if nobody would see it.

    Parameters
    ----------
    scene : mapping
        That is drawn.
    t : array of shape (n,)
        All times, s.
    columns : mapping of str to array of shape (n,)
        All values.
    kept : array of int
        Indices of the times that are kept.
    epoch : array of shape (n,)
        Where it changes between two kept times, the drawing stands still.
    """
    looked = np.unique(np.linspace(0, len(t) - 1, min(len(t), _LOOKED_AT)).astype(np.intp))
    left = np.clip(np.searchsorted(kept, looked, side="right") - 1, 0, len(kept) - 2)
    a, b = kept[left], kept[left + 1]
    step = t[b] - t[a]
    share = np.divide(t[looked] - t[a], step, out=np.zeros(len(looked)), where=(step > 0.0) & (epoch[a] == epoch[b]))
    far, turned, moves, turns = 0.0, 0.0, "", ""
    for name, frame in scene["frames"].items():
        if "position" in frame:
            square = np.zeros(len(looked))
            for column in frame["position"]:
                x = columns[column]
                square += (x[looked] - (x[a] + share * (x[b] - x[a]))) ** 2
            off = float(np.sqrt(_largest(square)))
            far, moves = (off, name) if off > far else (far, moves)
            q = np.stack([columns[column] for column in frame["quaternion"]])
            angle = _turn_off(q[:, a], q[:, b], q[:, looked], share)
        elif "angle" in frame or "way" in frame:
            x = columns[frame.get("angle", frame.get("way"))]
            angle = off = _largest(np.abs(x[looked] - (x[a] + share * (x[b] - x[a]))))
            if "way" in frame:
                angle = 0.0
                far, moves = (off, name) if off > far else (far, moves)
        else:
            continue
        turned, turns = (angle, name) if angle > turned else (turned, turns)
    notes = []
    if far > _FAR * scene["extent"]:
        notes.append(f"the place of {moves!r} by up to {far:.2g} m")
    if turned > _TURNED:
        notes.append(f"the direction of {turns!r} by up to {np.degrees(turned):.2g} deg")
    return f" Between them the drawing differs from the record: {', '.join(notes)}." if notes else ""


def _turn_off(
    a: NDArray[np.float64], b: NDArray[np.float64], q: NDArray[np.float64], share: NDArray[np.float64]
) -> float:
    """Largest angle between recorded orientations and those interpolated by great arcs, rad."""
    with np.errstate(invalid="ignore", divide="ignore"):
        a, b, q = (x / np.linalg.norm(x, axis=0) for x in (a, b, q))
        dot = np.einsum("in,in->n", a, b)
        b = np.where(dot < 0.0, -b, b)
        half = np.arccos(np.clip(np.abs(dot), 0.0, 1.0))
        small = half < 1e-6
        sine = np.where(small, 1.0, np.sin(half))
        first = np.where(small, 1.0 - share, np.sin((1.0 - share) * half) / sine)
        second = np.where(small, share, np.sin(share * half) / sine)
        between = first * a + second * b
        between /= np.linalg.norm(between, axis=0)
        # The chord keeps what the arc cosine of a number near 1 loses.
        chord = np.minimum(np.linalg.norm(between - q, axis=0), np.linalg.norm(between + q, axis=0))
        return _largest(4.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0)))


def _largest(values: NDArray[np.float64]) -> float:
    good = values[np.isfinite(values)]
    return float(good.max(initial=0.0))
