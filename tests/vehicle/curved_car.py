"""Cars whose axles are tables that are made of their own links."""

from __future__ import annotations

import copy
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from mbs import Pose, Simulation, compile
from mbs.vehicle import Car, load
from mbs.vehicle.car import car_from
from mbs.vehicle.linkages.curve_grid import write_curve_table
from mbs.vehicle.linkages.linkage import Linkage

Mass: TypeAlias = "tuple[float, NDArray[np.float64], NDArray[np.float64]]"
LIGHT = {"mass": 0.2, "inertia": [0.002, 0.002, 0.002]}
CARRIERS = ("upright", "half")


def light_armed(name: str) -> Car:
    """A car of the package whose arms are so light that they may be left out, and whose carriers weigh as much more."""
    data = _content(load(name))
    for axle in ("front", "rear"):
        bodies = data[axle]["suspension"]["bodies"]
        (carrier,) = (part for key, part in bodies.items() if key in CARRIERS)
        for key, part in bodies.items():
            if key not in CARRIERS:
                carrier["mass"] += part["mass"] - LIGHT["mass"]
                part |= LIGHT
        if "torsional_stiffness" in data[axle]["suspension"]:  # a table has no cross-beam
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
    chassis = data["chassis"]
    fixed: list[Mass] = [(chassis["mass"], np.array(chassis["com"]), np.array(car.chassis.tensor))]
    for file in car.folder.glob("*.tir"):
        shutil.copy(file, folder)
    for axle in axles:
        table = data[axle]
        linkage = Linkage(car, axle)
        write_curve_table(linkage, car.steering.rack_travel if axle == "front" else 0.0, folder / f"{axle}.csv")
        suspension, bar = table["suspension"], table.pop("anti_roll_bar", None)
        on, off = _shares(linkage, suspension)
        fixed += [(mass, place * [1.0, side, 1.0], inertia) for mass, place, inertia in off for side in (1.0, -1.0)]
        mass, com, inertia = _together(on)
        part = {"mass": mass, "com": com.tolist(), "inertia": np.diag(inertia).tolist()}
        table["suspension"] = {"kind": "curves", "file": f"{axle}.csv", "bodies": {"carrier": part}}
        if bar is not None:
            table["suspension"]["bar"] = {"stiffness": bar["stiffness"]}
        if "torsional_stiffness" in suspension:
            lever = suspension["points"]["pivot"][0] - table["wheel"]["centre"][0]
            table["suspension"]["bar"] = {"stiffness": suspension["torsional_stiffness"], "lever": lever}
    mass, com, inertia = _together(fixed)
    chassis |= {"mass": mass, "com": com.tolist(), "inertia": np.diag(inertia).tolist()}
    chassis["products"] = [float(inertia[pair]) for pair in ((0, 1), (0, 2), (1, 2))]
    return data


def _shares(linkage: Linkage, suspension: dict[str, Any]) -> tuple[list[Mass], list[Mass]]:
    """What of a side moves with the wheel and what stays: of an arm so much that its weight does the same work."""
    on, off = [], []
    way = linkage.drawn.tangent[:, 0] + linkage.drawn.tangent[:, 1]
    for key, part in suspension["bodies"].items():
        mass, com = part["mass"], np.array(part["com"])
        if key in CARRIERS:
            on.append((mass, com, np.diag(part["inertia"])))
            continue
        ball = np.array(suspension["points"][f"{key.split('_')[0]}_ball_joint"])
        (body,) = (b for b in linkage.model.bodies if b.name.startswith(key.replace("_", " ")) and b.name.endswith("L"))
        of_com, of_ball = ((linkage.linear(body.point(p))[0] @ way)[2] for p in (com, ball))
        share = of_com / of_ball
        on.append((share * mass, ball, np.zeros((3, 3))))
        off.append(((1.0 - share) * mass, (com - share * ball) / (1.0 - share), np.zeros((3, 3))))
    return on, off


def _together(parts: Sequence[Mass]) -> Mass:
    """Mass, centre and inertia of parts."""
    mass = float(sum(m for m, _, _ in parts))
    com = np.asarray(sum(m * r for m, r, _ in parts)) / mass
    away = [(m, r - com, own) for m, r, own in parts]
    return mass, com, np.asarray(sum(own + m * (r @ r * np.eye(3) - np.outer(r, r)) for m, r, own in away))


def _content(car: Car) -> dict[str, Any]:
    data = copy.deepcopy(car._data)
    data["chassis"].pop("frame", None)
    return data
