"""Cars whose axles are tables that are made of their own links."""

import copy
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mbs import Pose, Simulation, compile
from mbs.vehicle import Car, load
from mbs.vehicle.car import car_from
from mbs.vehicle.kinematics.curve_grid import write_curve_table
from mbs.vehicle.linkages.linkage import Linkage

CARRIERS = ("upright", "half")


def linked_car(name: str) -> Car:
    """A car of the package that tables can stand for: its cross-beam has no stiffness and bears no bar."""
    data = _content(load(name))
    for axle in ("front", "rear"):
        if "torsional_stiffness" in data[axle]["suspension"]:
            data[axle]["suspension"]["torsional_stiffness"] = 20.0
            data[axle].pop("anti_roll_bar", None)
    return car_from(data, load(name).folder, name)


def after_a_turn(car: Car, speed: float, **inputs: float) -> tuple[dict[str, float], dict[str, float]]:
    """Coordinates and outputs of a car after 3 s with constant inputs, by name."""
    simulation = Simulation(compile(car.model()), pose=Pose(speed=speed))
    for name, value in inputs.items():
        simulation.set_input(name, value)
    for _ in range(600):
        simulation.step(0.005)
    names = simulation.system.meta["coordinates"]
    return dict(zip(names, simulation.state.q.tolist(), strict=True)), simulation.sensors


def curved_content(car: Car, folder: Path, axles: Sequence[str] = ("front", "rear")) -> dict[str, Any]:
    """The content of the same car by tables, which are written into a folder."""
    data = _content(car)
    for file in car.folder.glob("*.tir"):
        shutil.copy(file, folder)
    for axle in axles:
        table = data[axle]
        linkage = Linkage(car, axle)
        write_curve_table(linkage, car.steering.rack_travel if axle == "front" else 0.0, folder / f"{axle}.csv")
        suspension, bar = table["suspension"], table.pop("anti_roll_bar", None)
        bodies = suspension["bodies"]
        (carrier,) = (part for key, part in bodies.items() if key in CARRIERS)
        points = suspension["points"]
        links = {key: part | _ends(points, key.split("_")[0]) for key, part in bodies.items() if part is not carrier}
        parts = {"carrier": carrier, "links": links}
        table["suspension"] = {"kind": "curves", "file": f"{axle}.csv", "bodies": parts}
        if bar is not None:
            table["suspension"]["bar"] = {"stiffness": bar["stiffness"]}
        if "torsional_stiffness" in suspension:
            lever = suspension["points"]["pivot"][0] - table["wheel"]["centre"][0]
            table["suspension"]["bar"] = {"stiffness": suspension["torsional_stiffness"], "lever": lever}
    return data


def _ends(points: dict[str, Any], arm: str) -> dict[str, Any]:
    """Of an arm that turns about two bushes."""
    front, rear = (points[f"{arm}_pivot_{end}"] for end in ("front", "rear"))
    return {"points": {"inner": front, "second_inner": rear, "outer": points[f"{arm}_ball_joint"]}}


def _content(car: Car) -> dict[str, Any]:
    data = copy.deepcopy(car._data)
    data["chassis"].pop("frame", None)
    return data
