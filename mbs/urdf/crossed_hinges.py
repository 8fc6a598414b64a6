"""Two or three hinges with intersecting axes and massless links between them, replaced by a universal or ball joint."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.errors import ModelError

Array = NDArray[np.float64]

POINT_TOLERANCE = 1e-6
"""Largest distance of an axis from the common point, m."""
AXIS_TOLERANCE = 1e-3
"""Least singular value of the unit vectors of independent axes."""


@dataclass(frozen=True)
class CrossedHinges:
    """A chain of hinges, from the parent to the child, that is replaced by a universal or ball joint."""

    hinges: tuple[Any, ...]
    parent: str
    """Name of the first link."""
    child: str
    """Name of the last link."""
    point: Array
    """Intersection of the axes, earth axes, m, shape (3,)."""
    axes: Array
    """Unit vectors of the hinges as drawn, earth axes, shape (n, 3)."""

    @property
    def names(self) -> str:
        """Names of the hinges, for messages."""
        return ", ".join(f"'{joint.name}'" for joint in self.hinges)


def crossed_hinges(
    moving: Mapping[str, Any], group_of: Mapping[str, str], massless: set[str], lines: Mapping[str, tuple[Array, Array]]
) -> list[CrossedHinges]:
    """Find the chains of hinges through groups of links without mass.

    Parameters
    ----------
    moving : mapping of str to joint
        Joints that are not fixed.
    group_of : mapping of str to str
        Group of each link; the links of a group are fixed to each other.
    massless : set of str
        Moving groups without mass.
    lines : mapping of str to (ndarray, ndarray)
        Point, m, and unit vector of the axis of each joint as drawn, earth axes.

    Raises
    ------
    ModelError
        A chain has other joints, or its axes do not intersect or are not independent.
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
                raise _massless_error(group, f"{len(following)} joints move further links against it")
            hinges.append(following[0])
            group = group_of[following[0].child]
        first = group_of[hinges[0].child]
        if any(joint.type == "prismatic" for joint in hinges) or len(hinges) > 3:
            raise _massless_error(
                first, f"the joints {', '.join(repr(j.name) for j in hinges)} are not two or three hinges"
            )
        if follower := next((joint.name for joint in hinges if joint.mimic is not None), None):
            raise _massless_error(first, f"the joint '{follower}' follows another one")
        points, axes = (np.array(column) for column in zip(*(lines[j.name] for j in hinges), strict=True))
        point = _nearest_point(points, axes)
        if np.max(np.linalg.norm(np.cross(points - point, axes), axis=1)) > POINT_TOLERANCE:
            raise _massless_error(
                first, f"the axes of {', '.join(repr(j.name) for j in hinges)} do not meet in one point"
            )
        if np.linalg.svd(axes, compute_uv=False)[-1] < AXIS_TOLERANCE:
            raise _massless_error(
                first, f"the axes of {', '.join(repr(j.name) for j in hinges)} depend on each other as drawn"
            )
        chains.append(CrossedHinges(tuple(hinges), hinges[0].parent, hinges[-1].child, point, axes))
    return chains


def _nearest_point(points: Array, axes: Array) -> Array:
    """Point with the least sum of squared distances from lines, m. `points`, `axes`: shape (n, 3)."""
    projections = [np.eye(3) - np.outer(u, u) for u in axes]
    return np.asarray(
        np.linalg.lstsq(np.sum(projections, axis=0), sum(P @ p for P, p in zip(projections, points, strict=True)))[0]
    )


def _massless_error(group: str, reason: str) -> ModelError:
    """Make the error of a group without mass that cannot be part of a universal or ball joint."""
    return ModelError(
        f"the link '{group}', and what is fixed to it, has no mass and cannot move: {reason}. Give it a small mass and "
        "inertia. Read without are two or three hinges whose axes meet (a universal or a ball joint)."
    )
