"""Local points and vectors of a body, m."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbs.common.checks import Vector
from mbs.model.body import Body


def body_length(body: Body) -> float:
    """A length typical of the body, m: the distance of its farthest joint point from its centre of mass, or its
    gyration radius.
    """
    farthest = max((float(np.linalg.norm(p)) for p in body.joint_points), default=0.0)
    gyration = float(np.sqrt(np.trace(body.second_moment) / body.mass)) if body.mass else 0.0
    return farthest if farthest > 0.1 * gyration else gyration


def distinct(vectors: Sequence[Vector], opposites: bool = False) -> list[Vector]:
    """Without repetitions (of directions: nor opposites), in order of first use."""
    found: list[Vector] = []
    for v in vectors:
        gaps = [min(np.linalg.norm(v - w), np.linalg.norm(v + w) if opposites else np.inf) for w in found]
        if all(gap > 1e-9 for gap in gaps):
            found.append(v)
    return found
