"""Cars of another commit of this project: the program that its Python runs, and who asks it for steps.

The program has nothing of this commit: it uses the other's `mbs` by names that both have.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from benchmarks.car import manoeuvres
from mbs.settings.input_signals import InputSignals

PROGRAM = """
import json, sys, time
import numpy as np
import mbs
from mbs.scenes import prototype_car
told = json.loads(sys.stdin.readline())
system = mbs.compile(prototype_car.build())
names, rows = told["inputs"], np.array(told["rows"])
first = dict(zip(names, rows[0].tolist()))
pose = mbs.Pose(**told["pose"])
declared = system.meta["inputs"]
table = np.tile([float(entry["start"]) for entry in declared], (len(rows) - 1, 1))
for column, entry in enumerate(declared):
    if entry["name"] in names:
        table[:, column] = rows[1:, names.index(entry["name"])]
values = np.empty((1, len(system.meta["sensors"])))
print("ready", flush=True)
for line in sys.stdin:
    if line.strip() == "start":
        done, cars = 0, [mbs.Simulation(system, inputs=first, pose=pose) for _ in range(told["cars"])]
        print("started", flush=True)
        continue
    n = int(line)
    part = np.ascontiguousarray(table[done : done + n])
    begin = time.thread_time()
    for car in cars:
        car.instance.run(told["h"], n, part, n, values)
    print(time.thread_time() - begin, flush=True)
    done += n
"""


class OlderCars:
    """Cars that another commit steps when they are asked to."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def start(self) -> None:
        """All cars at the start of the manoeuvre."""
        self.ask("start")

    def run(self, steps: int) -> float:
        """Seconds of a core for so many steps of every car."""
        return float(self.ask(str(steps)))

    def ask(self, line: str) -> str:
        """The program's answer to a line."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        print(line, file=self._process.stdin, flush=True)
        answer = self._process.stdout.readline()
        if not answer:
            raise RuntimeError("the cars of the other commit ended; what they said stands above.")
        return answer


@contextmanager
def older_cars(folder: Path, name: str, h: float, seconds: float, cars: int) -> Iterator[OlderCars]:
    """The prototypes of the clone in `folder`, whose kernel is compiled, at the start of a manoeuvre of this commit."""
    manoeuvre, system = manoeuvres.load(name), manoeuvres.system_of(name)
    signals = InputSignals(manoeuvres.inputs_of(manoeuvre, system), system.meta["inputs"])
    names = [system.meta["inputs"][i]["name"] for i in signals.columns()]
    pose = manoeuvres.start_of(manoeuvre, system)[1]
    assert pose is not None
    times = h * np.arange(round(seconds / h) + 1, dtype=float)
    rows = signals.at(times, 1e-6 * h)
    rows[0] = signals.at(times[:1], 1e-6 * h, after_jump=True)[0]
    told = {"inputs": names, "rows": rows.tolist(), "h": h, "cars": cars}
    told["pose"] = {key: getattr(pose, key) for key in ("x", "y", "yaw", "speed")}
    environment = os.environ | {"PYTHONPATH": str(folder)}
    command = [sys.executable, "-P", "-c", PROGRAM]
    with subprocess.Popen(
        command, cwd=folder, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            asked = OlderCars(process)
            asked.ask(json.dumps(told))
            yield asked
        finally:
            process.kill()
