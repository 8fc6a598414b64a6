"""Roads that a soak test drives on: one with ramps, kerbs and a hill, those in the FMU, and worlds."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.files import atomic_file, make_folder
from hosts.common.road import road_value
from hosts.common.world_files import make_world
from hosts.driving.random_driver import Target

_SPACING = 0.25  # m, of the points of the road
_HALF = 80.0  # m, half the side of its square; beyond it is level
_QUARTER = 0.5 * math.pi

_RAMPS = (  # x, y of the foot, direction in quarter turns, height and length in m
    (20.0, 0.0, 0, 0.3, 3.0),
    (-20.0, 30.0, 1, 0.5, 4.0),
    (-30.0, -20.0, 2, 0.7, 4.0),
    (40.0, -30.0, 3, 1.0, 5.0),
    (45.0, 40.0, 0, 1.0, 3.0),
)
_RAMP_WIDTH = 5.0  # m
_KERBS = ((0.0, -45.0, 12.0, 0.08), (-50.0, 45.0, 8.0, 0.15))  # x, y, side and height of blocks with steep sides, m
_HILL = (55.0, 0.0, 0.2, 15.0, 8.0)  # x, y, grade, length of a slope, length of its top and width, m
_WAVES = (-45.0, 0.0, 20.0, 1.8, 0.03)  # x, y, side, wavelength, amplitude, m


@dataclass(frozen=True)
class Ground:
    """A road with its targets."""

    road: str
    """Of the parameter `road.file`."""
    targets: tuple[Target, ...]


IN_THE_FMU = (
    Ground("", ()),
    Ground("kerb.road", (Target(10.0, 0.0, math.pi), Target(10.0, 0.0, 0.0))),
    Ground("washboard.road", (Target(10.0, 0.0, 0.0),)),
    Ground("rough.road", (Target(5.0, 0.0, 0.0),)),
    Ground("split.road", ()),
)
"""Roads that every car's FMU has."""


def jump_heights() -> tuple[NDArray[np.float64], tuple[Target, ...]]:
    """Heights of the road with ramps, and the feet of the ramps.

    Returns
    -------
    heights : ndarray of shape (n, n)
        m, rows along x.
    targets : tuple of Target
    """
    at = np.arange(-_HALF, _HALF + 0.5 * _SPACING, _SPACING)
    x, y = np.meshgrid(at, at, indexing="ij")
    heights = np.zeros_like(x)
    targets = []
    for x0, y0, quarters, height, length in _RAMPS:
        yaw = quarters * _QUARTER
        along = (x - x0) * math.cos(yaw) + (y - y0) * math.sin(yaw)
        across = (y - y0) * math.cos(yaw) - (x - x0) * math.sin(yaw)
        inside = (along >= 0.0) & (along <= length) & (np.abs(across) <= 0.5 * _RAMP_WIDTH)
        heights = np.where(inside, height * along / length, heights)
        targets.append(Target(x0, y0, yaw))
    for x0, y0, side, height in _KERBS:
        heights = np.where(np.maximum(np.abs(x - x0), np.abs(y - y0)) <= 0.5 * side, height, heights)
        targets += [Target(x0 - 0.5 * side, y0, 0.0), Target(x0, y0 + 0.5 * side, -_QUARTER)]
    x0, y0, grade, length, flat = _HILL
    slope = np.clip((length + 0.5 * flat - np.abs(x - x0)) * grade, 0.0, grade * length)
    heights = np.where(np.abs(y - y0) <= flat, np.maximum(heights, slope), heights)
    targets.append(Target(x0 - length - 0.5 * flat, y0, 0.0))
    x0, y0, side, wave, amplitude = _WAVES
    inside = np.maximum(np.abs(x - x0), np.abs(y - y0)) <= 0.5 * side
    heights = np.where(inside, amplitude * np.sin(2.0 * math.pi * (x - x0) / wave), heights)
    return heights, tuple(targets)


def jump_ground(folder: Path, centre: Sequence[float] = (0.0, 0.0)) -> Ground:
    """Make the road file with ramps, by ``ali3 road``. `centre`: of the square, m.

    Raises `HostError`: the road cannot be made.
    """
    heights, targets = jump_heights()
    x, y = centre
    file = make_folder(folder) / f"jumps_{x:.0f}_{y:.0f}.npz"
    with atomic_file(file) as temporary, temporary.open("wb") as stream:
        np.savez(
            stream,
            heights=heights,
            frictions=np.full(heights.shape, 1.2),
            origin=np.array([x - _HALF, y - _HALF]),
            spacing=np.array([_SPACING, _SPACING]),
        )
    road = road_value(str(file), folder)
    file.unlink()
    return Ground(road, tuple(Target(t.x + x, t.y + y, t.yaw) for t in targets))


def world_ground(name: str) -> Ground:
    """The road of a world, whose places are driven at. Raises `HostError`: it is not a world."""
    world = make_world(name)
    targets = tuple(Target(place["x"], place["y"], place["yaw"]) for place in world.content["places"])
    return Ground(str(world.road), targets)
