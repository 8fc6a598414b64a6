"""Mistakes that are right in form and wrong in meaning, planted in files of the package: each is told with its cause.

A sweep of one of each kind; `told` of a kind gives the sentences of a file with the mistake.
"""

import math
import re
import tomllib
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hosts.measures.log_plausibility import log_plausibility
from mbs.elements.road import GridRoad
from mbs.roads.road_plausibility import grid_location, road_plausibility, start_plausibility
from mbs.tyre_files import read_tyre
from mbs.tyre_files.tyre_plausibility import magic_plausibility
from mbs.urdf import read_urdf
from mbs.vehicle import load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content
from mbs.worlds.world_plausibility import world_plausibility
from mbs.worlds.world_types import WorldDescription
from tests.hosts.compare.test_log_plausibility import Drive, drive, late, swapped
from tests.urdf.robots import ROBOTS, write_urdf

ROOT = Path(__file__).parents[2]
DEG = math.degrees(1.0)
Told = Callable[[Path], list[str]]


def car(name: str, **factors: float) -> Told:
    """A car with numbers times a factor, by their key paths with two underscores for a point."""

    def told(_: Path) -> list[str]:
        own = load(name)
        changes = {}
        for key, factor in factors.items():
            path = key.replace("__", ".")
            value: Any = own._data
            for part in path.split("."):
                value = value[int(part)] if isinstance(value, list) else value[part]
            changes[path] = [factor * v for v in value] if isinstance(value, list) else factor * value
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            car_from(changed_content(own._data, changes, "x"), own.folder, "x", warn=True)
        return [str(w.message) for w in caught]

    return told


def tyre(**factors: float) -> Told:
    """The tyre file of the saloon with numbers times a factor."""

    def told(folder: Path) -> list[str]:
        text = (ROOT / "mbs/vehicle/cars/saloon/tyre.tir").read_text(encoding="utf-8")
        for key, factor in factors.items():
            text, result = re.subn(
                rf"(?m)^({key} *= *)(\S+)", lambda m, factor=factor: f"{m[1]}{factor * float(m[2]):.9g}", text
            )
            assert result == 1
        file = folder / "t.tir"
        file.write_text(text, encoding="utf-8")
        read = read_tyre(file)
        return magic_plausibility("t.tir", read.tyre(), read.numbers).warnings()

    return told


def robot(pattern: str, factor: float) -> Told:
    """The arm UR5 with numbers times a factor."""

    def told(folder: Path) -> list[str]:
        file = write_urdf(ROBOTS["ur5"], folder / "robot.urdf")
        text = re.sub(
            pattern,
            lambda m: m[0].replace(m[1], " ".join(f"{factor * float(v):.9g}" for v in m[1].split())),
            file.read_text(encoding="utf-8"),
        )
        file.write_text(text, encoding="utf-8")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            read_urdf(file)
        return [str(w.message) for w in caught]

    return told


def log(change: Callable[[Drive], Drive]) -> Told:
    """A drive with a mistake."""
    return lambda _: log_plausibility("log.csv", change(drive())).warnings()


def offset(name: str, by: float) -> Callable[[Drive], Drive]:
    return lambda d: d | {name: replace(d[name], values=d[name].values + by)}


def road(heights: float = 1.0, spacing: float = 0.5, origin: tuple[float, float] = (0.0, -5.0), **more: Any) -> Told:
    """A hilly road in other units or elsewhere."""
    x = np.linspace(0.0, 200.0, 401)
    z = heights * (2.0 * np.sin(0.03 * x)[:, None] + 0.05 * np.cos(np.linspace(0.0, 3.0, 21)))
    grid = GridRoad(origin, (spacing, spacing), z, **more)
    return lambda _: [
        sentence
        for plausibility in (
            road_plausibility("r.csv", grid),
            start_plausibility("r.csv", grid_location(grid), (0.0, 0.0)),
        )
        for sentence in plausibility.warnings()
    ]


def world(section: str, k: int, **values: Any) -> Told:
    """The proving ground with other values of one thing."""

    def told(_: Path) -> list[str]:
        data = tomllib.loads((ROOT / "mbs/worlds/proving_ground.toml").read_text(encoding="utf-8"))
        data[section][k] |= values
        return world_plausibility("w.toml", WorldDescription.model_validate(data)).warnings()

    return told


LIMITS = r'(?:lower|upper)="([^"]*)"'
PLANTED: dict[str, tuple[Told, str]] = {
    "wheel inertia of both": (
        car("saloon", front__wheel__spin_inertia=2.0, front__wheel__diametral_inertia=2.0),
        "both wheels instead of one",
    ),
    "half a wheel's inertia": (car("saloon", front__wheel__spin_inertia=0.5), "half of the wheel"),
    "final drive twice": (car("saloon", drive__ratios=4.0), "the final drive, of about 4, twice"),
    "torque in kgf m": (car("commonroad_vanagon", drive__max_torque=0.102), "kilograms instead of newtons in drive"),
    "damping in kgf s/m": (car("saloon", rear__damper__damping=0.102), "kilograms instead of newtons in rear.damper"),
    "tyre diameter": (tyre(UNLOADED_RADIUS=2.0), "the diameter instead of the radius"),
    "tyre stiffness in kgf/m": (tyre(VERTICAL_STIFFNESS=0.10197), "kilograms instead of newtons in VERTICAL"),
    "tyre range in kg": (tyre(FZMAX=0.10197), "kilograms instead of newtons in FZMAX"),
    "trail of the other sign": (tyre(QDZ1=-1.0), "the sign of QDZ1"),
    "limits in degrees": (robot(LIMITS, DEG), "degrees instead of radians in the limits"),
    "exchanged coordinates": (log(swapped("chassis.x", "chassis.y")), "'x' and 'y' exchanged"),
    "a late yaw rate": (log(late("chassis.wz", 0.6)), "s (within 0.02 s) of 'wz'"),
    "gravity in ax": (log(offset("chassis.ax", 9.81)), "an offset of 9.8"),
    "heights in cm": (road(heights=1e2), "cm instead of m in heights"),
    "coordinates in cm": (road(spacing=50.0), "cm instead of m in coordinates"),
    "friction in percent": (road(frictions=90.0), "percent instead of a ratio in frictions"),
    "an area in mm": (world("areas", 1, at=[553e3, -22e3]), "mm instead of m in areas.1"),
}


@pytest.mark.slow
def test_each_is_reported_with_its_cause(tmp_path: Path) -> None:
    wrong = {}
    for kind, (check, message) in PLANTED.items():
        lines = check(tmp_path)
        if not any(message in line for line in lines):
            wrong[kind] = lines
    assert wrong == {}
