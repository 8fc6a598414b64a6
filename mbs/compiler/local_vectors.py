"""Distinct local points and vectors of a body, m, and its typical length."""

from collections.abc import Sequence
from math import dist

import numpy as np

from mbs.common.checks import Vector
from mbs.model.body import Body

EQUAL = 1e-9
"""Largest distance of equal vectors, m."""
MIN_DISTANCE = 1e-3
"""Least distance of two points that define a direction, parts of the length of their body, for its round-off."""


def body_length(body: Body) -> float:
    """Typical length of a body, m: distance of its farthest joint point from its centre of mass, or gyration radius."""
    farthest = max((float(np.linalg.norm(p)) for p in body.joint_points), default=0.0)
    gyration = float(np.sqrt(np.trace(body.second_moment) / body.mass)) if body.mass else 0.0
    return farthest if farthest > 0.1 * gyration else gyration


def distinct(vectors: Sequence[Vector], undirected: bool = False) -> list[Vector]:
    """Vectors without repetitions, in order of first use; `undirected`: a negative is a repetition."""
    unique: list[Vector] = []
    unique_components: list[list[float]] = []
    for v in vectors:
        components, opposite = v.tolist(), (-v).tolist()
        if all(
            dist(components, w) > EQUAL and not (undirected and dist(opposite, w) <= EQUAL) for w in unique_components
        ):
            unique.append(v)
            unique_components.append(components)
    return unique
