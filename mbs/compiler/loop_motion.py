"""Motion of a block of closed loops with one degree of freedom, traced once around by a predictor-corrector method.

At a singular position the predictor follows the smooth branch.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesv

from mbs.compiler.block_rows import Quadratics

Array = NDArray[np.float64]

MAX_TURN = 0.14
"""Largest turn of an angle in one step, rad."""
MAX_STEPS = 1000
RANK_TOLERANCE = 1e-6
"""Singular values below this part of the largest count as zero."""
CROSSING = 0.05
"""A branch crosses if the second smallest singular value is below this part of its median along the motion."""
ROW_TOLERANCE = 1e-7
"""Largest error of the rows, parts of the size of the block."""


@dataclass(frozen=True)
class BlockMotion:
    """Sines and cosines of the angles, shape (steps + 1, angles), their changes in each step, shape (steps, angles),
    rad, and whether a branch crosses.
    """

    sines: Array
    cosines: Array
    steps: Array
    branches: bool


def sine_cosine(vectors: Array, turned: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Sine and cosine of the angle from b to c seen along n; `vectors`: n, b, c, shape (angles, 3, 3)."""
    products = vectors @ vectors.transpose(0, 2, 1)
    nn, nb, nc, bc = products[:, 0, 0], products[:, 0, 1], products[:, 0, 2], products[:, 1, 2]
    sine = np.sqrt(nn) * np.linalg.det(vectors)
    cosine = nn * bc - nb * nc  # (n x b) . (n x c)
    size = np.maximum(np.hypot(sine, cosine), 1e-300)
    sine, cosine = sine / size, cosine / size
    return np.where(turned, cosine, sine), np.where(turned, -sine, cosine)


def trace(phi: Quadratics, offset: Array, slope: Array, turned: NDArray[np.bool_], x: Array) -> BlockMotion | None:
    """Follow the motion from x until it returns; None if it has not one degree of freedom or does not return.

    `offset`, `slope`: the vectors n, b, c of the angles are ``offset + slope x``; `turned`: whether an angle is
    measured from the perpendicular of c.
    """

    def angles(position: Array) -> tuple[Array, Array]:
        return sine_cosine((offset + slope @ position).reshape(-1, 3, 3), turned)

    direction = _first_direction(phi.at(x)[1], slope)
    if direction is None:
        return None
    vectors = (offset + slope @ x).reshape(-1, 3, 3)
    size = float(np.max(np.linalg.norm(vectors[:, 1], axis=1)))  # of the longest arm
    first, t_first, t, step, travelled = x, direction, direction, 0.05 * size, 0.0
    sine, cosine = angles(x)
    sines, cosines, steps, second_values = [sine], [cosine], [], []
    for _ in range(MAX_STEPS):
        corrected = _correct(phi, x + step * t, t, ROW_TOLERANCE * size)
        if corrected is not None:
            y, J = corrected
            s, c = angles(y)
            turn = np.arctan2(s * cosine - c * sine, c * cosine + s * sine)
            largest = float(abs(turn).max())
        if corrected is None or largest > MAX_TURN:
            step *= 0.5
            if step < 1e-6 * size:
                return None
            continue
        chord = y - x
        length = math.sqrt(chord @ chord)
        new = _next_direction(J, chord / length)
        if new is None:
            return None
        sines.append(s)
        cosines.append(c)
        steps.append(turn)
        second_values.append(new[1])
        along = float((first - x) @ chord) / length**2
        may_close = travelled > 2.0 * length and 0.0 <= along <= 1.0 and t @ t_first > 0.0
        if may_close and np.linalg.norm(first - x - along * chord) < 0.3 * length:
            crossed = bool(np.min(second_values) < CROSSING * np.median(second_values))
            return BlockMotion(np.array(sines), np.array(cosines), np.array(steps), crossed)
        travelled += length
        x, t, sine, cosine = y, new[0], s, c
        step *= min(1.5, max(0.5, 0.8 * MAX_TURN / max(largest, 1e-6)))
    return None


def _correct(phi: Quadratics, x: Array, t: Array, tolerance: float) -> tuple[Array, Array] | None:
    """The position corrected to the rows perpendicular to t, and gradients of the rows; None without convergence."""
    for _ in range(8):
        value, J = phi.at(x)
        move = _solve(J, t, -value, 0.0)
        x = x + move
        if move @ move < ROW_TOLERANCE**2 * (x @ x):
            break
    value, J = phi.at(x)
    return (x, J) if abs(value).max() <= tolerance else None


def _solve(J: Array, t: Array, values: Array, along: float) -> Array:
    """x of ``J x = values`` and ``t x = along``; by least squares with redundant rows and where branches cross."""
    if len(J) == len(t) - 1:
        x = _eliminate(J, t, values, along)
        if x is not None and x @ x <= 100.0 * (values @ values + along**2):
            return x
    return np.asarray(np.linalg.lstsq(np.vstack([J, t]), np.append(values, along), rcond=1e-8)[0])


def _eliminate(J: Array, t: Array, values: Array, along: float) -> Array | None:
    """Solution of a square system by elimination; None if it is singular."""
    A, b = np.empty((len(t), len(t)), order="F"), np.empty(len(t))
    A[:-1], A[-1], b[:-1], b[-1] = J, t, values, along
    _, _, x, singular = dgesv(A, b, overwrite_a=True, overwrite_b=True)
    return None if singular else np.asarray(x)


def _first_direction(J: Array, slope: Array) -> Array | None:
    """The only direction in which an angle changes, unit length; None if there is none or more than one.

    Rotations of a rod about itself change no angle.
    """
    _, values, right = np.linalg.svd(J)
    values = np.append(values, np.zeros(J.shape[1] - len(values)))
    null = right[values <= RANK_TOLERANCE * values[0]]
    if len(null) == 0:
        return None
    _, size, turn = np.linalg.svd(slope @ null.T, full_matrices=False)
    if size[0] < RANK_TOLERANCE or np.sum(size > RANK_TOLERANCE * size[0]) > 1:
        return None
    t: Array = turn[0] @ null
    return t / np.linalg.norm(t)


def _next_direction(J: Array, previous: Array) -> tuple[Array, float] | None:
    """Unit direction of the motion nearest to the previous one, and the smallest singular value of all others, as a
    part of the largest.
    """
    values = np.linalg.svd(J, compute_uv=False)
    rank = int((values > RANK_TOLERANCE * values[0]).sum())
    freedoms = J.shape[1] - rank
    if freedoms == 0:
        return None
    second = float(values[rank - 1] / values[0]) if rank > 0 else 1.0
    if freedoms == 1 and len(J) == len(previous) - 1:
        # one elimination is cheaper than all singular vectors
        t = _eliminate(J, previous, np.zeros(len(J)), 1.0)
        if t is None or t @ t >= 4.0:  # not the smooth branch
            return None
        return t / math.sqrt(t @ t), second
    null = np.linalg.svd(J)[2][-freedoms:]
    t = null.T @ (null @ previous)
    length = float(np.linalg.norm(t))
    return (t / length, second) if length > 0.5 else None
