"""Manoeuvres by which the levels of a car are compared."""

import math
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ali3.tables import TextTable
from mbs.common.errors import ModelError
from mbs.settings.input_signals import Signal
from mbs.simulation.state import Pose
from mbs.system.system import System

ACCELERATION = 4.0  # m/s2, lateral, in the slalom
SLALOM_SPEED, SLALOM_FREQUENCY, SLALOM_TIME = 15.0, 0.5, 6.0  # m/s, Hz, s
BRAKING_SPEED, BRAKE_PEDAL, BRAKING_TIME = 20.0, 0.3, 4.0  # m/s, 1, s
KERB_SPEED, KERB_X, KERB_HEIGHT, KERB_TIME = 5.0, 4.0, 0.05, 3.0  # m/s, m, m, s
MIN_TIME = 0.1  # s


@dataclass(frozen=True)
class Drive:
    """A manoeuvre: inputs over time from a start."""

    name: str
    duration: float
    """Duration, s."""
    inputs: dict[str, Signal]
    """Signals by input, as in `mbs.simulate`."""
    parameters: dict[str, float] = field(default_factory=dict)
    """Values set before the start."""
    speed: float = 0.0
    """Speed at the start, m/s."""

    @property
    def pose(self) -> Pose:
        """Pose at the start."""
        return Pose(speed=self.speed)


def default_drives(system: System) -> list[Drive]:
    """Make the drives for any car: a slalom, braking, and a kerb.

    Returns
    -------
    list of Drive
        The slalom (0.5 Hz, 15 m/s) has the steer angle of 4 m/s2 without tyre slip; the brake is pressed to 0.3 within
        0.2 s at 20 m/s; the kerb is a drop of 5 cm at 5 m/s. Drives whose inputs or parameters the car lacks are
        omitted.
    """
    constants = {entry["name"]: float(entry["value"]) for entry in system.meta["constants"]}
    inputs = {entry["name"] for entry in system.meta["inputs"]}
    parameters = {entry["name"] for entry in system.meta["parameters"]}
    drives = []
    if "steering" in inputs:
        angle = constants["vehicle.wheelbase"] * ACCELERATION / SLALOM_SPEED**2
        t = np.linspace(0.0, SLALOM_TIME, round(SLALOM_TIME / 0.01) + 1)
        turns = np.sin(2.0 * math.pi * SLALOM_FREQUENCY * t) * np.minimum(t / 2.0, 1.0) ** 2
        amplitude = min(angle / constants["vehicle.front_wheel_angle_max"], 1.0)
        drives.append(Drive("slalom", SLALOM_TIME, {"steering": (t, amplitude * turns)}, speed=SLALOM_SPEED))
    if "brake" in inputs:
        times = np.array([0.0, 0.5, 0.7, BRAKING_TIME])
        pressed = np.array([0.0, 0.0, BRAKE_PEDAL, BRAKE_PEDAL])
        drives.append(Drive("braking", BRAKING_TIME, {"brake": (times, pressed)}, speed=BRAKING_SPEED))
    if {"road.kerb_x", "road.kerb_height"} <= parameters:
        kerb_values = {"road.kerb_x": KERB_X, "road.kerb_height": KERB_HEIGHT}
        drives.append(Drive("kerb", KERB_TIME, {}, kerb_values, KERB_SPEED))
    if not drives:
        raise ModelError("The car has no input for its steering or brake and no kerb; give a drive of your own.")
    return drives


def read_drive(file: Path, speed: float, inputs: Collection[str]) -> Drive:
    """Read a drive from a table of inputs over time.

    `file`: CSV with the column ``time``, s, and columns of inputs, linear between rows; `speed`: speed at the start,
    m/s; `inputs`: inputs of the car. Raises `FileError` if the file is not such a table.
    """
    table = TextTable(file, known=("time",))
    if "time" not in table.names or len(table.names) < 2:
        raise table.error(f"{file} has no column 'time' and beside it one of an input, such as 'steering'.")
    unknown = [name for name in table.names if name != "time" and name not in inputs]
    if unknown:
        raise table.error(f"{file}: the car has no input '{unknown[0]}'; it has {', '.join(sorted(inputs))}.")
    columns = dict(zip(table.names, table.values().T, strict=True))
    t = columns.pop("time")
    if not (np.diff(t) >= 0.0).all() or t[0] != 0.0 or t[-1] < MIN_TIME:
        raise table.error(
            f"{file}: times go from {t[0]:g} to {t[-1]:g} s; they must rise from 0 to {MIN_TIME:g} s or more."
        )
    return Drive(file.stem, float(t[-1]), {name: (t, values) for name, values in columns.items()}, speed=speed)
