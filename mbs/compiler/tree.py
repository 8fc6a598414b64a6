"""Relative coordinates as the `tree_` arrays of the System.

J. García de Jalón, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, Springer 1994, chapters 5 and 8.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.common.vectors import in_space
from mbs.compiler.armatures import written_armatures
from mbs.compiler.natural_coordinates import choose
from mbs.compiler.spanning_tree import (
    MAX_JOINTS,
    Cut,
    Group,
    NoTreeError,
    angle_joints,
    cut_rows,
    frame_along,
    spanning_tree,
)
from mbs.compiler.tables import Signals
from mbs.model.body import Body
from mbs.model.model import Model

Array = NDArray[np.float64]

EQUAL_MOMENTS = 1e-12
"""Largest relative difference of two principal moments of inertia that count as equal."""
HISTORY_SIZE = 5
"""Numbers that the kernel's state stores for each coordinate as the history of a method."""


def tree_arrays(
    model: Model, signals: Signals, remaining: Sequence[int], new: NDArray[np.int64]
) -> tuple[dict[str, Any], str]:
    """The `tree_` arrays; none, with the reason in words, if the model has no tree.

    `signals`: gets the signals of the bodies' frames; `remaining`: natural coordinates that form z; `new`: index of
    each z in elimination order.
    """
    try:
        if model.lookup_tables:
            raise NoTreeError(f"'{model.lookup_tables[0].name}' moves by a table")
        groups, cuts = spanning_tree(model)
        moving = groups[1:]
        rows = sum(sum(cut_rows(model, cut)) for cut in cuts)
        angles = _angles(model, groups, remaining, new)
        if 4 * len(moving) + 1 + rows + len(angles["angle_col"]) > HISTORY_SIZE * len(remaining):
            raise NoTreeError(
                f"{len(moving)} joints and {rows} rows of loops are many for {len(remaining)} coordinates"
            )
        _check_parameters(model)
        arrays = {
            "parent": [g.parent.number for g in moving if g.parent is not None],
            "slides": [int(g.slides) for g in moving],
            "base": _concatenate([g.base for g in moving]),
            **_masses(moving),
            "gravity": in_space(model.gravity),
            **_coordinates(model, groups, remaining, new),
            **_cut_arrays(model, cuts),
            **_payloads(model, groups),
            **angles,
            "frame": [number for g in moving for number in _frame_signals(g, signals)],
        }
        return {f"tree_{name}": values for name, values in arrays.items()}, ""
    except NoTreeError as reason:
        return {}, str(reason)


def _check_parameters(model: Model) -> None:
    """Raise `NoTreeError` for parameters that change inertias, armatures or axes, which are constant in a tree."""
    for k in written_armatures(model):
        raise NoTreeError(f"a parameter writes the ratio of armature '{model.armatures[k].name}'")
    for body in model.written_inertias:
        raise NoTreeError(f"parameters write the inertia of '{body.name}'")
    for axis in model.written_axes:
        raise NoTreeError(f"parameters write the axis of '{axis.name}'")


def _concatenate(arrays: Sequence[Array]) -> Array:
    return np.concatenate([np.zeros(0), *arrays])


def _masses(moving: Sequence[Group]) -> dict[str, Any]:
    """Mass, centre of mass and inertia about it of each group of bodies, in its frame."""
    masses, centres, inertias = [], [], []
    for group in moving:
        mass, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
        for body in group.bodies:
            com, s = in_space(body.com), body.first_moment
            mass += body.mass
            first = first + body.mass * com + s
            second = second + body.second_moment + body.mass * np.outer(com, com) + np.outer(com, s) + np.outer(s, com)
        centre = first / mass
        moments = group.axes.T @ (second - mass * np.outer(centre, centre)) @ group.axes
        masses.append(mass)
        centres.append(group.local(centre))
        inertias.append(_principal(np.trace(moments) * np.eye(3) - moments))
    return {"mass": masses, "centre": _concatenate(centres), "inertia": _concatenate(inertias)}


def _principal(J: Array) -> Array:
    """j, k1, e1, k2, e2 of J = j 1 + k1 e1 e1' + k2 e2 e2'; k2 = 0 where two principal moments are equal."""
    values, vectors = np.linalg.eigh(0.5 * (J + J.T))
    # the extreme moment that is nearer to the middle one is j
    isotropic, near, far = (0, 1, 2) if values[1] - values[0] <= values[2] - values[1] else (2, 1, 0)
    k2 = values[near] - values[isotropic]
    if abs(k2) <= EQUAL_MOMENTS * values[2]:
        k2 = 0.0
    k1 = values[far] - values[isotropic]
    return np.array([values[isotropic], k1, *vectors[:, far], k2, *vectors[:, near]])


def _frame_signals(group: Group, signals: Signals) -> list[int]:
    """Numbers of the signals of the origin, then of the axes of a frame."""
    body = group.bodies[0]
    vectors = [_components(body, group.origin, True), *(_components(body, axis, False) for axis in group.axes.T)]
    return [signals.number(component) for vector in vectors for component in vector.components]


