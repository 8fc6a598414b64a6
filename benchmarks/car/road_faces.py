"""Wheel loads of a car that coasts up a kerb or a step of a grid."""

from collections.abc import Sequence

import numpy as np

import mbs
from benchmarks.shared.pages import Row, table
from mbs.elements.road import GridRoad, KerbRoad
from mbs.vehicle import load

SPEED = 3.0  # m/s
STEP = 0.001  # s
FACE = 2.0  # m, position of the step along x
HEIGHTS = (0.12, 0.05, 0.02)  # m
SPACINGS = (0.02, 0.05, 0.1, 0.2, 0.25)  # m
COLUMNS = {"height, m": "g", "kerb, kN": ".1f"} | {f"{s:g} m": ".1f" for s in SPACINGS}


def face(height: float, spacing: float) -> GridRoad:
    """A grid with a step of a height, m, at `FACE`, over one spacing, m."""
    x = FACE - spacing * (round(8.0 / spacing) - np.arange(round(18.0 / spacing)))
    heights = np.where(x > FACE + 0.5 * spacing, height, 0.0)
    return GridRoad((float(x[0]), -3.0), (spacing, 1.0), np.repeat(heights[:, None], 7, axis=1))


def peak(car: str, road: GridRoad | KerbRoad) -> float:
    """Largest load of the left front wheel, N."""
    system = mbs.compile(load(car).model(road))
    pose, neutral = mbs.Pose(speed=SPEED), {"selector": 0.0}
    run = mbs.simulate(system, 1.5, STEP, pose=pose, inputs=neutral, estimate_error=False)
    return float(run["wheel_FL.Fz"].max())


def measure(car: str, height: float) -> Row:
    """Row of the table. `height`: height of the step, m."""
    kerb = peak(car, KerbRoad(FACE, height, upper="after"))
    faces = {f"{s:g} m": peak(car, face(height, s)) / 1e3 for s in SPACINGS}
    return {"height, m": height, "kerb, kN": kerb / 1e3, **faces}


def face_table(rows: Sequence[Row]) -> str:
    """Table of the page on roads."""
    return table(rows, COLUMNS)
