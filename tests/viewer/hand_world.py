"""A world written by hand: a hill, a kerb, patches of different spacing, a lane of each surface, all scenery."""

from itertools import pairwise
from typing import Any

import numpy as np

from tests.viewer.hand_scenes import floats, octets

NAMES = ["asphalt", "concrete", "grass", "gravel", "wet", "ice", "paint", "dirt"]
FRICTIONS = [1.0, 1.0, 0.5, 0.6, 0.55, 0.12, 0.9, 0.55]
HALF = 200.0
"""Half the side of the world, m."""
LANES = dict(zip(NAMES, (-2.0, 5.0, 22.0, 9.0, 1.5, 13.0, -9.0, 17.0), strict=True))
"""y of a place in the lane of each surface, at x = 20 m."""


def height(x: Any, y: Any) -> np.ndarray:
    """Level near the origin, a hill ahead, a kerb of 8 cm at x = -20 m on the right, a valley to the left; m."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    hill = 6.0 * np.exp(-(((x - 120.0) / 30.0) ** 2) - ((y + 40.0) / 40.0) ** 2)
    valley = -4.0 / (1.0 + np.exp(-(y - 90.0) / 8.0))
    kerb = np.where((x > -26.0) & (x < -20.0) & (y > -12.0) & (y < -4.0), 0.08, 0.0)
    return np.where(np.abs(hill) < 1e-4, 0.0, hill) + np.where(y > 40.0, valley, 0.0) + kerb


def patch(x0: float, y0: float, x1: float, y1: float, spacing: tuple[float, float]) -> dict[str, Any]:
    n, m = (round((b - a) / d) + 1 for a, b, d in ((x0, x1, spacing[0]), (y0, y1, spacing[1])))
    x, y = x0 + spacing[0] * np.arange(n), y0 + spacing[1] * np.arange(m)
    return {
        "origin": [x0, y0],
        "spacing": list(spacing),
        "shape": [n, m],
        "heights": floats(height(x[:, None], y[None, :])),
    }


def surface(dx: float = 0.0, dy: float = 0.0) -> dict[str, Any]:
    """Lanes along x of 4 m each, all grass away from the road."""
    d, n = 0.5, round(2 * HALF / 0.5)
    y = -HALF + d * (np.arange(n) + 0.5)
    classes = np.full((n, n), NAMES.index("grass"), np.uint8)
    for name, low, high in (
        ("asphalt", -6.0, 0.0),
        ("wet", 0.0, 3.0),
        ("concrete", 3.0, 7.0),
        ("gravel", 7.0, 11.0),
        ("ice", 11.0, 15.0),
        ("dirt", 15.0, 19.0),
        ("paint", -10.0, -8.0),
        ("asphalt", -8.0, -6.0),
    ):
        classes[:, (y > low) & (y < high)] = NAMES.index(name)
    return {
        "origin": [-HALF + d / 2 + dx, -HALF + d / 2 + dy],
        "spacing": [d, d],
        "shape": [n, n],
        "classes": octets(classes),
        "names": NAMES,
        "frictions": FRICTIONS,
    }


def terrain(dx: float = 0.0, dy: float = 0.0) -> dict[str, Any]:
    """Nine patches: fine about the road and the kerb, coarse around; all of it may stand elsewhere."""
    cuts = (-HALF, -40.0, 160.0, HALF)
    across = (-HALF, -40.0, 40.0, HALF)
    patches = []
    for a, (x0, x1) in enumerate(pairwise(cuts)):
        for b, (y0, y1) in enumerate(pairwise(across)):
            spacing = (0.5, 0.5) if a == b == 1 else (4.0, 4.0)
            patch_road = patch(x0, y0, x1, y1, spacing)
            patches.append(patch_road | {"origin": [x0 + dx, y0 + dy]})
    return {"kind": "terrain", "patches": patches, "surface": surface(dx, dy)}


def scenery() -> list[dict[str, Any]]:
    """One of each kind and a row of some."""
    x = np.arange(-100.0, 181.0, 5.0)
    edge = [[[float(a), b, float(height(a, b))] for a in x] for b in (-6.0, 3.0, 0.0)]
    results: list[dict[str, Any]] = [
        {"kind": "line", "points": edge[0], "width": 0.15, "colour": "white"},
        {"kind": "line", "points": edge[1], "width": 0.15, "colour": "yellow"},
        {"kind": "line", "points": edge[2], "width": 0.12, "colour": "white", "dash": [3.0, 6.0]},
        {"kind": "barrier", "points": [[a, -12.0, float(height(a, -12.0))] for a in x.tolist()], "height": 0.8},
        {"kind": "building", "at": [60.0, 34.0, 0.0], "yaw": 0.2, "size": [16.0, 9.0, 7.0]},
        {"kind": "building", "at": [20.0, 36.0, 0.0], "yaw": 0.0, "size": [10.0, 8.0, 5.0]},
        {"kind": "sign", "at": [22.0, -7.5, 0.0], "yaw": 0.0, "text": "wet lane", "height": 2.5},
        {"kind": "sign", "at": [42.0, -7.5, 0.0], "yaw": 0.0, "text": "double lane change ISO 3888", "height": 2.5},
        {"kind": "arrow", "at": [10.0, -3.0, 0.0], "yaw": 0.0, "length": 4.0},
    ]
    results += [{"kind": "cone", "at": [a, -3.5, 0.0], "height": 0.5} for a in (14.0, 20.0, 26.0, 32.0)]
    results += [{"kind": "post", "at": [a, -7.0, 0.0], "height": 1.0} for a in np.arange(-50.0, 60.0, 25.0).tolist()]
    chance = np.random.default_rng(3)
    for seed in range(300):
        a, b = chance.uniform(-190, 190), chance.choice([-1.0, 1.0]) * chance.uniform(26, 120)
        results.append(
            {"kind": "tree", "at": [a, b, float(height(a, b))], "height": float(chance.uniform(5, 14)), "seed": seed}
        )
    return results
