"""Conditions of the joints of closed loops as functions of the poses of rigid bodies and of constants of the drawing.

The unknowns of a body are the translation of its centre of mass and its rotation (rad), in earth axes. A joint has two
ends: a point and an axis on each of its bodies. The constants of an end are a translation of its point and a rotation
of its axis, in the axes of the body; a distance has its length as a constant. All lengths are relative to the size of
the loops, so rows, unknowns and constants are dimensionless.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mbs.common.vectors import cross, in_space
from mbs.compiler.biconnected_blocks import blocks_of
from mbs.compiler.spanning_tree import frame_along
from mbs.model.body import Body, Ground
from mbs.model.joints.joint import Drawing, Joint
from mbs.model.model import Model

Array = NDArray[np.float64]

Welded = dict[int, Body]
"""The body that represents each welded body, by the identity of the latter."""
EXACT = 1e-13
"""Closing error that is round-off of a drawing, parts of its size."""
SAME_POINT = 1e-12
"""Largest distance, parts of the size, of points of a body that are one point but for round-off and are corrected
together."""

BY_POINTS = np.hstack([-np.eye(3), np.zeros((3, 3)), np.eye(3), np.zeros((3, 3))])
"""Derivatives of the difference of two points by (point, rotation) of both ends."""


@dataclass
class End:
    """One end of a joint: number of its body (-1: at rest), point from the centre of mass (m) and frame (columns; the
    third is the axis) in the axes of the body, first constants of the translation and of the rotation.
    """

    body: int
    point: Array
    frame: Array
    shift: int
    turn: int


@dataclass
class Condition:
    """The conditions of a joint, its drawn length (m) and its constant if it is a distance (else -1), and the cosine
    of the angle between its drawn axes.
    """

    joint: Joint
    ends: tuple[End, End]
    conditions: tuple[str, ...]
    length: float
    constant: int
    cosine: float


@dataclass
class Poses:
    """Centres of mass, shape (n, 3), m, and axes as columns, shape (n, 3, 3), of the bodies."""

    centres: Array
    axes: Array

    def moved(self, x: Array, size: float) -> Poses:
        """Poses after translations in parts of `size` (m) and rotations (rad) `x`, shape (n, 6)."""
        turns = Rotation.from_rotvec(x[:, 3:]).as_matrix()
        return Poses(self.centres + size * x[:, :3], turns @ self.axes)


class Loops:
    """Rigid bodies that closed loops connect, without the one at rest: the ground or else the body with most joints.

    Attributes
    ----------
    size : float
        Largest extent of the joint points, m.
    rows, constants : int
        Numbers of conditions and of constants of the drawing.
    hinges : int
        Number of pairs of bodies that two ball joints connect at equal distances on both: one of their conditions is
        redundant and consistent in every position.
    """

    def __init__(self, model: Model, joints: list[Joint], welded: Welded) -> None:
        self.planar = model.dimension == 2
        self.bodies = _bodies(joints, welded)
        self._welded = welded
        number = {id(body): k for k, body in enumerate(self.bodies)}
        points = [in_space(p) for joint in joints for p in _drawing(joint).points]
        extent = np.ptp(np.array(points), axis=0) if points else np.zeros(3)
        self.size = float(np.linalg.norm(extent)) or 1.0
        self.constants = 0
        self.conditions: list[Condition] = []
        for joint in joints:
            self.conditions.append(self._condition(joint, number))
        self._drawn_poses = Poses(
            np.array([in_space(b.com) for b in self.bodies]), np.array([np.eye(3)] * len(self.bodies))
        )
        self._drawn_rows = [self._rows(c, self._drawn_poses, None) for c in self.conditions]
        self.rows = sum(len(values) for values, _, _ in self._drawn_rows)
        self.hinges = self._count_hinges()
        columns = [0, 1, 5] if self.planar else range(6)
        self.columns = np.array([6 * k + c for k in range(len(self.bodies)) for c in columns], dtype=np.int64)

    def drawn(self) -> Poses:
        """Poses of the bodies as drawn."""
        return self._drawn_poses

    def names(self) -> list[str]:
        """The joint of each condition."""
        return [
            c.joint.name for c, (values, _, _) in zip(self.conditions, self._drawn_rows, strict=True) for _ in values
        ]

    def move(self, poses: Poses, dx: Array) -> Poses:
        """Poses after the change `dx` of the unknowns."""
        x = np.zeros(6 * len(self.bodies))
        x[self.columns] = dx
        return poses.moved(x.reshape(-1, 6), self.size)

    def evaluate(self, poses: Poses, g: Array | None = None, constants: bool = False) -> tuple[Array, Array, Array]:
        """Conditions (m,), their derivatives by the unknowns (m, n) and, with `constants`, by the constants (m, k)."""
        r, Jx = np.zeros(self.rows), np.zeros((self.rows, 6 * len(self.bodies)))
        Jg = np.zeros((self.rows, self.constants if constants else 0))
        row = 0
        frames = self._end_frames(g)
        as_drawn = poses is self._drawn_poses and g is None
        for k, c in enumerate(self.conditions):
            values, G, arms = self._drawn_rows[k] if as_drawn else self._rows(c, poses, g, frames)
            row_slice = slice(row, row + len(values))
            r[row_slice] = values
            for side, end in enumerate(c.ends):
                by_point, by_turn = G[:, 6 * side : 6 * side + 3], G[:, 6 * side + 3 : 6 * side + 6]
                if end.body >= 0:
                    Jx[row_slice, 6 * end.body : 6 * end.body + 3] += by_point
                    Jx[row_slice, 6 * end.body + 3 : 6 * end.body + 6] += by_turn + cross(arms[side], by_point)
                if constants:
                    R = poses.axes[end.body] if end.body >= 0 else np.eye(3)
                    Jg[row_slice, end.shift : end.shift + 3] += by_point @ R
                    Jg[row_slice, end.turn : end.turn + 3] += by_turn @ R
            if constants and c.constant >= 0:
                Jg[row_slice, c.constant] -= 1.0
            row += len(values)
        return r, Jx[:, self.columns], Jg

    def ends_in_space(
        self, c: Condition, poses: Poses, g: Array | None, frames: dict[int, Array] | None = None
    ) -> list[tuple[Array, Array]]:
        """Point (m) and frame of both ends of a joint in earth axes."""
        ends = []
        frames = self._end_frames(g) if frames is None else frames
        for end in c.ends:
            point, frame = end.point, frames[id(end)]
            if g is not None:
                point = point + self.size * g[end.shift : end.shift + 3]
            if end.body >= 0:
                R = poses.axes[end.body]
                point, frame = poses.centres[end.body] + R @ point, R @ frame
            ends.append((point, frame))
        return ends

    def _end_frames(self, g: Array | None) -> dict[int, Array]:
        """Frames of all ends, rotated by the constants g, by the identity of the end."""
        ends = [end for c in self.conditions for end in c.ends]
        if g is None:
            return {id(end): end.frame for end in ends}
        turns = Rotation.from_rotvec(np.array([g[end.turn : end.turn + 3] for end in ends])).as_matrix()
        return {id(end): turn @ end.frame for end, turn in zip(ends, turns, strict=True)}

    def _condition(self, joint: Joint, number: dict[int, int]) -> Condition:
        drawing = _drawing(joint)
        ends = []
        for side in (0, 1):
            body = _welded_body(drawing.bodies[side], self._welded)
            axis = None if drawing.axes is None else drawing.axes[side]
            frame = np.eye(3) if axis is None else frame_along(axis)
            if self.planar and axis is not None:
                frame = np.roll(frame_along(axis), 1, axis=1)  # the axis first, its normal second
                frame[:, 1], frame[:, 2] = np.cross([0.0, 0.0, 1.0], frame[:, 0]), [0.0, 0.0, 1.0]
            k = number.get(id(body), -1)
            point = in_space(drawing.points[side]) - (in_space(body.com) if k >= 0 else 0.0)
            ends.append(End(k, point, frame, self._shift_constant(k, point), -1))
            ends[-1].turn = self._add_constants(3)
        length = self._add_constants(1) if "distance" in drawing.conditions else -1
        cosine = float(ends[0].frame[:, 2] @ ends[1].frame[:, 2])
        return Condition(joint, (ends[0], ends[1]), drawing.conditions, drawing.length, length, cosine)

    def _count_hinges(self) -> int:
        pairs: dict[frozenset[int], list[Condition]] = {}
        for c in self.conditions:
            pairs.setdefault(frozenset(end.body for end in c.ends), []).append(c)
        hinges = 0
        for joints in pairs.values():
            if [c.conditions for c in joints] != [("point",), ("point",)]:
                continue
            ends = [{end.body: end.point for end in c.ends} for c in joints]
            distance_1, distance_2 = (float(np.linalg.norm(ends[1][body] - ends[0][body])) for body in ends[0])
            hinges += distance_1 > SAME_POINT * self.size and abs(distance_1 - distance_2) <= EXACT * self.size
        return hinges

    def _shift_constant(self, body: int, point: Array) -> int:
        """First constant of the shift of a point, which joints at the same point of a body share."""
        for c in self.conditions:
            for end in c.ends:
                if end.body == body and np.linalg.norm(end.point - point) <= SAME_POINT * self.size:
                    return end.shift
        return self._add_constants(3)

    def _add_constants(self, n: int) -> int:
        self.constants += n
        return self.constants - n

    def _rows(
        self, c: Condition, poses: Poses, g: Array | None, frames: dict[int, Array] | None = None
    ) -> tuple[Array, Array, list[Array]]:
        """Values (m,), derivatives by (point, rotation) of both ends (m, 12), arms of the points (2, 3)."""
        (p, E), (q, F) = self.ends_in_space(c, poses, g, frames)
        d = (q - p) / self.size
        arms = [
            (s - poses.centres[end.body]) / self.size if end.body >= 0 else np.zeros(3)
            for s, end in ((p, c.ends[0]), (q, c.ends[1]))
        ]
        values: list[float] = []
        G: list[Array] = []
        zero = np.zeros(3)

        def add_product(i: int, j: int, target: float = 0.0) -> None:
            product = cross(E[:, i], F[:, j])
            values.append(float(E[:, i] @ F[:, j]) - target)
            G.append(np.concatenate([zero, product, zero, -product]))

        for condition in c.conditions:
            if condition == "point":
                dimension = 2 if self.planar else 3
                values += d[:dimension].tolist()
                G += list(BY_POINTS[:dimension])
            elif condition == "axis":
                add_product(0, 2)
                add_product(1, 2)
            elif condition == "angle":
                add_product(2, 2, c.cosine)
            elif condition == "orientation":
                for i, j in ((0, 1),) if self.planar else ((0, 1), (1, 2), (2, 0)):
                    add_product(i, j)
            elif condition == "line":
                for k in (1,) if self.planar else (0, 1):
                    n = F[:, k]
                    values.append(float(d @ n))
                    G.append(np.concatenate([-n, zero, n, cross(n, d)]))
            elif condition == "distance":
                distance = float(np.linalg.norm(d))
                n = d / distance
                values.append(distance - c.length / self.size - (0.0 if g is None else float(g[c.constant])))
                G.append(np.concatenate([-n, zero, n, zero]))
        return np.array(values), np.array(G).reshape(-1, 12), arms


def loops_of(model: Model, max_bodies: int) -> list[Loops]:
    """Loops of each part of a model in which any two joints are on a closed loop of rigid bodies.

    `max_bodies`: parts with more bodies are left out.
    """
    welded: Welded = {}
    for joint in model.joints:
        if joint.type == "weld" and joint.places is not None and _is_rigid(joint.places.bodies):
            first, second = sorted(_welded_bodies(joint.places.bodies, welded), key=lambda b: not b.is_ground)
            for body in (b for b in model.bodies if _welded_body(b, welded) is second):
                welded[id(body)] = first
    joints = [j for j in model.joints if j.drawing is not None and j.switch is None and _is_rigid(j.drawing.bodies)]
    joints = [j for j in joints if len({id(b) for b in _welded_bodies(_drawing(j).bodies, welded)}) == 2]
    around: dict[int, list[tuple[int, int]]] = {}
    for n, joint in enumerate(joints):
        a, b = (id(body) for body in _welded_bodies(_drawing(joint).bodies, welded))
        around.setdefault(a, []).append((n, b))
        around.setdefault(b, []).append((n, a))
    blocks = [[joints[n] for n in sorted(block)] for block in blocks_of(around) if len(block) > 1]
    return [Loops(model, block, welded) for block in blocks if len(_bodies(block, welded)) <= max_bodies]


def _drawing(joint: Joint) -> Drawing:
    assert joint.drawing is not None
    return joint.drawing


def _is_rigid(bodies: Iterable[Body]) -> bool:
    return all(type(body) in (Body, Ground) for body in bodies)


def _welded_body(body: Body, welded: Welded) -> Body:
    return welded.get(id(body), body)


def _welded_bodies(bodies: Iterable[Body], welded: Welded) -> list[Body]:
    return [_welded_body(body, welded) for body in bodies]


def _bodies(joints: Iterable[Joint], welded: Welded) -> list[Body]:
    """The bodies of joints without the one at rest."""
    bodies: dict[int, Body] = {}
    count: dict[int, int] = {}
    for joint in joints:
        for body in _welded_bodies(_drawing(joint).bodies, welded):
            bodies[id(body)] = body
            count[id(body)] = count.get(id(body), 0) + 1
    base = next((b for b in bodies.values() if b.is_ground), None) or max(bodies.values(), key=lambda b: count[id(b)])
    return [body for body in bodies.values() if body is not base]
