"""Wheel loads at a kerb and at faces of grids, which a car climbs in neutral."""

from collections.abc import Sequence

import numpy as np

import mbs
from benchmarks.shared.pages import Row, table
from mbs.elements.road import GridRoad, KerbRoad
from mbs.vehicle import load

SPEED = 3.0  # m/s
STEP = 0.001  # s
FACE = 2.0  # m from the start of the car
HEIGHTS = (0.12, 0.05, 0.02)  # m
SPACINGS = (0.02, 0.05, 0.1, 0.2, 0.25)  # m
COLUMNS = {"height, m": "g", "kerb, kN": ".1f"} | {f"{s:g} m": ".1f" for s in SPACINGS}


def face(height: float, spacing: float) -> GridRoad:
    """Level, then level and higher from FACE on, between two points."""
    x = FACE - spacing * (round(8.0 / spacing) - np.arange(round(18.0 / spacing)))
    heights = np.where(x > FACE + 0.5 * spacing, height, 0.0)
    return GridRoad((float(x[0]), -3.0), (spacing, 1.0), np.repeat(heights[:, None], 7, axis=1))


def peak(car: str, road: GridRoad | KerbRoad) -> float:
    """Largest load of the left front wheel while it climbs, N."""
    system = mbs.compile(load(car).model(road))
    pose, neutral = mbs.Pose(speed=SPEED), {"selector": 0.0}
    run = mbs.simulate(system, 1.5, STEP, pose=pose, inputs=neutral, estimate_error=False)
    return float(run["wheel_FL.Fz"].max())


def measure(car: str, height: float) -> Row:
    """A row of the table, kN."""
    kerb = peak(car, KerbRoad(FACE, height, upper="after"))
    faces = {f"{s:g} m": peak(car, face(height, s)) / 1e3 for s in SPACINGS}
    return {"height, m": height, "kerb, kN": kerb / 1e3, **faces}


def face_table(rows: Sequence[Row]) -> str:
    """The table of the page of roads."""
    return table(rows, COLUMNS)
