"""A step of a car beside cars in other programs: ``python -m benchmarks.car_peers [--json FILE]``.

Compared are the prototype with links and by tables, alone and in lanes; a MuJoCo car of the same mass, wheelbase and
track on four sprung wheels (`benchmarks.peers.mujoco_car`), by `mujoco.rollout` one after the other and on all cores;
an Exudyn car with the same wheel rates and damping too (`benchmarks.peers.exudyn_car`); CommonRoad's multi-body car
(`benchmarks.peers.commonroad_car`). MuJoCo and Exudyn get the angles of the rigid car's front wheels, CommonRoad their
mean. All make the same steps of the same manoeuvres in turn; the least processor time of three rounds counts. Programs
that are not installed are left out and named.
"""

import importlib.util
import os
import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmarks.car import lanes, manoeuvres, rig
from benchmarks.shared.command import Part, report_missing, run, watched
from benchmarks.shared.pages import Row, table
from mbs import Trajectory, compile, simulate
from mbs.scenes import prototype_car
from mbs.vehicle import Car, load

Array: TypeAlias = NDArray[np.float64]
Drive: TypeAlias = Callable[[], tuple[tuple[Array, Array], float]]
"""Returns yaw rate, rad/s, and speed, m/s, of a car, shape (steps,), and the processor time of all cars, s."""
SCENES = (("slalom", "slalom", 0.005), ("lane change", "double_lane_change_replay", 0.01))
FIDELITIES = {"links": 0, "tables": 10}
TITLES = {"links": "with links", "tables": "by tables"}
ROUNDS = 3
MODULES = {"MuJoCo": ("mujoco",), "Exudyn": ("exudyn",), "CommonRoad": ("numba", "vehiclemodels")}
"""Other programs and the modules that their cars need."""


def _rows(options: Namespace) -> list[dict[str, Any]]:
    missing = [
        car for car, modules in MODULES.items() if not all(importlib.util.find_spec(module) for module in modules)
    ]
    for car in missing:
        report_missing(f"{car}'s car: {' and '.join(MODULES[car])} not installed (python -m pip install 'ali3[peers]')")
    installed = [car for car in MODULES if car not in missing]
    return [row for scene in watched(SCENES) for row in measure(*scene, peers=installed)]


def measure(
    scene: str, name: str, h: float, seconds: float = lanes.SECONDS, peers: Sequence[str] = tuple(MODULES)
) -> list[dict[str, Any]]:
    """Rows of a scene. `name`: its manoeuvre; `h`: step, s; `seconds`: length of the run, s."""
    runs = {car: _run(name, h, fidelity, seconds) for car, fidelity in FIDELITIES.items()}
    linked = runs["links"]
    angles = np.column_stack([linked[f"wheel_{w}.steer"][1:] for w in ("FL", "FR")])
    drives = {car: _DRIVES[car](float(linked["speed"][0]), h, angles) for car in peers}
    times: dict[tuple[str, str], float] = {}
    motions = {kind: (run["chassis.wz"], run["speed"]) for kind, run in runs.items()}

    def record(car: str, way: str, us: float) -> None:
        times[car, way] = min(us, times.get((car, way), np.inf))

    for _ in range(ROUNDS):
        for kind, fidelity in FIDELITIES.items():
            for row in lanes.measure(scene, h, partial(lanes.varied_cars, name, fidelity), seconds):
                record(kind, row["way"], row["us_a_step"])
        for car, ways in drives.items():
            for way, drive in ways.items():
                motions[car], cpu_time = drive()
                record(car, way, 1e6 * cpu_time / (lanes.CARS * len(angles)))
    return [
        {
            "scene": scene,
            "step_ms": 1e3 * h,
            "car": kind,
            "way": way,
            "us_a_step": us,
            "yaw_rate": float(np.abs(motions[kind][0]).max()),
            "speed": float(motions[kind][1][-1]),
        }
        for (kind, way), us in times.items()
    ]


def _mujoco(speed: float, h: float, angles: Array) -> dict[str, Drive]:
    from benchmarks.peers import mujoco_car

    cores = os.cpu_count() or 1
    models = [mujoco_car.model(*_prototype(), h, 1.0 + 0.01 * k) for k in range(lanes.CARS)]

    def run(threads: int) -> tuple[tuple[Array, Array], float]:
        rates, cpu_time = mujoco_car.drive(models, speed, angles, threads)
        return (rates[0, :, 5], np.linalg.norm(rates[0, :, :2], axis=1)), cpu_time

    return {"single": partial(run, 0), f"rollout, {cores} threads": partial(run, cores)}


def _exudyn(speed: float, h: float, angles: Array) -> dict[str, Drive]:
    from benchmarks.peers import exudyn_car

    car, mass = _prototype()
    curves = rig.kinematics(car)

    def run() -> tuple[tuple[Array, Array], float]:
        rates, cpu_time = exudyn_car.drive(car, mass, speed, h, angles, curves, lanes.CARS)
        return (rates[:, exudyn_car.YAW], np.linalg.norm(rates[:, :2], axis=1)), cpu_time

    return {"single": run}


def _commonroad(speed: float, h: float, angles: Array) -> dict[str, Drive]:
    from benchmarks.peers import commonroad_car

    def run() -> tuple[tuple[Array, Array], float]:
        states, cpu_time = commonroad_car.drive(lanes.CARS, speed, h, angles.mean(axis=1))
        return commonroad_car.motion(states), cpu_time

    return {"single": run}


_DRIVES = {"MuJoCo": _mujoco, "Exudyn": _exudyn, "CommonRoad": _commonroad}


def _prototype() -> tuple[Car, float]:
    """The car and its mass, kg."""
    car = load(manoeuvres.PROTOTYPE)
    return car, sum(body.mass for body in car.model().bodies)


def _run(name: str, h: float, fidelity: int, seconds: float) -> Trajectory:
    """Simulate the car in the manoeuvre."""
    manoeuvre, system = manoeuvres.load(name), compile(prototype_car.build(fidelity=fidelity))
    parameters, pose = manoeuvres.start_of(manoeuvre, system)
    inputs = manoeuvres.inputs_of(manoeuvre, system)
    return simulate(system, seconds, h, inputs, parameters=parameters, pose=pose, estimate_error=False, progress=False)


def peer_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of the processor time of a step, us, by car, way and scene."""
    lines: dict[tuple[str, str], dict[str, Any]] = {}
    for row in rows:
        line = lines.setdefault(
            (row["car"], row["way"]), {"car": TITLES.get(row["car"], row["car"]), "way": row["way"]}
        )
        line[lanes.scene_of(row)] = row["us_a_step"]
    columns = {"car": "", "way": ""} | dict.fromkeys(map(lanes.scene_of, rows), ".1f")
    return {"car peers": table(list(lines.values()), columns)}


PARTS = {
    "car peers": Part("cars of other programs beside the prototype", _rows, pages=("speed.md",), blocks=peer_blocks)
}

main = partial(run, "car_peers", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
