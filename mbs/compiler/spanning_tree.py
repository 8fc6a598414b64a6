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

MOST_JOINTS, MOST_CUT_ROWS = 64, 64
"""Largest number of joints: relative coordinates have a dense matrix, and beyond it sparse methods are faster."""
PARALLEL = 1e-9
"""Largest sine of the angle between two axes that count as the same."""
FORMED = ("revolute", "prismatic")
"""Joints that the tree is made of."""


class NoTreeError(Exception):
    """The reason why a model has no tree, a clause for a message."""


@dataclass(eq=False)
class Group:
    """Bodies welded to each other, with one drawing."""

    bodies: list[Body]
    number: int = 0
    """In depth-first order; 0 is the ground."""
    depth: int = 0
    """Joints between the ground and it."""
    parent: Group | None = None
    children: list[Group] = field(default_factory=list)
    slides: bool = False
    origin: Array = field(default_factory=lambda: np.zeros(3))
    axes: Array = field(default_factory=lambda: np.eye(3))
    """`origin`, `axes`, shapes (3,) and (3, 3): the frame (columns x, y, z) in the drawing."""
    base: Array = field(default_factory=lambda: np.zeros(12))
    """Shape (12,): origin and columns of the joint's frame on the parent, in the frame of the parent."""

    @property
    def height(self) -> int:
        """Joints between it and its farthest descendant."""
        return max((1 + child.height for child in self.children), default=0)

    def local(self, point: Array) -> Array:
        """A drawn point in the frame."""
        return np.asarray(self.axes.T @ (point - self.origin))


@dataclass(frozen=True)
class Cut:
    """A joint that closes a loop."""

    joint: Joint
    places: JointPlaces
    groups: tuple[Group, Group]


def spanning_tree(model: Model) -> tuple[list[Group], list[Cut]]:
    """Groups in depth-first order, the ground first, and the joints that are cut.

    Raises `NoTreeError`: with the reason.
    """
    check(model)
    group_of = _welded(model)
    ground = group_of[id(model.ground)]
    joints = [
        (joint, joint.places, _ends(joint.places, group_of))
        for joint in model.joints
        if joint.places is not None and joint.type != "weld"
    ]
    for joint, _, (first, second) in joints:
        if first is second:
            raise NoTreeError(f"joint '{joint.name}' joins bodies that are welded to each other")
    forming: dict[int, list[int]] = {}
    for n, (joint, _, ends) in enumerate(joints):
        if joint.type in FORMED:
            for group in ends:
                forming.setdefault(id(group), []).append(n)
    reached, formed = {id(ground)}, set()
    measured = {frozenset(id(group_of[id(b)]) for b in j.turn.bodies) for j in model.joints if j.turn is not None}
    # prismatic joints first because they cannot be cut, then those whose angle is a coordinate, the others breadth
    # first: short paths, little work
    heap: list[tuple[bool, bool, int, int]] = []

    def offer(group: Group) -> None:
        for n in forming.get(id(group), ()):
            joint, _, ends = joints[n]
            angle = frozenset(map(id, ends)) in measured
            heapq.heappush(heap, (joint.type != "prismatic", not angle, group.depth, n))

    offer(ground)
    while heap:
        n = heapq.heappop(heap)[3]
        joint, places, ends = joints[n]
        new = [side for side, group in enumerate(ends) if id(group) not in reached]
        if not new:
            continue
        group, parent = ends[new[0]], ends[1 - new[0]]
        _attach(group, parent, places, new[0], joint.type == "prismatic")
        formed.add(n)
        reached.add(id(group))
        offer(group)
    for body in model.bodies:
        if id(group_of[id(body)]) not in reached:
            raise NoTreeError(f"no revolute or prismatic joints lead from the ground to body '{body.name}'")
    cuts = [Cut(*entry) for n, entry in enumerate(joints) if n not in formed]
    _check_size(model, len(formed), cuts)
    return _depth_first(ground), cuts


def check(model: Model) -> None:
    """Raise `NoTreeError` for what is not a matter of rigid bodies and their joints."""
    for body in model.bodies:
        if body.is_flexible or body.is_point:
            raise NoTreeError(f"body '{body.name}' is {'flexible' if body.is_flexible else 'a point mass'}")
    if model.guides or model.switches:
        raise NoTreeError("guides or switches move or hold something")
    angles = sum(joint.turn is not None for joint in model.joints)
    if len(model.coordinates) > sum(body.size for body in model.bodies) + angles:
        raise NoTreeError("spins or ports are coordinates of their own")
    for joint in model.joints:
        if joint.places is None and joint.turn is None:
            raise NoTreeError(f"joint '{joint.name}' is neither revolute, prismatic, spherical nor a weld")


def turning(groups: list[Group], joint: Joint) -> list[tuple[int, float]]:
    """The joints whose coordinates add up to a relative angle, by the numbers of their bodies, and their signs.

    Raises `NoTreeError`: where a joint between its bodies turns about another axis.
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
        if np.linalg.norm(np.cross(groups[number].axes[:, 2], axis)) > PARALLEL:
            raise NoTreeError(f"not all joints between the bodies of relative angle '{joint.name}' turn about its axis")
    return sorted(signs.items())


def rows_of(model: Model, cut: Cut) -> tuple[int, int]:
    """Rows of a cut joint: of points and of axes."""
    return model.dimension, 0 if cut.places.axes is None else 2


def _check_size(model: Model, n_joints: int, cuts: list[Cut]) -> None:
    rows = sum(sum(rows_of(model, cut)) for cut in cuts)
    if n_joints > MOST_JOINTS or rows > MOST_CUT_ROWS:
        raise NoTreeError(
            f"there are {n_joints} joints and {rows} rows of loops; at most {MOST_JOINTS} and "
            f"{MOST_CUT_ROWS} are possible"
        )
    for cut in cuts:
        if cut.joint.type == "prismatic":
            raise NoTreeError(f"the prismatic joint '{cut.joint.name}' closes a loop of prismatic joints")


def _welded(model: Model) -> dict[int, Group]:
    """The group of every body by its identity."""
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
    """The frames of a joint on both bodies; `side` is the group's."""
    own_axis, parent_axis = (None, None) if places.axes is None else (places.axes[side], places.axes[1 - side])
    group.parent, group.depth, group.slides = parent, parent.depth + 1, slides
    group.origin, group.axes = in_space(places.points[side]), frame_along(own_axis)
    turned = parent.axes.T @ frame_along(parent_axis)
    group.base = np.concatenate([parent.local(in_space(places.points[1 - side])), turned.T.ravel()])
    parent.children.append(group)


def _depth_first(ground: Group) -> list[Group]:
    """Paths as runs of neighbours, the longest first: what the kernel's loops over a path like."""
    groups: list[Group] = []
    stack = [ground]
    while stack:
        group = stack.pop()
        group.number = len(groups)
        groups.append(group)
        stack += sorted(group.children, key=lambda g: g.height)
    return groups


def frame_along(axis: ArrayLike | None) -> Array:
    """Columns x, y and z with z along the axis, or those of the earth."""
    if axis is None:
        return np.eye(3)
    z = in_space(axis)
    z = z / np.linalg.norm(z)
    return np.array([*perpendicular(z), z]).T
