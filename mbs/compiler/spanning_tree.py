"""A spanning tree of the bodies of a model: which joints lead from the ground to each body, and which are cut.

Welded bodies are one. Each body of the tree has a frame with its origin at the joint to its parent and z along the
joint's axis.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.vectors import in_space
from mbs.model.body import Body
from mbs.model.joints.joint import Joint, JointPlaces
from mbs.model.model import Model
from mbs.model.perpendicular_vectors import perpendicular

Array = NDArray[np.float64]

MAX_JOINTS, MAX_CUT_ROWS = 64, 64
"""Largest numbers of joints and of rows of cut joints: relative coordinates have a dense matrix, and for larger models
sparse methods are faster.
"""
PARALLEL_TOLERANCE = 1e-9
"""Largest sine of the angle between two axes that count as the same."""
TREE_JOINTS = ("revolute", "prismatic")
"""Types of the joints that form the tree."""


class NoTreeError(Exception):
    """The reason why a model has no tree, a clause for a message."""


@dataclass(eq=False)
class Group:
    """Bodies that are welded to each other, and their common frame."""

    bodies: list[Body]
    number: int = 0
    """Number in depth-first order; 0 is the ground."""
    depth: int = 0
    """Number of joints between the ground and the group."""
    parent: Group | None = None
    children: list[Group] = field(default_factory=list)
    slides: bool = False
    """Whether the joint to its parent is prismatic."""
    origin: Array = field(default_factory=lambda: np.zeros(3))
    """Drawn origin of the frame, m, shape (3,)."""
    axes: Array = field(default_factory=lambda: np.eye(3))
    """Drawn axes x, y, z of the frame as columns, shape (3, 3)."""
    base: Array = field(default_factory=lambda: np.zeros(12))
    """Origin, m, and columns of the joint's frame on the parent, in the frame of the parent, shape (12,)."""

    @property
    def height(self) -> int:
        """Number of joints between the group and its farthest descendant."""
        return max((1 + child.height for child in self.children), default=0)

    def local(self, point: Array) -> Array:
        """Components of a drawn point in the frame, shape (3,), m."""
        return np.asarray(self.axes.T @ (point - self.origin))


@dataclass(frozen=True)
class Cut:
    """A joint that closes a loop."""

    joint: Joint
    places: JointPlaces
    groups: tuple[Group, Group]


def spanning_tree(model: Model) -> tuple[list[Group], list[Cut]]:
    """Groups in depth-first order, the ground first, and the joints that are cut.

    Raises `NoTreeError` with the reason if the model has no tree.
    """
    _check_model(model)
    group_of = _weld_groups(model)
    ground = group_of[id(model.ground)]
    joints = [
        (joint, joint.places, _ends(joint.places, group_of))
        for joint in model.joints
        if joint.places is not None and joint.type != "weld"
    ]
    for joint, _, (first, second) in joints:
        if first is second:
            raise NoTreeError(f"joint '{joint.name}' joins bodies that are welded to each other")
    incident_joints: dict[int, list[int]] = {}
    for n, (joint, _, ends) in enumerate(joints):
        if joint.type in TREE_JOINTS:
            for group in ends:
                incident_joints.setdefault(id(group), []).append(n)
    reached, tree_joints = {id(ground)}, set()
    angle_pairs = {frozenset(id(group_of[id(b)]) for b in j.turn.bodies) for j in model.joints if j.turn is not None}
    # prismatic joints first because they cannot be cut, then those whose angle is a coordinate, the others breadth
    # first: short paths, little work
    heap: list[tuple[bool, bool, int, int]] = []

    def push_joints(group: Group) -> None:
        for n in incident_joints.get(id(group), ()):
            joint, _, ends = joints[n]
            angle = frozenset(map(id, ends)) in angle_pairs
            heapq.heappush(heap, (joint.type != "prismatic", not angle, group.depth, n))

    push_joints(ground)
    while heap:
        n = heapq.heappop(heap)[3]
        joint, places, ends = joints[n]
        unreached = [side for side, group in enumerate(ends) if id(group) not in reached]
        if not unreached:
            continue
        group, parent = ends[unreached[0]], ends[1 - unreached[0]]
        _attach(group, parent, places, unreached[0], joint.type == "prismatic")
        tree_joints.add(n)
        reached.add(id(group))
        push_joints(group)
    for body in model.bodies:
        if id(group_of[id(body)]) not in reached:
            raise NoTreeError(f"no revolute or prismatic joints lead from the ground to body '{body.name}'")
    cuts = [Cut(*entry) for n, entry in enumerate(joints) if n not in tree_joints]
    _check_size(model, len(tree_joints), cuts)
    return _depth_first(ground), cuts


