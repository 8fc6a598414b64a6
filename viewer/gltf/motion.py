"""Motion of a node over time: thinned, and how far the motion between the kept times is from the recorded one."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from viewer.poses import Vectors, about_axis, conjugate, continuous, product, rotated, shortest_turns

LARGEST_TURN = 1.5
"""Between two times, rad: an interpolation that takes the shorter way needs less than pi."""
_LOOKED_AT = 4000  # recorded times at which a motion is compared


@dataclass
class Motion:
    """A node relative to its parent at all recorded times."""

    position: Vectors
    """m, shape (n, 3)."""
    quaternion: Vectors
    """Unit, scalar first, of continuous sign, shape (n, 4)."""
    scale: Vectors | None = None
    """Factors of lengths along its axes, shape (n, 3)."""
    reach: Vectors = field(default_factory=lambda: np.zeros((1, 3)))
    """Points of the node, as far out as its shapes, where the motion is compared, shape (k, 3)."""
    angle: tuple[Vectors, Vectors] | None = None
    """Axis, and angles of shape (n,), rad, where it turns about an axis at a fixed place: the quaternion is this."""


@dataclass(frozen=True)
class Track:
    """What is written of a motion: times and the three properties at them."""

    times: Vectors
    position: Vectors
    quaternion: Vectors
    scale: Vectors | None


def kept_times(t: Vectors, rate: float) -> NDArray[np.intp]:
    """Indices of the times to keep: the first, the last, and between them at most `rate` a second.

    Of a time that stands twice, a step, the later one is kept: times of a glTF file increase.
    """
    unique = np.flatnonzero(np.append(np.diff(np.float32(t - t[0])) > 0.0, True))
    if len(unique) < 3 or not np.isfinite(rate):
        return unique
    count = np.floor(float(t[-1] - t[0]) * rate * (1.0 + 1e-9)) + 1.0
    if count >= len(unique) or count < 2:
        return unique
    grid = np.linspace(t[0], t[-1], int(count))
    place = np.clip(np.searchsorted(t[unique], grid), 1, len(unique) - 1)
    before = grid - t[unique[place - 1]] < t[unique[place]] - grid
    return np.unique(np.concatenate([unique[:1], unique[place - before], unique[-1:]]))


def thinned(motion: Motion, t: Vectors, rate: float) -> Track:
    """The track of a motion with at most `rate` times a second, more where it turns too far between two of them."""
    every = kept_times(t, np.inf)
    kept = kept_times(t, rate)
    if motion.angle is not None:
        axis, angle = motion.angle
        times = _refined(t[kept], np.interp(t[kept], t[every], angle[every]))
        turn = about_axis(axis.tolist(), np.interp(times, t[every], angle[every]))
        return Track(times, np.repeat(motion.position[:1], len(times), axis=0), turn, None)
    while len(kept) < len(every) and _largest_turn(motion.quaternion[kept]) > LARGEST_TURN:
        rate *= 2.0
        kept = kept_times(t, rate)
    scale = None if motion.scale is None else motion.scale[kept]
    return Track(t[kept], motion.position[kept], continuous(motion.quaternion[kept]), scale)


def largest_errors(motion: Motion, track: Track, t: Vectors) -> tuple[float, float]:
    """How far the interpolated motion is from the recorded one: of a point of `reach`, m, and of the rotation, rad."""
    looked = np.unique(np.linspace(0, len(t) - 1, min(len(t), _LOOKED_AT)).astype(np.intp))
    position, quaternion, scale = interpolated(track, t[looked])
    off = 0.0
    ones = np.ones((len(looked), 3))
    scale = ones if scale is None else scale
    recorded_scale = ones if motion.scale is None else motion.scale[looked]
    for point in motion.reach:
        made = position + rotated(quaternion, scale * point)
        recorded = motion.position[looked] + rotated(motion.quaternion[looked], recorded_scale * point)
        off = max(off, float(np.linalg.norm(made - recorded, axis=1).max()))
    turn = product(conjugate(quaternion), motion.quaternion[looked])
    angle = 2.0 * np.arctan2(np.linalg.norm(turn[:, 1:], axis=1), np.abs(turn[:, 0]))
    return off, float(angle.max())


def interpolated(track: Track, t: Vectors) -> tuple[Vectors, Vectors, Vectors | None]:
    """Position, quaternion and scale as a reader of the file has them: linear, rotations along great arcs."""
    if len(track.times) == 1:
        n = len(t)
        one = [None if x is None else np.repeat(x, n, axis=0) for x in (track.position, track.quaternion, track.scale)]
        return one[0], one[1], one[2]  # type: ignore[return-value]
    left = np.clip(np.searchsorted(track.times, t, side="right") - 1, 0, len(track.times) - 2)
    step = track.times[left + 1] - track.times[left]
    share = ((t - track.times[left]) / step).clip(0.0, 1.0)[:, None]
    a, b = track.quaternion[left], track.quaternion[left + 1]
    dot = np.einsum("ni,ni->n", a, b)[:, None]
    b = np.where(dot < 0.0, -b, b)
    half = np.arctan2(np.linalg.norm(b - a, axis=1), np.linalg.norm(b + a, axis=1))[:, None] * 2.0
    small = half < 1e-9
    sine = np.where(small, 1.0, np.sin(half))
    first = np.where(small, 1.0 - share, np.sin((1.0 - share) * half) / sine)
    second = np.where(small, share, np.sin(share * half) / sine)
    scale = None if track.scale is None else (1.0 - share) * track.scale[left] + share * track.scale[left + 1]
    return (1.0 - share) * track.position[left] + share * track.position[left + 1], first * a + second * b, scale


def least_twist(quaternion: Vectors) -> Vectors:
    """Turns that take the y axis where others take it, from the first on with the least twist: of what is round."""
    y = rotated(quaternion, np.array([0.0, 1.0, 0.0]))
    return continuous(_chained(np.vstack([quaternion[:1], shortest_turns(y[:-1], y[1:])])))


def _chained(steps: Vectors) -> Vectors:
    """Products steps[k] ... steps[0], each of unit length."""
    made = np.empty_like(steps)
    w, x, y, z = 1.0, 0.0, 0.0, 0.0
    for k, (a, b, c, d) in enumerate(steps.tolist()):
        w, x, y, z = (
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        )
        size = (w * w + x * x + y * y + z * z) ** 0.5
        w, x, y, z = w / size, x / size, y / size, z / size
        made[k] = w, x, y, z
    return made


def _largest_turn(quaternion: Vectors) -> float:
    dot = np.abs(np.einsum("ni,ni->n", quaternion[1:], quaternion[:-1])).clip(0.0, 1.0)
    return float((2.0 * np.arccos(dot)).max(initial=0.0))


def _refined(t: Vectors, angle: Vectors) -> Vectors:
    """Times with others between them where an angle grows by more than `LARGEST_TURN`."""
    parts = np.maximum(1, np.ceil(np.abs(np.diff(angle)) / LARGEST_TURN)).astype(int)
    if not len(parts) or parts.max() == 1:
        return t
    made = [np.linspace(a, b, k, endpoint=False) for a, b, k in zip(t[:-1], t[1:], parts, strict=True)]
    return np.concatenate([*made, t[-1:]])
