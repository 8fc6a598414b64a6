"""The prototype with frames of other kinds."""

import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from mbs.vehicle import Car, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content
from mbs.vehicle.chassis.frames.tubes import TubesFrame, TubularFrame
from mbs.vehicle.chassis.gauges.matrix_gauges import AXES
from mbs.vehicle.chassis.gauges.reading import Reading
from mbs.vehicle.read_car import CARS

PROTOTYPE = load("prototype")
SMALL_JOINTS = {
    "aL": (0.15, 0.3, 0.165), "bL": (-0.15, 0.3, 0.165), "cL": (0.13, 0.35, 0.372), "dL": (-0.13, 0.35, 0.372),
    "eL": (-0.1457, 0.3109, 0.21), "fL": (0.0, 0.38, 0.785), "gL": (-2.12, 0.3, 0.19), "hL": (-2.38, 0.3, 0.19),
    "iL": (-2.48, 0.3, 0.2), "jL": (-2.3, 0.455, 0.927), "kL": (-0.6, 0.45, 0.16), "lL": (-1.6, 0.45, 0.16),
    "mL": (-0.6, 0.45, 0.7), "nL": (-1.6, 0.45, 0.8), "oc": (-1.1, 0.0, 0.16), "pL": (-1.1, 0.45, 0.16),
}  # fmt: skip
SMALL_TUBES = [
    "aL bL", "aL cL", "bL eL", "eL dL", "cL dL", "cL fL", "dL fL", "aL dL", "bL kL", "dL mL", "fL mL", "kL mL", "bL mL",
    "kL pL", "pL lL", "pL oc", "mL nL", "lL nL", "kL nL", "lL gL", "gL hL", "hL iL", "nL jL", "gL jL", "hL jL", "iL jL",
    "lL jL", "aL aR", "bL bR", "fL fR", "mL mR", "nL nR", "gL gR", "iL iR", "jL jR", "kL oc", "lL oc", "kL lR", "cL cR",
    "dL dR", "hL hR",
]  # fmt: skip
SMALL_MASSES = {"pL": 82.6845, "lL": 45.0, "nL": 20.0, "gL": 25.0, "kL": 10.0, "aL": 10.0}

SMALL_GAUGES = {
    "F": {"tube": ["bL", "kL"], "place": 0.25},
    "G": {"tube": ["lL", "gL"], "place": 0.5, "bridge": "quarter", "fibre": "left"},
    "H": {"tube": ["kL", "pL"], "place": 0.5, "bridge": "axial"},
}


def prototype_with(
    frame: dict[str, Any], folder: Path, chassis: dict[str, Any] | None = None, changes: dict[str, Any] | None = None
) -> Car:
    """The prototype with another table chassis.frame, other numbers of the chassis and elsewhere."""
    data = changed_content(PROTOTYPE._data, changes or {}, "car")
    data["chassis"] = {**data["chassis"], **(chassis or {}), "frame": frame}
    return car_from(data, folder, "car 'prototype'")


def copied(folder: Path) -> Path:
    """The prototype's folder at another place."""
    return Path(shutil.copytree(CARS / "prototype", folder / "car"))


def small_frame(folder: Path) -> Car:
    """The prototype with a small frame of its own, whose mass, centre and inertia the chassis takes."""
    joints = ["joint,x,y,z", *(f"{name},{x},{y},{z}" for name, (x, y, z) in SMALL_JOINTS.items())]
    tubes = ["from,to,section,elements", *(f"{t.replace(' ', ',')},T,2" for t in SMALL_TUBES)]
    masses = ["# carried", "joint,mass", *(f"{joint},{mass}" for joint, mass in SMALL_MASSES.items())]
    for name, lines in (("joints", joints), ("tubes", tubes), ("masses", masses)):
        (folder / f"{name}.csv").write_text("\n".join(lines) + "\n")
    frame = {
        "kind": "tubes",
        "joints": "joints.csv",
        "tubes": "tubes.csv",
        "masses": "masses.csv",
        "material": {"E": 2.1e11, "nu": 0.3, "rho": 7850.0},
        "sections": {"T": {"diameter": 0.042, "wall": 0.0022}},
        "damping": {"ratio": 0.02, "frequencies": [15.0, 60.0]},
        "gauges": SMALL_GAUGES,
    }
    section = TubesFrame.model_validate(frame)
    return prototype_with(frame, folder, chassis_of(TubularFrame(section, folder)))


def chassis_of(tubular: TubularFrame) -> dict[str, Any]:
    """Mass, centre and inertia of a frame as in a car's file."""
    mass = tubular.frame()[0].finite_element_model().mass
    total = float(mass.masses.sum())
    centre = mass.masses @ mass.positions / total
    arms = mass.positions - centre
    second = (mass.masses[:, None] * arms).T @ arms
    tensor = np.trace(second) * np.eye(3) - second
    return {
        "mass": total,
        "com": [round(float(v), 9) + 0.0 for v in centre],
        "inertia": [float(v) for v in np.diag(tensor)],
        "accelerometers": {},
        "products": [round(float(tensor[i, j]), 9) + 0.0 for i, j in ((0, 1), (0, 2), (1, 2))],
    }


def recovery_table(readings: Sequence[Reading], nodes: Sequence[str], dof: np.ndarray, path: Path) -> None:
    """Write the factors of gauges as a table for gauges of kind "recovery"."""
    lines = ["gauge,quantity,node,axis,factor"]
    for reading in readings:
        for node, numbers in zip(nodes, dof, strict=True):
            for axis, number in zip(AXES, numbers, strict=False):
                if number >= 0 and reading.row[number] != 0.0:
                    lines.append(f"{reading.gauge},{reading.quantity},{node},{axis},{float(reading.row[number])!r}")
    path.write_text("\n".join(lines) + "\n")


def exported(folder: Path) -> Car:
    """The prototype with its own frame as matrices in SciPy's files, gauges by recovery."""
    flexible = PROTOTYPE.flexible_frame
    model, frame_data = flexible.model, PROTOTYPE._data["chassis"]["frame"]
    sp.save_npz(folder / "K.npz", sp.csc_matrix(model.K))
    sp.save_npz(folder / "M.npz", sp.csc_matrix(model.mass_matrix()))
    places = [f"{n},{x[0]!r},{x[1]!r},{x[2]!r}" for n, x in zip(model.names, model.positions.tolist(), strict=True)]
    (folder / "nodes.csv").write_text("\n".join(["name,x,y,z", *places]) + "\n")
    recovery_table(flexible.structure.readings, model.names, model.dof, folder / "recovery.csv")
    shutil.copy(PROTOTYPE.folder / "loads.csv", folder)
    frame = {
        "kind": "matrices",
        "stiffness": "K.npz",
        "mass": "M.npz",
        "nodes": "nodes.csv",
        "loads": "loads.csv",
        "damping": frame_data["damping"],
        "gauges": {name: {"kind": "recovery", "table": "recovery.csv"} for name in frame_data["gauges"]},
    }
    return prototype_with(frame, folder)


def written(car: Car) -> Path:
    """The content of a car as a file in its folder."""
    lines = [f"{key} = {_toml(value)}" for key, value in car._data.items()]
    (car.folder / "car.toml").write_text("\n".join(lines) + "\n")
    return car.folder


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return json.dumps(value)
