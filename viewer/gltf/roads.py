"""Roads of a scene as triangles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from viewer.poses import Vectors
from viewer.scene_relations import decoded
from viewer.solids import Solid

_MOST = 200  # points of a grid in each direction


def flat_road(height: float, low: Vectors, high: Vectors) -> Solid:
    """A level rectangle."""
    x, y = (low[0], high[0]), (low[1], high[1])
    corners = np.array([[x[0], y[0], height], [x[1], y[0], height], [x[1], y[1], height], [x[0], y[1], height]])
    return Solid(corners, np.tile([0.0, 0.0, 1.0], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def grid_road(road: Mapping[str, Any]) -> tuple[Solid, int]:
    """Triangles of a grid of heights, and of how many points in a row one is drawn."""
    nx, ny = road["shape"]
    heights = decoded(road["heights"], "f").reshape(nx, ny).astype(float)
    every = max(1, -(-max(nx, ny) // _MOST))
    i, j = (np.unique([*range(0, n, every), n - 1]) for n in (nx, ny))
    x = road["origin"][0] + road["spacing"][0] * i
    y = road["origin"][1] + road["spacing"][1] * j
    points = np.stack([*np.meshgrid(x, y, indexing="ij"), heights[np.ix_(i, j)]], axis=2).reshape(-1, 3)
    a = (np.arange(len(i) - 1)[:, None] * len(j) + np.arange(len(j) - 1)).ravel()
    b = a + len(j)
    return Solid(points, None, np.vstack([np.column_stack([a, b, b + 1]), np.column_stack([a, b + 1, a + 1])])), every
