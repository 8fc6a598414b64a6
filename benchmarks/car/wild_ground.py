"""Ground for wild driving: kerbs across a rough half, ramps on a smooth one, level beyond."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

import mbs
from hosts.driving.wild_driver import Target
from mbs.elements.road import GridRoad

EDGE, SPACING = 150.0, 0.25  # m: half the side of the square, between points
KERB, KERB_LENGTH, KERB_DISTANCE = 0.08, 2.0, 15.0  # m
ROUGHNESS = 0.01  # m, standard deviation before smoothing
RAMPS = ((25.0, -75.0, 0.3), (25.0, 0.0, 0.5), (25.0, 75.0, 0.7), (75.0, -37.5, 1.0), (75.0, 37.5, 1.0))
"""Place of the lower edge and height at the upper one, m; they rise along x."""
RAMP_LENGTH, RAMP_WIDTH, FRICTION = 8.0, 6.0, 0.9


def write_ground(file: Path) -> list[Target]:
    """Write the road file; the same bytes each time."""
    n = round(2.0 * EDGE / SPACING)
    x = SPACING * np.arange(n) - EDGE
    rough = np.random.Generator(np.random.PCG64(3)).normal(0.0, ROUGHNESS, (n, n))
    rough = 0.5 * (rough + np.roll(rough, 1, 0) + np.roll(rough, 1, 1) + np.roll(rough, -1, 0))
    heights = np.where(x[:, None] < 0.0, rough, 0.0)
    heights[(x < 0.0) & ((x + EDGE) % KERB_DISTANCE < KERB_LENGTH)] += KERB
    for x0, y0, top in RAMPS:
        along, across = (x >= x0) & (x < x0 + RAMP_LENGTH), np.abs(x - y0) < 0.5 * RAMP_WIDTH
        heights[np.ix_(along, across)] = top * ((x[along] - x0) / RAMP_LENGTH)[:, None]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mbs.roads.RoadWarning)  # ramps end in a drop; rough driving is what it is for
        mbs.write_road(GridRoad((-EDGE, -EDGE), (SPACING, SPACING), heights, FRICTION), file)
    return [Target(x0, y0, 0.0) for x0, y0, _ in RAMPS]
