"""Local points and vectors of a body, m."""

from collections.abc import Sequence
from math import dist

import numpy as np

from mbs.common.checks import Vector
from mbs.model.body import Body

SAME = 1e-9
SHORT = 1e-3
"""Points of a body nearer than this part of its length give no direction: their round-off would be that of the body."""


def body_length(body: Body) -> float:
    """A length typical of the body, m: the distance of its farthest joint point from its centre of mass, or its
    gyration radius.
    """
    farthest = max((float(np.linalg.norm(p)) for p in body.joint_points), default=0.0)
    gyration = float(np.sqrt(np.trace(body.second_moment) / body.mass)) if body.mass else 0.0
    return farthest if farthest > 0.1 * gyration else gyration


def distinct(vectors: Sequence[Vector], opposites: bool = False) -> list[Vector]:
    """Without repetitions (of directions: nor opposites), in order of first use."""
    unique: list[Vector] = []
    unique_components: list[list[float]] = []
    for v in vectors:
        components, opposite = v.tolist(), (-v).tolist()
        if all(dist(components, w) > SAME and not (opposites and dist(opposite, w) <= SAME) for w in unique_components):
            unique.append(v)
            unique_components.append(components)
    return unique