def _check_model(model: Model) -> None:
    """Raise `NoTreeError` for a model with more than rigid bodies and joints that relative coordinates describe."""
    for body in model.bodies:
        if body.is_flexible or body.is_point:
            raise NoTreeError(f"body '{body.name}' is {'flexible' if body.is_flexible else 'a point mass'}")
    if model.guides or model.switches:
        raise NoTreeError("driving functions or switches move or hold something")
    angles = sum(joint.turn is not None for joint in model.joints)
    if len(model.coordinates) > sum(body.size for body in model.bodies) + angles:
        raise NoTreeError("spins or ports are coordinates of their own")
    for joint in model.joints:
        if joint.places is None and joint.turn is None:
            raise NoTreeError(f"joint '{joint.name}' is neither revolute, prismatic, spherical nor a weld")


def angle_joints(groups: list[Group], joint: Joint) -> list[tuple[int, float]]:
    """The joints whose coordinates add up to a relative angle, by the numbers of their bodies, and their signs.

    Raises `NoTreeError` if a joint between its bodies turns about another axis.
    """
    assert joint.turn is not None
    axis = np.array([0.0, 0.0, 1.0]) if joint.turn.axis is None else in_space(joint.turn.axis)
    axis = axis / np.linalg.norm(axis)
    owner = {id(body): group for group in groups for body in group.bodies}
    signs: dict[int, float] = {}
    for body, sign in zip(joint.turn.bodies, (-1.0, 1.0), strict=True):
        group = owner[id(body)]
        while group.parent is not None:
            if not group.slides and signs.pop(group.number, None) is None:
                signs[group.number] = sign * float(np.sign(group.axes[:, 2] @ axis))
            group = group.parent
    for number in signs:
        if np.linalg.norm(np.cross(groups[number].axes[:, 2], axis)) > PARALLEL_TOLERANCE:
            raise NoTreeError(f"not all joints between the bodies of relative angle '{joint.name}' turn about its axis")
    return sorted(signs.items())


def cut_rows(model: Model, cut: Cut) -> tuple[int, int]:
    """Numbers of rows of a cut joint: for its point and for its axis."""
    return model.dimension, 0 if cut.places.axes is None else 2


def _check_size(model: Model, n_joints: int, cuts: list[Cut]) -> None:
    rows = sum(sum(cut_rows(model, cut)) for cut in cuts)
    if n_joints > MAX_JOINTS or rows > MAX_CUT_ROWS:
        raise NoTreeError(
            f"there are {n_joints} joints and {rows} rows of loops; at most {MAX_JOINTS} and "
            f"{MAX_CUT_ROWS} are possible"
        )
    for cut in cuts:
        if cut.joint.type == "prismatic":
            raise NoTreeError(f"the prismatic joint '{cut.joint.name}' closes a loop of prismatic joints")


def _weld_groups(model: Model) -> dict[int, Group]:
    """The group of each body, by the identity of the body."""
    group_of = {id(body): Group([body]) for body in (model.ground, *model.bodies)}
    for joint in model.joints:
        if joint.type != "weld" or joint.places is None:
            continue
        first, second = _ends(joint.places, group_of)
        if first is second:
            raise NoTreeError(f"weld '{joint.name}' joins bodies that are welded to each other already")
        first.bodies += second.bodies
        for body in second.bodies:
            group_of[id(body)] = first
    return group_of


def _ends(places: JointPlaces, group_of: dict[int, Group]) -> tuple[Group, Group]:
    first, second = places.bodies
    return group_of[id(first)], group_of[id(second)]


def _attach(group: Group, parent: Group, places: JointPlaces, side: int, slides: bool) -> None:
    """Attach a group of welded bodies to its parent in the tree by a joint; `side`: index of the group in `places`."""
    own_axis, parent_axis = (None, None) if places.axes is None else (places.axes[side], places.axes[1 - side])
    group.parent, group.depth, group.slides = parent, parent.depth + 1, slides
    group.origin, group.axes = in_space(places.points[side]), frame_along(own_axis)
    parent_joint_axes = parent.axes.T @ frame_along(parent_axis)
    group.base = np.concatenate([parent.local(in_space(places.points[1 - side])), parent_joint_axes.T.ravel()])
    parent.children.append(group)


def _depth_first(ground: Group) -> list[Group]:
    """Number the groups in depth-first order, the longest path first: groups of a path are then mostly contiguous."""
    groups: list[Group] = []
    stack = [ground]
    while stack:
        group = stack.pop()
        group.number = len(groups)
        groups.append(group)
        stack += sorted(group.children, key=lambda g: g.height)
    return groups


def frame_along(axis: ArrayLike | None) -> Array:
    """Axes x, y, z as columns, shape (3, 3), with z along the axis; earth axes if there is none."""
    if axis is None:
        return np.eye(3)
    z = in_space(axis)
    z = z / np.linalg.norm(z)
    return np.array([*perpendicular(z), z]).T
