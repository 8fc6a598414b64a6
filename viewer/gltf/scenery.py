"""What of the scenery of a world stands by the way."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from viewer.poses import Vectors

_MOST_TREES = 1500


def by_the_way(things: Sequence[Mapping[str, Any]], low: Vectors, high: Vectors) -> list[Mapping[str, Any]]:
    """Entries of the list `scenery` of a scene that stand in a rectangle, of trees at most 1500.

    `low`, `high`: x and y of its corners, m, shape (2,).
    """
    found = []
    trees = 0
    for thing in things:
        points = np.array(thing.get("points") or [thing["at"]], float)[:, :2]
        if (points.max(axis=0) < low).any() or (points.min(axis=0) > high).any():
            continue
        trees += thing["kind"] == "tree"
        if thing["kind"] != "tree" or trees <= _MOST_TREES:
            found.append(thing)
    return found
