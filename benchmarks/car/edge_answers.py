"""Wheel loads of a car that coasts up an edge: a kerb, and contact planes that another program may return."""

from collections.abc import Sequence
from functools import cache

import numpy as np

import mbs
from benchmarks.car.road_faces import SPEED
from benchmarks.shared.pages import Row, table
from hosts.common.wheels import WHEELS
from mbs.elements.road import ANSWER, KerbRoad
from mbs.vehicle import load

EDGE = 0.9  # m, position of the edge along x
STEP = 0.002  # s
TIME = 1.0  # s, length of a run
UP = np.array([0.0, 0.0, 1.0])
EDGES = [
    *(("hatchback", h) for h in (0.01, 0.02, 0.05, 0.08, 0.12)),
    *(("prototype", h) for h in (0.02, 0.05, 0.08)),
]  # m
HEIGHT = "height below"
DEEPER = "deeper of both"
SUM = "sum of both"
COLUMNS = {"car": "", "edge, m": "g", "kerb, kN": ".2f"} | dict.fromkeys((HEIGHT, DEEPER, SUM), ".2f")
COLUMNS |= {f"turn, {name}": ".2f" for name in (DEEPER, SUM)}


def contact_plane(kind: str, edge: float, centre: np.ndarray, radius: float, contact_x: float) -> tuple[float, ...]:
    """Point and normal of the contact plane for a wheel near an edge.

    `kind`: `HEIGHT`: level, at the height of the road below the contact; `DEEPER`: plane of the edge, with the normal
    towards the wheel centre, or level ground, whichever has the larger penetration; `SUM`: the plane whose penetration
    vector is the sum of both; `edge`: its height, m; `centre`: wheel centre in earth axes, m; `radius`, `contact_x`: m.
    """
    if kind == HEIGHT:
        return (contact_x, float(centre[1]), edge if contact_x >= EDGE else 0.0, *UP)
    from_edge = np.array([min(centre[0] - EDGE, 0.0), 0.0, centre[2] - edge])
    distance, ground = float(np.linalg.norm(from_edge)), radius - centre[2] if centre[0] < EDGE else -np.inf
    depth = UP * ground if centre[0] < EDGE else UP * (radius - distance)
    if distance < radius:
        at_edge = (radius - distance) / distance * from_edge
        if kind == SUM:
            depth = at_edge + UP * max(ground, 0.0)
        elif radius - distance > ground:
            depth = at_edge
    penetration = float(np.linalg.norm(depth)) * (1.0 if depth[2] > 0.0 else -1.0)
    normal = depth / penetration if penetration else UP
    return (*(centre - normal * (radius - penetration)), *normal)


@cache
def car_with_road_port(car: str) -> mbs.System:
    """A car whose contact planes are inputs; the same for all edges and kinds of planes."""
    return mbs.compile(load(car).changed({"ports.road": "planes"}).model())


def climb(car: str, edge: float, kind: str = "", time: float = TIME) -> tuple[float, float, mbs.Simulation]:
    """Simulate a car that coasts up an edge: on a kerb, or on contact planes of a kind, updated every `STEP`.

    `edge`: its height, m. Returns the largest load of the left front wheel, N; the largest length of the difference of
    two successive normals of a wheel; the car at the end.
    """
    data = load(car)
    system = car_with_road_port(car) if kind else mbs.compile(data.model(KerbRoad(EDGE, edge, upper="after")))
    s = mbs.Simulation(system, pose=mbs.Pose(speed=SPEED), inputs={"selector": 0.0})
    radius, largest_load, largest_turn = {"F": data.front.tyre.radius, "R": data.rear.tyre.radius}, 0.0, 0.0
    last_normals = dict.fromkeys(WHEELS, UP)
    for _ in range(round(time / STEP)):
        sensors = s.sensors
        largest_load = max(largest_load, sensors["wheel_FL.Fz"])
        for w in WHEELS if kind else ():
            centre = np.array([sensors[f"wheel_{w}.{a}"] for a in "xyz"])
            road = contact_plane(kind, edge, centre, radius[w[0]], sensors[f"wheel_{w}.contact_x"])
            largest_turn, last_normals[w] = (
                max(largest_turn, float(np.linalg.norm(last_normals[w] - road[3:]))),
                np.array(road[3:]),
            )
            for name, value in zip(ANSWER, (*road, data.road.friction), strict=True):
                s.set_input(f"wheel_{w}.road_{name}", float(value))
        s.step(STEP)
    return largest_load, largest_turn, s


def measure(car: str, edge: float) -> Row:
    """Row of the table. `edge`: its height, m."""
    loads, normal_changes = {}, {}
    for name in (HEIGHT, DEEPER, SUM):
        loads[name], normal_changes[f"turn, {name}"], _ = climb(car, edge, name)
    del normal_changes[f"turn, {HEIGHT}"]
    return {
        "car": car,
        "edge, m": edge,
        "kerb, kN": climb(car, edge)[0] / 1e3,
        **{name: load / 1e3 for name, load in loads.items()},
        **normal_changes,
    }


def edge_table(rows: Sequence[Row]) -> str:
    """Table of the page on FMUs."""
    return table(rows, COLUMNS)
