"""Deviations of grids from the OpenCRG files that they are sampled from, by spacing."""

from collections.abc import Sequence
from pathlib import Path

from benchmarks.shared.pages import table
from mbs.roads import SampledRoad, read_road

FOLDER = Path(__file__).parents[2] / "tests" / "data" / "crg"
FILES = ("handmade_circle.crg", "handmade_curved_banked_sloped.crg")
SPACINGS = (0.25, 0.1, 0.05)  # m


def sampled_table(spacings: Sequence[float] = SPACINGS) -> str:
    """Table of the largest deviation and its root mean square, mm. `spacings`: m."""
    rows = []
    for name in FILES:
        for spacing in spacings:
            road = read_road(FOLDER / name, spacing=(spacing, spacing))
            assert isinstance(road, SampledRoad)
            deviations = {"at most, mm": 1e3 * road.largest, "rms, mm": 1e3 * road.rms}
            rows.append({"file": f"`{name}`", "spacing, m": spacing, **deviations})
    return table(rows, {"file": "", "spacing, m": "g", **dict.fromkeys(deviations, ".2g")})
