"""A sledge that is driven and recorded as the simulator does it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hosts.fmu.fmu import Fmu
from hosts.recordings.recording import Recorder, recording_meta

STEP = 0.01
TABLES = pytest.mark.parametrize("table", ["parquet", "csv"])


class Drive:
    """A sledge that is driven and recorded as the simulator does it, with restarts and rewinds."""

    def __init__(
        self, path: Path, folder: Path, table: str | None, start: dict[str, Any], every: dict[str, int] | None = None
    ) -> None:
        self.fmu, self.start = Fmu(path), start
        inputs, outputs = self.fmu.names("input"), self.fmu.names("output")
        names = inputs + outputs
        units = {n: self.fmu.variables[n].unit or "1" for n in names}
        meta = recording_meta(path, STEP, start, seed=5, world="plane")
        self.recorder = Recorder(folder, names, units, meta, table, every)
        self.set, self.get = self.fmu.setter(inputs), self.fmu.getter(outputs)
        self.held = self.fmu.start_values(inputs).tolist()
        self.count = self.epoch = 0
        self.time = 0.0
        self.random = np.random.default_rng(1)
        self.fmu.initialise(start)
        self.saved: dict[tuple[int, int], tuple[Any, float]] = {}
        self.row()

    def row(self) -> None:
        self.recorder.row(self.count, self.time, self.epoch, [*self.held, *self.get()])

    def steps(self, number: int) -> None:
        for _ in range(number):
            if self.count % 7 == 0:
                self.held = self.random.uniform(0.0, 1.0, len(self.held)).tolist()
            self.set(self.held)
            self.fmu.step(self.time, STEP)
            self.count += 1
            self.time = self.time + STEP
            self.row()

    def save(self) -> tuple[int, int]:
        self.saved[self.count, self.epoch] = self.fmu.state(), self.time
        return self.count, self.epoch

    def rewind(self, key: tuple[int, int]) -> None:
        state, self.time = self.saved[key]
        self.fmu.restore(state)
        self.epoch += 1
        details = {"back_to": key[0], "back_to_epoch": key[1]}
        self.recorder.event(self.time, "rewind", "back", epoch=self.epoch, **details)
        self.row()

    def restart(self, kind: str, **start: float) -> None:
        self.epoch += 1
        if kind == "reset":
            self.time = 0.0
        self.fmu.reset()
        self.fmu.initialise(self.start | start, self.time)
        self.held = self.fmu.start_values(self.fmu.names("input")).tolist()
        self.recorder.event(self.time, kind, "again", epoch=self.epoch, start=self.start | start)
        self.row()

    def close(self) -> None:
        for state, _ in self.saved.values():
            self.fmu.free(state)
        self.fmu.close()
        self.recorder.close()


def whole_drive(path: Path, folder: Path, table: str | None = None, every: dict[str, int] | None = None) -> Path:
    """Start, rewind, reset, two rewinds to one state, upright elsewhere."""
    drive = Drive(path, folder, table, {"initial.speed": 6.0}, every)
    drive.steps(30)
    saved = drive.save()
    drive.steps(20)
    drive.rewind(saved)
    drive.steps(25)
    last = drive.save()
    drive.restart("reset")
    drive.save()
    drive.rewind(last)  # past the reset, to a row of the same count
    drive.steps(5)
    drive.restart("reset")
    drive.steps(11)
    saved = drive.save()
    drive.steps(9)
    drive.rewind(saved)
    drive.steps(3)
    drive.rewind(saved)
    drive.steps(5)
    drive.restart("upright", **{"initial.x": 12.5, "initial.yaw": 0.1})
    drive.steps(40)
    saved = drive.save()
    drive.steps(10)
    drive.rewind(saved)
    drive.rewind(drive.save())  # to the row of a rewind
    drive.steps(15)
    drive.close()
    return folder
