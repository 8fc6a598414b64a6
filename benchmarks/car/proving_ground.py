"""The prototype car on the proving ground of the simulator: over the ramp of one metre, then a sudden turn."""

from __future__ import annotations

import json
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

import mbs
from ali3.errors import UserError
from mbs.settings.input_signals import Signal
from mbs.vehicle import load
from mbs.worlds import command as world_command
from viewer.recording import Recording

WORLD = "proving_ground"
START = mbs.Pose(x=325.0, y=62.0, speed=16.0)
INPUTS: dict[str, Signal] = {
    "throttle": ([0.0, 1.7, 1.8, 3.4, 3.6], [0.5, 0.5, 0.0, 0.0, 0.0]),
    "brake": ([0.0, 4.6, 4.8], [0.0, 0.0, 0.6]),
    "steering": ([0.0, 3.5, 3.8, 5.2, 5.5], [0.0, 0.0, 0.45, 0.45, 0.0]),
}
"""By time, s."""
STEP = 0.002
EVERY = 5


def jump(stop_time: float = 6.5) -> Recording:
    """Drive, and give what is drawn with the world in it. Raises `UserError`: the world cannot be made."""
    with TemporaryDirectory() as folder:
        with redirect_stdout(StringIO()):
            code = world_command.main(["--world", WORLD, "--out", folder])
        if code != 0:
            raise UserError(f"The world {WORLD} cannot be made.")
        car = mbs.compile(load("prototype").model())
        parameters = {"road.file": str(Path(folder, f"{WORLD}.road"))}
        run = mbs.simulate(car, stop_time, STEP, INPUTS, parameters=parameters, pose=START, every=EVERY, progress=False)
        drawing = json.loads(Path(folder, f"{WORLD}.json").read_text(encoding="utf-8"))
        assert run.drawing is not None
        # Those of the file have no scenery, and are many; what was left out of the run is found by its road.
        found = run.recording({**run.drawing.scene, "roads": []})
    scene = {**(found.scene or {}), "roads": drawing["roads"], "scenery": drawing["scenery"]}
    return Recording(scene, found.t, found.columns, found.units, found.name)
