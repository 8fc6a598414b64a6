"""Poses of the frames of a scene over time, from the columns of a recording."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Vectors = NDArray[np.float64]

GROUND = "ground"
_ON_A_LINE = 1e-9  # distance of the third point from the line of the others, as a share of its distance from the first


@dataclass(frozen=True)
class Poses:
    """A frame over time: earth = position + R(quaternion) local."""

    position: Vectors
    """Of its origin in earth axes, m, shape (n, 3)."""
    quaternion: Vectors
    """Unit, scalar first, of continuous sign, shape (n, 4)."""
    shown: NDArray[np.bool_]
    """Shape (n,); false where a number is missing: the pose is then that of the nearest time before, or the first one
    after."""

    def points(self, local: Sequence[float] | Vectors) -> Vectors:
        """Earth positions of a point of the frame, of shape (n, 3)."""
        return self.position + rotated(self.quaternion, np.asarray(local, dtype=float))


class FramePoses:
    """Poses of all frames of a scene.

    Parameters
    ----------
    columns : mapping of str to array of shape (n,)
        With all that the frames read.
    count : int
        Number of times, n.
    """

    def __init__(self, scene: Mapping[str, Any], columns: Mapping[str, NDArray[Any]], count: int) -> None:
        self._frames = scene["frames"]
        self._columns = columns
        self._count = count
        still = Poses(np.zeros((count, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)), np.ones(count, dtype=bool))
        self._found: dict[str, Poses] = {GROUND: still}

    def of(self, name: str) -> Poses:
        """Poses of a frame."""
        if name not in self._found:
            frame = self._frames[name]
            if "way" in frame:
                poses = self._slid(frame)
            elif "parent" in frame:
                poses = self._turned(frame)
            elif "points" in frame:
                poses = self._carried(frame)
            else:
                poses = held(self._stack(frame["position"]), self._stack(frame["quaternion"]))
            self._found[name] = poses
        return self._found[name]

    def points(self, anchor: Sequence[Any]) -> Vectors:
        """Earth positions of an anchor, of shape (n, 3)."""
        name, local = anchor
        return self.of(name).points(local)

    def _stack(self, names: Sequence[str]) -> Vectors:
        return np.column_stack([np.asarray(self._columns[name], dtype=float) for name in names])

    def _turned(self, frame: Mapping[str, Any]) -> Poses:
        parent = self.of(frame["parent"])
        angle = np.asarray(self._columns[frame["angle"]], dtype=float)
        turn = about_axis(frame["axis"], np.nan_to_num(angle))
        position = parent.points(frame.get("at") or (0.0, 0.0, 0.0))
        position[~(np.isfinite(angle) & parent.shown)] = np.nan
        return held(position, product(parent.quaternion, turn))

    def _slid(self, frame: Mapping[str, Any]) -> Poses:
        parent = self.of(frame["parent"])
        travel = np.asarray(self._columns[frame["way"]], dtype=float)
        at = np.asarray(frame.get("at") or (0.0, 0.0, 0.0), dtype=float)
        position = parent.points(at + travel[:, None] * np.asarray(frame["direction"], dtype=float))
        position[~parent.shown] = np.nan
        return held(position, parent.quaternion)

    def _carried(self, frame: Mapping[str, Any]) -> Poses:
        a, b, c = (self.points(anchor) for anchor in frame["on"])
        shown = np.logical_and.reduce([self.of(anchor[0]).shown for anchor in frame["on"]])
        local = [np.array([p], dtype=float) for p in frame["points"]]
        rotation = axes_of_points(a, b, c) @ axes_of_points(*local).transpose(0, 2, 1)
        position = a - np.einsum("nij,j->ni", rotation, local[0][0])
        position[~shown] = np.nan
        return held(position, from_matrices(rotation))


def held(position: Vectors, quaternion: Vectors) -> Poses:
    """Poses of unit quaternions of continuous sign; a pose that is not finite is that of the time before."""
    length = np.linalg.norm(quaternion, axis=1)
    good = np.isfinite(position).all(axis=1) & np.isfinite(length) & (length > 0.0)
    if not good.any():
        n = len(good)
        return Poses(np.zeros((n, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)), good)
    source = np.maximum.accumulate(np.where(good, np.arange(len(good)), -1))
    source[source < 0] = int(good.argmax())
    unit = quaternion[source] / length[source, None]
    return Poses(position[source], continuous(unit), good)


def continuous(quaternion: Vectors) -> Vectors:
    """The same rotations with each quaternion on the side of the one before it."""
    turned = np.einsum("ni,ni->n", quaternion[1:], quaternion[:-1]) < 0.0
    sign = np.where(np.concatenate([[False], np.logical_xor.accumulate(turned)]), -1.0, 1.0)
    return quaternion * sign[:, None]


def rotated(quaternion: Vectors, vector: Vectors) -> Vectors:
    """R(q) v, of shape (n, 3); one vector or n of them."""
    return _rotation(quaternion).apply(vector)


def product(a: Vectors, b: Vectors) -> Vectors:
    """Quaternion of R(a) R(b)."""
    return (_rotation(a) * _rotation(b)).as_quat(scalar_first=True)


def _rotation(quaternion: Vectors) -> Rotation:
    return Rotation.from_quat(quaternion, scalar_first=True)


def about_axis(axis: Sequence[float], angle: Vectors) -> Vectors:
    """Quaternions of right-handed turns about an axis by n angles, rad."""
    unit = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    return Rotation.from_rotvec(angle[:, None] * unit).as_quat(scalar_first=True)


def axes_of_points(a: Vectors, b: Vectors, c: Vectors) -> Vectors:
    """Axes of n triangles as columns: x from a to b, c in the plane of x and y; nan where they lie on a line."""
    with np.errstate(invalid="ignore", divide="ignore"):
        x = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
        to = c - a
        across = to - np.einsum("ni,ni->n", to, x)[:, None] * x
        size = np.linalg.norm(across, axis=1)
        size[~(size > _ON_A_LINE * np.linalg.norm(to, axis=1))] = np.nan
        y = across / size[:, None]
    return np.stack([x, y, np.cross(x, y)], axis=2)


def from_matrices(rotation: Vectors) -> Vectors:
    """Unit quaternions of n rotation matrices; nan where a matrix is."""
    result = np.full((len(rotation), 4), np.nan)
    good = np.isfinite(rotation).all(axis=(1, 2))
    result[good] = Rotation.from_matrix(rotation[good]).as_quat(scalar_first=True)
    return result
