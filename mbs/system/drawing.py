"""Drawing data of a System: its scene, and poses of the frames of the scene as functions of its coordinates."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
POSE = ("x", "y", "z", "qw", "qx", "qy", "qz")
"""Parts of a pose: position, m, and quaternion, scalar first and not negative."""
POSE_UNITS = ("m", "m", "m", "1", "1", "1", "1")
_SIZES = {"rigid": 12, "planar": 4, "point": 3, "planar point": 2, "pose": 7}


@dataclass(frozen=True)
class BodyPlace:
    """Indices of a body among the rows of `Places`."""

    name: str
    kind: str
    """Kind of its full coordinates: "rigid", "planar", "point" and "planar point" have position, then axes; "pose" has
    the seven parts of the pose."""
    row: int
    """Row of the first full coordinate."""
    columns: tuple[str, ...]
    """Names of the seven parts of its pose in recordings."""


@dataclass(frozen=True)
class TurnPlace:
    """An angle by which a frame turns about an axis of a body."""

    name: str
    row: int
    """Row of the coordinate."""
    carrier: str
    axis: tuple[float, ...]
    """Unit vector in the frame of the carrier."""
    absolute: bool
    """Whether the coordinate is relative to the earth, as a spin angle; the rotation of the carrier is subtracted."""
    column: str
    """Name in recordings."""


@dataclass(frozen=True)
class AmplitudePlace:
    """Amplitudes of a flexible body."""

    body: str
    modes: tuple[str, ...]
    row: int
    """Row of the first amplitude."""
    columns: tuple[str, ...]
    """Names in recordings."""


@dataclass(frozen=True)
class Places:
    """Full coordinates ``matrix q + constant`` of the bodies that are drawn."""

    matrix: sparse.csr_matrix
    """Shape (rows, nq)."""
    constant: Array
    """Shape (rows,)."""
    bodies: tuple[BodyPlace, ...]
    turns: tuple[TurnPlace, ...] = ()
    amplitudes: tuple[AmplitudePlace, ...] = ()

    def rows(self, q: Array, first: int, count: int) -> Array:
        """Full coordinates beginning with `first`, shape (n, count), of coordinates (n, nq)."""
        rows = slice(first, first + count)
        return np.asarray((self.matrix[rows] @ q.T).T + self.constant[rows])

    def pose(self, q: Array, body: BodyPlace) -> Array:
        """Positions and quaternions of a body, shape (n, 7), at coordinates (n, nq)."""
        return self._pose(self.rows(q, body.row, _SIZES[body.kind]), body.kind)

    def poses(self, q: Array) -> list[Array]:
        """Positions and quaternions of all bodies, shapes (n, 7), at coordinates (n, nq)."""
        full = self.rows(q, 0, len(self.constant))
        return [self._pose(full[:, b.row : b.row + _SIZES[b.kind]], b.kind) for b in self.bodies]

    @staticmethod
    def _pose(full: Array, kind: str) -> Array:
        if kind == "pose":
            return full
        pose = np.zeros((len(full), 7))
        pose[:, 3] = 1.0
        d = 2 if kind.startswith("planar") else 3
        pose[:, :d] = full[:, :d]
        if kind == "planar":
            half = 0.5 * np.arctan2(full[:, 3], full[:, 2])  # from -pi/2 to pi/2: the scalar part is not negative
            pose[:, 3], pose[:, 6] = np.cos(half), np.sin(half)
        elif kind == "rigid" and len(full):
            pose[:, 3:] = quaternions(full[:, 3:].reshape(-1, 3, 3).transpose(0, 2, 1))
        return pose

    def to_json(self) -> dict[str, Any]:
        """The data as JSON values, for the System file."""
        m = self.matrix
        return {
            "shape": [int(n) for n in m.shape],
            "ptr": m.indptr.tolist(),
            "col": m.indices.tolist(),
            "val": m.data.tolist(),
            "constant": self.constant.tolist(),
            "bodies": [asdict(b) for b in self.bodies],
            "turns": [asdict(t) for t in self.turns],
            "amplitudes": [asdict(a) for a in self.amplitudes],
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Places:
        """Places from the data that `to_json` returned; raises `ValueError` if they are inconsistent."""
        matrix = sparse.csr_matrix((data["val"], data["col"], data["ptr"]), shape=tuple(data["shape"]), dtype=float)
        constant = np.array(data["constant"], float)
        if matrix.shape[0] != len(constant):
            raise ValueError("places and constants of the drawing differ in number")
        places = cls(
            matrix,
            constant,
            tuple(BodyPlace(**b | {"columns": tuple(b["columns"])}) for b in data["bodies"]),
            tuple(TurnPlace(**t | {"axis": tuple(t["axis"])}) for t in data["turns"]),
            tuple(AmplitudePlace(**a | {k: tuple(a[k]) for k in ("modes", "columns")}) for a in data["amplitudes"]),
        )
        ends = [b.row + _SIZES[b.kind] for b in places.bodies] + [t.row + 1 for t in places.turns]
        ends += [a.row + len(a.modes) for a in places.amplitudes]
        if max(ends, default=0) > len(constant):
            raise ValueError("the drawing names coordinates that it does not have")
        return places


@dataclass(frozen=True)
class Drawing:
    """A scene and the poses of its frames."""

    base: Mapping[str, Any]
    """The scene in the format of `docs/animation.md`, without entries that are made on demand."""
    places: Places
    shared: Sequence[tuple[str, Sequence[float], str, Sequence[float]]] = ()
    """Points that two frames share at a joint: names of the frames, and the point in each, m."""
    late: tuple[Callable[[], list[dict[str, Any]]], ...] = ()
    """Functions that return entries of ``flexible`` of the scene; on demand, as they take as long as a compilation."""

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The scene with the entries of `late`."""
        return {**self.base, "flexible": [*self.base["flexible"], *(entry for make in self.late for entry in make())]}

    def to_bytes(self) -> bytes:
        """The array `drawing` of a System file: JSON, UTF-8."""
        content = {"scene": self.scene, "places": self.places.to_json(), "shared": [list(s) for s in self.shared]}
        return json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()

    @classmethod
    def from_bytes(cls, data: bytes, nq: int) -> Drawing:
        """Drawing of a System with `nq` coordinates from the bytes that `to_bytes` returned.

        Raises `ValueError`, `KeyError` or `TypeError` if the bytes are not such a drawing.
        """
        content = json.loads(data)
        places = Places.from_json(content["places"])
        if places.matrix.shape[1] != nq:
            raise ValueError(f"the drawing is of {places.matrix.shape[1]} coordinates, the System has {nq}")
        shared = [(str(a), [float(x) for x in p], str(b), [float(x) for x in q]) for a, p, b, q in content["shared"]]
        return cls(dict(content["scene"]), places, shared)


def quaternions(matrices: Array) -> Array:
    """Quaternions (n, 4), scalar first and not negative, of rotation matrices (n, 3, 3)."""
    q = Rotation.from_matrix(matrices).as_quat()[:, [3, 0, 1, 2]]
    return np.asarray(np.where(q[:, :1] < 0.0, -q, q))


def matrices(quaternions: Array) -> Array:
    """Rotation matrices (n, 3, 3) of quaternions (n, 4), scalar first."""
    return np.asarray(Rotation.from_quat(quaternions[:, [1, 2, 3, 0]]).as_matrix())


def twist(quaternions: Array, axis: Array) -> Array:
    """Angle, rad, by which a body has turned about a body-fixed axis, shape (n,), from its quaternions (n, 4)."""
    if len(quaternions) < 2:
        return np.zeros(len(quaternions))
    turns = Rotation.from_quat(quaternions[:, [1, 2, 3, 0]])
    steps = (turns[:-1].inv() * turns[1:]).as_rotvec() @ np.asarray(axis, float)
    return np.concatenate([[0.0], np.cumsum(steps)])
