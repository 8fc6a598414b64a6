"""A step of a car beside one of MuJoCo: ``python -m benchmarks.car_peers [--json FILE]``.

The prototype with links and by tables, alone and in lanes, and a MuJoCo car of the same mass, wheelbase and track on
four sprung wheels (`benchmarks.peers.mujoco_car`), which is given the angles of the rigid car's front wheels: by
`mujoco.rollout` one after the other and on all cores; CommonRoad's multi-body car (`benchmarks.peers.commonroad_car`)
is given their mean. All make the same steps of the same manoeuvres in turn; of three
rounds the least is taken, in seconds in which threads had a core.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from ali3.running import run_command
from benchmarks.car import lanes, manoeuvres
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.machine import describe
from benchmarks.shared.tables import print_table
from mbs import Settings, Trajectory, compile, simulate
from mbs.scenes import prototype_car
from mbs.vehicle import load

SCENES = (("slalom", "slalom", 0.005), ("lane change", "double_lane_change_replay", 0.01))
FIDELITIES = {"links": 0, "tables": 10}
ROUNDS = 3
COLUMNS = {
    "scene": "",
    "step_ms": "g",
    "car": "",
    "way": "",
    "us_a_step": ".1f",
    "cars_in_real_time_a_core": ".0f",
    "yaw_rate": ".3f",
    "speed": ".2f",
}
WORDS = """yaw_rate: the largest, rad/s, and speed: at the end, m/s; they say that the manoeuvres are alike, no more.
MuJoCo's car has no suspension links, no tyre model, no drive and no air: its error against the others is not defined.
CommonRoad's car is a BMW 320i of 1093 kg with axles that roll and rise on springs, 29 states and tyres by the Magic
Formula without relaxation. It coasts; a step is four evaluations (Runge and Kutta's rule).
Not here: a batch on a GPU. Published are 19 250 steps a second for PhysX's cars on one, 52 us a step: a GPU in place
of a core, with other tyres and roads."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("car_peers", __doc__)
    options = parser.parse_args(arguments)
    for module in ("mujoco", "numba", "vehiclemodels"):
        if importlib.util.find_spec(module) is None:
            parser.error(f"{module} is not installed; the extra 'peers' has it")

    def work() -> int:
        rows = [row for scene in watched(SCENES) for row in measure(*scene)]
        print_table(rows, COLUMNS)
        print(f"\n{WORDS}")
        save_rows(options.json, describe("car_peers", Settings(), repeats=ROUNDS), rows)
        return 0

    return run_command(work)


def measure(scene: str, name: str, h: float, seconds: float = lanes.SECONDS) -> list[dict[str, Any]]:
    """Rows of one scene."""
    from benchmarks.peers import commonroad_car, mujoco_car

    runs = {car: _run(name, h, fidelity, seconds) for car, fidelity in FIDELITIES.items()}
    guide = runs["links"]
    angles = np.column_stack([guide[f"wheel_{w}.steer"][1:] for w in mujoco_car.WHEELS[:2]])
    car, cores, count = load(manoeuvres.PROTOTYPE), os.cpu_count() or 1, lanes.CARS
    mass = sum(body.mass for body in car.model().bodies)
    models = [mujoco_car.model(car, mass, h, 1.0 + 0.01 * k) for k in range(count)]
    threads = {"single": 0, f"rollout, {cores} threads": cores}
    spent: dict[tuple[str, str], float] = {}
    rates = states = np.empty(0)

    def take(car: str, way: str, us: float) -> None:
        spent[car, way] = min(us, spent.get((car, way), np.inf))

    for _ in range(ROUNDS):
        for kind, fidelity in FIDELITIES.items():
            for row in lanes.measure(scene, h, partial(lanes.varied_cars, name, fidelity), seconds):
                take(kind, row["way"], row["us_a_step"])
        for way, number in threads.items():
            rates, used = mujoco_car.drive(models, float(guide["speed"][0]), angles, number)
            take("MuJoCo", way, 1e6 * used / (count * len(angles)))
        states, used = commonroad_car.drive(count, float(guide["speed"][0]), h, angles.mean(axis=1))
        take("CommonRoad", "single", 1e6 * used / (count * len(angles)))
    moved = {kind: (run["chassis.wz"], run["speed"]) for kind, run in runs.items()}
    moved["MuJoCo"] = rates[0, :, 5], np.linalg.norm(rates[0, :, :2], axis=1)
    moved["CommonRoad"] = commonroad_car.motion(states)
    return [
        {
            "scene": scene,
            "step_ms": 1e3 * h,
            "car": kind,
            "way": way,
            "us_a_step": us,
            "cars_in_real_time_a_core": h / (1e-6 * us),
            "yaw_rate": float(np.abs(moved[kind][0]).max()),
            "speed": float(moved[kind][1][-1]),
        }
        for (kind, way), us in spent.items()
    ]


def _run(name: str, h: float, fidelity: int, seconds: float) -> Trajectory:
    """The car through the manoeuvre, for its motion alone."""
    manoeuvre, system = manoeuvres.load(name), compile(prototype_car.build(fidelity=fidelity))
    parameters, pose = manoeuvres.start_of(manoeuvre, system)
    inputs = manoeuvres.inputs_of(manoeuvre, system)
    return simulate(system, seconds, h, inputs, parameters=parameters, pose=pose, estimate_error=False, progress=False)


if __name__ == "__main__":
    sys.exit(main())
