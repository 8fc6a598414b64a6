"""Drives of cars in worlds of the simulator, for films."""

import json
from collections.abc import Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

import mbs
from ali3.errors import UserError
from ali3.scene.recording import Recording
from mbs.settings.input_signals import Signal
from mbs.vehicle import load
from mbs.worlds import command as world_command

STEP = 0.002  # s
EVERY = 5  # steps between recorded instants


@dataclass(frozen=True)
class Drive:
    """A drive with inputs that are functions of time."""

    world: str
    start: mbs.Pose
    inputs: Mapping[str, Signal]
    """Inputs over time, s."""
    stop_time: float
    """Duration, s."""
    car: str = "prototype"


DRIVES = {
    "proving_ground": Drive(
        "proving_ground",
        mbs.Pose(x=325.0, y=62.0, speed=16.0),
        {
            "throttle": ([0.0, 1.7, 1.8, 3.4, 3.6], [0.5, 0.5, 0.0, 0.0, 0.0]),
            "brake": ([0.0, 4.6, 4.8], [0.0, 0.0, 0.6]),
            "steering": ([0.0, 3.5, 3.8, 5.2, 5.5], [0.0, 0.0, 0.45, 0.45, 0.0]),
        },
        6.5,
    ),
    "plane": Drive(
        "plane",
        mbs.Pose(speed=22.0),
        {
            "brake": ([0.0, 2.6, 2.8], [0.0, 0.0, 1.0]),
            "steering": ([0.0, 0.4, 0.7, 1.5, 1.9, 2.6, 2.9], [0.0, 0.0, 0.5, 0.5, -0.5, -0.5, 0.0]),
        },
        5.5,
    ),
    "rough": Drive("rough", mbs.Pose(x=9.0, speed=20.0), {"throttle": 0.1}, 4.5, "hatchback"),
    "washboard": Drive("washboard", mbs.Pose(x=14.0, speed=6.0), {"throttle": ([0.0, 6.0], [0.1, 0.4])}, 6.0),
}
"""Drives by the name of their film."""


def drive(name: str) -> Recording:
    """Simulate a drive; its recording with the drawn world. Raises `UserError` if the world cannot be made."""
    chosen = DRIVES[name]
    with TemporaryDirectory() as folder:
        with redirect_stdout(StringIO()):
            code = world_command.main(["--world", chosen.world, "--out", folder])
        if code != 0:
            raise UserError(f"The world {chosen.world} cannot be made.")
        car = mbs.compile(load(chosen.car).model())
        road = {"road.file": str(Path(folder, f"{chosen.world}.road"))}
        run = mbs.simulate(
            car, chosen.stop_time, STEP, chosen.inputs, parameters=road, pose=chosen.start, every=EVERY, progress=False
        )
        drawing = json.loads(Path(folder, f"{chosen.world}.json").read_text(encoding="utf-8"))
        assert run.drawing is not None
        # without the roads of the run, which have no scenery; roads of the world's file are added below
        result = run.recording({**run.drawing.scene, "roads": []})
    scene = {**(result.scene or {}), "roads": drawing["roads"], "scenery": drawing["scenery"]}
    return Recording(scene, result.t, result.columns, result.units, result.name)
