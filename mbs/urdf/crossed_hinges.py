"""Two or three hinges with intersecting axes and massless links between them, replaced by a universal or ball joint."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.errors import ModelError

Array = NDArray[np.float64]

MEET = 1e-6
"""Distance of an axis from the point where the others meet, m."""
ALIKE = 1e-3
"""Volume of three axes, or sine between two, below which they are not independent."""


@dataclass(frozen=True)
class CrossedHinges:
    """Hinges in the place of a universal or a ball joint, from the parent on."""

    hinges: tuple[Any, ...]
    parent: str
    child: str
    """`parent`, `child`: links of the bodies that they join."""
    point: Array
    """Where their axes meet, earth axes, m."""
    axes: Array
    """Shape (n, 3): of the hinges as drawn, earth axes."""

    @property
    def names(self) -> str:
        """Names of the hinges, for messages."""
        return ", ".join(f"'{joint.name}'" for joint in self.hinges)


def crossed_hinges(
    moving: Mapping[str, Any], group_of: Mapping[str, str], massless: set[str], lines: Mapping[str, tuple[Array, Array]]
) -> list[CrossedHinges]:
    """The chains of hinges through groups of links without mass.

    Parameters
    ----------
    moving : mapping of str to joint
        Joints that are not fixed.
    group_of : mapping of str to str
        The group of links that are fixed to each other of each link.
    massless : set of str
        Groups that move and have no mass.
    lines : mapping of str to (ndarray, ndarray)
        A point (m) and the axis of each joint as drawn, earth axes.

    Raises
    ------
    ModelError
        A chain is neither; the message says what holds the group without mass.
    """
    joint_above = {group_of[joint.child]: joint for joint in moving.values()}
    joints_below: dict[str, list[Any]] = {}
    for joint in moving.values():
        joints_below.setdefault(group_of[joint.parent], []).append(joint)
    chains, pending = [], set(massless)
    for group in sorted(massless, key=lambda g: list(joint_above).index(g)):
        if group not in pending:
            continue
        hinges = [joint_above[group]]
        while group in massless:
            pending.discard(group)
            following = joints_below.get(group, [])
            if len(following) != 1:
                raise _no_mass(group, f"{len(following)} joints move further links against it")
            hinges.append(following[0])
            group = group_of[following[0].child]
        first = group_of[hinges[0].child]
        if any(joint.type == "prismatic" for joint in hinges) or len(hinges) > 3:
            raise _no_mass(first, f"the joints {', '.join(repr(j.name) for j in hinges)} are not two or three hinges")
        if follower := next((joint.name for joint in hinges if joint.mimic is not None), None):
            raise _no_mass(first, f"the joint '{follower}' follows another one")
        points, axes = (np.array(column) for column in zip(*(lines[j.name] for j in hinges), strict=True))
        point = _meeting(points, axes)
        if np.max(np.linalg.norm(np.cross(points - point, axes), axis=1)) > MEET:
            raise _no_mass(first, f"the axes of {', '.join(repr(j.name) for j in hinges)} do not meet in one point")
        if np.linalg.svd(axes, compute_uv=False)[-1] < ALIKE:
            raise _no_mass(
                first, f"the axes of {', '.join(repr(j.name) for j in hinges)} depend on each other as drawn"
            )
        chains.append(CrossedHinges(tuple(hinges), hinges[0].parent, hinges[-1].child, point, axes))
    return chains


def _meeting(points: Array, axes: Array) -> Array:
    """The point next to all lines, m."""
    projections = [np.eye(3) - np.outer(u, u) for u in axes]
    return np.asarray(
        np.linalg.lstsq(np.sum(projections, axis=0), sum(P @ p for P, p in zip(projections, points, strict=True)))[0]
    )


def _no_mass(group: str, why: str) -> ModelError:
    return ModelError(
        f"the link '{group}', and what is fixed to it, has no mass and cannot move: {why}. Give it a small mass and "
        "inertia. Read without are two or three hinges whose axes meet (a universal or a ball joint)."
    )
