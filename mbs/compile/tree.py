"""Relative coordinates: a spanning tree of the bodies from the ground, and the joints that are cut.

J. García de Jalón, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, Springer 1994, chapters 5 and 8.
Each body of the tree has a frame with its origin at the joint to its parent and z along the joint's axis. Welded bodies
are one. What does not fit gets no tree, and the report of the System says why.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.affine import Affine, AffineVector
from mbs.compile.natural import choose
from mbs.compile.tables import Signals
from mbs.model.body import Body
from mbs.model.checks import perpendicular
from mbs.model.joints.joint import Joint
from mbs.model.model import Model

Array = NDArray[np.float64]

MOST_JOINTS = 64
"""Relative coordinates are solved for as a dense matrix: beyond so many the sparse methods are faster."""
EQUAL_MOMENTS = 1e-12
"""Relative difference of two principal moments of inertia that are one."""
FORMED = ("revolute", "prismatic")
"""Joints that the tree is made of."""
EMPTY: dict[str, list[float]] = {
    f"tree_{name}": []
    for name in (
        *("parent", "slides", "base", "mass", "centre", "inertia", "gravity", "frame"),
        *("out_body", "out_local", "out_col", "cut_body", "cut_rows", "cut_place"),
    )
}


@dataclass
class _Group:
    """Bodies welded to each other, with one drawing; number 0 is the ground."""

    bodies: list[Body] = field(default_factory=list)
    number: int = -1
    parent_group: Any = None
    slides: bool = False
    origin: Array = field(default_factory=lambda: np.zeros(3))
    axes: Array = field(default_factory=lambda: np.eye(3))  # columns, in the drawing
    base: Array = field(default_factory=lambda: np.zeros(12))  # origin and columns, in the frame of the parent
    depth: int = 0

    def local(self, point: Array) -> Array:
        """A drawn point in the frame."""
        return self.axes.T @ (point - self.origin)


class _Refused(Exception):
    """The reason why there is no tree."""


def tree_arrays(
    model: Model, signals: Signals, kept: Sequence[int], new: NDArray[np.int64]
) -> tuple[dict[str, Any], str]:
    """The `tree_` arrays; all empty, with the reason in words, where the model has no tree.

    Parameters
    ----------
    signals : Signals
        Takes the frames of the bodies.
    kept : sequence of int
        Natural coordinates that are z.
    new : ndarray of int
        Place of each z in elimination order.
    """
    try:
        _check(model)
        groups, cuts = _span(model)
        return _arrays(model, groups, cuts, signals, kept, new), ""
    except _Refused as reason:
        return dict(EMPTY), str(reason)


def _check(model: Model) -> None:
    for body in model.bodies:
        if body.is_flexible or body.is_point:
            raise _Refused(f"body '{body.name}' is {'flexible' if body.is_flexible else 'a point mass'}")
    if model.guides or model.switches:
        raise _Refused("guides or switches move or hold something")
    if len(model.coordinates) > sum(body.size for body in model.bodies):
        raise _Refused("angles or spins are coordinates of their own")
    for joint in model.joints:
        if joint.places is None:
            raise _Refused(f"joint '{joint.name}' is neither revolute, prismatic, spherical nor a weld")


def _span(model: Model) -> tuple[list[_Group], list[tuple[Joint, _Group, _Group]]]:
    """Groups in depth-first order, the ground first, and the joints that are cut."""
    group_of = _welded(model)
    ground = group_of[id(model.ground)]
    edges: dict[int, list[tuple[int, Joint, _Group]]] = {}
    others: list[tuple[int, Joint, _Group, _Group]] = []
    for n, joint in enumerate(model.joints):
        first, second = _ends(joint, group_of)
        if joint.type == "weld":
            continue
        if first is second:
            raise _Refused(f"joint '{joint.name}' joins bodies that are welded to each other")
        others.append((n, joint, first, second))
        if joint.type in FORMED:
            edges.setdefault(id(first), []).append((n, joint, second))
            edges.setdefault(id(second), []).append((n, joint, first))
    children: dict[int, list[_Group]] = {id(ground): []}
    # prismatic joints first because they cannot be cut, the others breadth first: short paths, little work
    heap: list[tuple[bool, int, int, int]] = []
    reached = {id(ground): ground}
    formed: set[int] = set()

    def offer(group: _Group) -> None:
        for n, joint, _ in edges.get(id(group), []):
            heapq.heappush(heap, (joint.type != "prismatic", group.depth, n, id(group)))

    offer(ground)
    while heap:
        _, _, n, here = heapq.heappop(heap)
        joint = model.joints[n]
        there = next(g for m, _, g in edges[here] if m == n)
        if id(there) in reached:
            continue
        formed.add(n)
        reached[id(there)] = there
        there.depth = reached[here].depth + 1
        _place(there, reached[here], joint, group_of)
        children[here].append(there)
        children[id(there)] = []
        offer(there)
    for body in model.bodies:
        if id(group_of[id(body)]) not in reached:
            raise _Refused(f"no revolute or prismatic joints lead from the ground to body '{body.name}'")
    if len(formed) > MOST_JOINTS:
        raise _Refused(f"it has {len(formed)} joints, more than {MOST_JOINTS}")
    groups: list[_Group] = []
    stack = [ground]
    while stack:
        group = stack.pop()
        group.number = len(groups)
        groups.append(group)
        stack += sorted(children[id(group)], key=lambda g: _height(g, children))
    cuts = [(joint, first, second) for n, joint, first, second in others if n not in formed]
    for joint, _, _ in cuts:
        if joint.type == "prismatic":
            raise _Refused(f"the prismatic joint '{joint.name}' closes a loop of prismatic joints")
    return groups, cuts


def _welded(model: Model) -> dict[int, _Group]:
    """The group of every body by its identity."""
    group_of = {id(body): _Group([body]) for body in (model.ground, *model.bodies)}
    for joint in model.joints:
        if joint.type != "weld":
            continue
        first, second = _ends(joint, group_of)
        if first is second:
            raise _Refused(f"weld '{joint.name}' joins bodies that are welded to each other already")
        first.bodies += second.bodies
        for body in second.bodies:
            group_of[id(body)] = first
    return group_of


def _ends(joint: Joint, group_of: dict[int, _Group]) -> tuple[_Group, _Group]:
    assert joint.places is not None
    first, second = joint.places.bodies
    return group_of[id(first)], group_of[id(second)]


def _height(group: _Group, children: dict[int, list[_Group]]) -> int:
    return 1 + max((_height(g, children) for g in children[id(group)]), default=0)


def _place(group: _Group, parent: _Group, joint: Joint, group_of: dict[int, _Group]) -> None:
    """The frames of a joint of the tree on both bodies."""
    assert joint.places is not None
    here, there = (0, 1) if group_of[id(joint.places.bodies[0])] is parent else (1, 0)
    axes = joint.places.axes
    group.parent_group = parent
    group.slides = joint.type == "prismatic"
    group.origin = _space(joint.places.points[there])
    group.axes = _frame(None if axes is None else axes[there])
    base = _frame(None if axes is None else axes[here])
    turned = parent.axes.T @ base
    group.base = np.concatenate([parent.local(_space(joint.places.points[here])), turned.T.ravel()])


def _space(v: ArrayLike) -> Array:
    """Three components; a plane is z = 0."""
    given = np.asarray(v, dtype=float)
    return given if len(given) == 3 else np.array([*given, 0.0])


def _frame(axis: ArrayLike | None) -> Array:
    """Columns x, y and z; z along the axis, in a plane square to it."""
    if axis is None:
        return np.eye(3)
    z = _space(axis)
    z = z / np.linalg.norm(z)
    return np.array([*perpendicular(z), z]).T


def _arrays(
    model: Model,
    groups: list[_Group],
    cuts: list[tuple[Joint, _Group, _Group]],
    signals: Signals,
    kept: Sequence[int],
    new: NDArray[np.int64],
) -> dict[str, Any]:
    moving = groups[1:]
    return {
        "tree_parent": [g.parent_group.number for g in moving],
        "tree_slides": [int(g.slides) for g in moving],
        "tree_base": np.concatenate([np.zeros(0), *(g.base for g in moving)]),
        **_masses(moving),
        "tree_gravity": _space(model.gravity),
        "tree_frame": [number for g in moving for number in _frame_signals(g, signals)],
        **_coordinates(model, groups, kept, new),
        **_cut_arrays(model, cuts),
    }


def _masses(moving: Sequence[_Group]) -> dict[str, Any]:
    """Mass, centre of mass and inertia j 1 + k1 e1 e1' + k2 e2 e2' about it, in the frame; k2 = 0 where two principal
    moments are equal.
    """
    masses, centres, inertias = [], [], []
    for group in moving:
        mass, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
        for body in group.bodies:
            com = _space(body.com)
            mass += body.mass
            first = first + body.mass * com + body.first_moment
            second = second + body.second_moment + body.mass * np.outer(com, com)
            second = second + np.outer(com, body.first_moment) + np.outer(body.first_moment, com)
        centre = first / mass
        moments = group.axes.T @ (second - mass * np.outer(centre, centre)) @ group.axes
        J = np.trace(moments) * np.eye(3) - moments
        values, vectors = np.linalg.eigh(0.5 * (J + J.T))
        # the moment that is closest to another one is the isotropic part
        order = [0, 1, 2] if values[1] - values[0] <= values[2] - values[1] else [2, 1, 0]
        j, second_moment, first_moment = (values[k] for k in order)
        k1, k2 = first_moment - j, second_moment - j
        if abs(k2) <= EQUAL_MOMENTS * abs(values[2]):
            k2 = 0.0
        masses.append(mass)
        centres.append(group.local(centre))
        inertias.append(np.concatenate([[j, k1], vectors[:, order[2]], [k2], vectors[:, order[1]]]))
    return {
        "tree_mass": masses,
        "tree_centre": np.concatenate([np.zeros(0), *centres]),
        "tree_inertia": np.concatenate([np.zeros(0), *inertias]),
    }


def _frame_signals(group: _Group, signals: Signals) -> list[int]:
    """Signals of the origin, then of the columns of the frame."""
    body = group.bodies[0]
    d = body.dimension
    if d == 2:
        parts = [body.point(group.origin[:2]), *(body.vector(axis[:2]) for axis in group.axes.T)]
        heights = (0.0, *group.axes[2])
        vectors = [AffineVector((*p.components, Affine({}, float(z)))) for p, z in zip(parts, heights, strict=True)]
    else:
        vectors = [body.point(group.origin), *(body.vector(axis) for axis in group.axes.T)]
    return [signals.number(component) for vector in vectors for component in vector.components]


def _coordinates(
    model: Model, groups: Sequence[_Group], kept: Sequence[int], new: NDArray[np.int64]
) -> dict[str, Any]:
    """The points and vectors whose components are coordinates of the System: body, 1 or 0, local components, places."""
    owner = {id(body): group for group in groups for body in group.bodies}
    found: dict[tuple[int, int], list[int]] = {}
    local: dict[tuple[int, int], Array] = {}
    place = {i: int(new[z]) for z, i in enumerate(kept)}
    for body in model.bodies:
        group, d = owner[id(body)], body.dimension
        for n, (_, o, w) in enumerate(choose(body)):
            columns = [place.get(body.start + d * n + k, -1) for k in range(d)]
            if max(columns) < 0:
                continue
            if group.number == 0:
                raise _Refused(f"body '{body.name}' is welded to the ground")
            key = (body.number, n)
            found[key] = columns + [-1] * (3 - d)
            drawn = _space(o * body.com + w)
            local[key] = np.array([o, *(group.local(drawn) if o else group.axes.T @ drawn)])
    bodies = {body.number: owner[id(body)].number for body in model.bodies}
    return {
        "tree_out_body": [bodies[b] for b, _ in found],
        "tree_out_local": np.concatenate([np.zeros(0), *local.values()]),
        "tree_out_col": [column for columns in found.values() for column in columns],
    }


def _cut_arrays(model: Model, cuts: Sequence[tuple[Joint, _Group, _Group]]) -> dict[str, Any]:
    """Cut joints: bodies, numbers of rows (of points, of axes), point and normals on the first, point and axis on the
    second.
    """
    bodies, rows, places = [], [], [np.zeros(0)]
    for joint, first, second in cuts:
        assert joint.places is not None
        axes = joint.places.axes
        points = [g.local(_space(p)) for g, p in zip((first, second), joint.places.points, strict=True)]
        frames = [_frame(None if axes is None else axis) for axis in (axes or (None, None))]
        bodies += [first.number, second.number]
        rows += [model.dimension, 2 if axes is not None else 0]
        normals = (first.axes.T @ frames[0])[:, :2].T.ravel()
        places += [points[0], normals, points[1], second.axes.T @ frames[1][:, 2]]
    return {"tree_cut_body": bodies, "tree_cut_rows": rows, "tree_cut_place": np.concatenate(places)}