def _components(body: Body, drawn: Array, is_point: bool) -> AffineVector:
    """Expressions of the three components of a drawn point or vector of a body."""
    v = drawn[: body.dimension]
    vector = body.point(v) if is_point else body.vector(v)
    return AffineVector((*vector.components, *(Affine({}, float(x)) for x in drawn[body.dimension :])))


def _coordinates(
    model: Model, groups: Sequence[Group], remaining: Sequence[int], new: NDArray[np.int64]
) -> dict[str, Any]:
    """Points (1) and vectors (0) whose components are coordinates of the System: body, local components, indices."""
    owner = {id(body): group for group in groups for body in group.bodies}
    index = {i: int(new[z]) for z, i in enumerate(remaining)}
    bodies, locals_, columns = [], [], []
    for body in model.bodies:
        group, d = owner[id(body)], body.dimension
        for n, (_, o, w) in enumerate(choose(body)):
            component_columns = [index.get(body.start + d * n + k, -1) for k in range(d)]
            if max(component_columns) < 0:
                continue
            if group.number == 0:
                raise NoTreeError(f"body '{body.name}' is welded to the ground")
            drawn_vector = in_space(o * body.com + w)
            bodies.append(group.number)
            locals_.append(np.array([o, *(group.local(drawn_vector) if o else group.axes.T @ drawn_vector)]))
            columns += component_columns + [-1] * (3 - d)
    return {"out_body": bodies, "out_local": _concatenate(locals_), "out_col": columns}


def _payloads(model: Model, groups: Sequence[Group]) -> dict[str, Any]:
    """Bodies of the payloads, and positions in the frames of these, m."""
    owner = {body.start: group for group in groups for body in group.bodies if not body.is_ground}
    payload_groups = [owner[p.body.start] for p in model.payloads]
    for payload, group in zip(model.payloads, payload_groups, strict=True):
        if group.number == 0:
            raise NoTreeError(f"payload '{payload.name}' sits on a body that is welded to the ground")
        if payload.shared:
            raise NoTreeError(f"payload '{payload.name}' is carried by several points")
    positions = [g.local(in_space(p.position)) for p, g in zip(model.payloads, payload_groups, strict=True)]
    return {"payload_body": [g.number for g in payload_groups], "payload_place": _concatenate(positions)}


def _angles(model: Model, groups: Sequence[Group], remaining: Sequence[int], new: NDArray[np.int64]) -> dict[str, Any]:
    """Relative angles: index of the coordinate, joints that add up to the angle, their signs, inertia of the angle."""
    index = {i: int(new[z]) for z, i in enumerate(remaining)}
    arrays: dict[str, list[Any]] = {"col": [], "ptr": [0], "joint": [], "sign": [], "inertia": []}
    for joint in model.joints:
        if joint.turn is None:
            continue
        signed_joints = angle_joints(list(groups), joint)
        inertia = model.inertias.get(joint.turn.coordinate, 0.0)
        if inertia > 0.0 and not _is_one_path(groups, [number for number, _ in signed_joints]):
            raise NoTreeError(f"the armature of relative angle '{joint.name}' couples two branches of the tree")
        arrays["col"].append(index[joint.turn.coordinate])
        arrays["joint"] += [number for number, _ in signed_joints]
        arrays["sign"] += [sign for _, sign in signed_joints]
        arrays["ptr"].append(len(arrays["joint"]))
        arrays["inertia"].append(inertia)
    if len(arrays["col"]) > MAX_JOINTS:
        raise NoTreeError(f"there are {len(arrays['col'])} relative angles; at most {MAX_JOINTS} are possible")
    return {f"angle_{name}": values for name, values in arrays.items()}


def _is_one_path(groups: Sequence[Group], numbers: Sequence[int]) -> bool:
    """Whether all these groups are on the path from one of them to the ground."""
    path, group = set(), groups[max(numbers, default=0)]
    while group.parent is not None:
        path.add(group.number)
        group = group.parent
    return path.issuperset(numbers)


def _cut_arrays(model: Model, cuts: Sequence[Cut]) -> dict[str, Any]:
    """Bodies, numbers of rows, point and normals of the axis on the first body, point and axis on the second."""
    bodies: list[int] = []
    rows: list[int] = []
    geometry: list[Array] = []
    for cut in cuts:
        first, second = cut.groups
        points = [g.local(in_space(p)) for g, p in zip(cut.groups, cut.places.points, strict=True)]
        frames = [frame_along(axis) for axis in cut.places.axes or (None, None)]
        bodies += [first.number, second.number]
        rows += cut_rows(model, cut)
        normals = (first.axes.T @ frames[0])[:, :2]
        geometry += [points[0], normals.T.ravel(), points[1], second.axes.T @ frames[1][:, 2]]
    return {"cut_body": bodies, "cut_rows": rows, "cut_place": _concatenate(geometry)}
