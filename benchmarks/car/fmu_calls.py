"""Time of the calls of an FMU, from a C program and through FMPy."""

import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi2 import FMU2Slave, fmi2Real, fmi2ValueReference

from benchmarks.shared.pages import Row, table
from benchmarks.shared.timing import best_time
from fmu_src.native.sources import HERE as FMI_HEADERS
from mbs.kernel import build

CALLS = {
    "step": "one step of 2 ms",
    "get_all": "all outputs after a step",
    "get_again": "the same once more",
    "set_one": "one input set",
    "save_restore_free": "state: get, set, free",
    "instantiate_to_initialised": "instantiate to initialised",
}
"""Quantities in the table of the page, with their titles."""
HOSTS = {"native from C": ("native", "C"), "native through FMPy": ("native", "FMPy")}
HOSTS |= {"Python from C": ("python", "C"), "Python through FMPy": ("python", "FMPy")}
SOURCE = Path(__file__).parent / "c" / "time_fmu.c"


def measure(fmu: Path, kind: str, folder: Path, steps: int, repeats: int, instances: int) -> list[dict[str, Any]]:
    """Rows of an FMU, with ``quantity``, ``kind``, ``host`` and ``value``.

    `kind`: ``native`` or ``python``; `folder`: folder for the unpacked FMU; `steps`: calls in a timed run; `repeats`:
    timed runs; `instances`: instances at the same time. There are no rows of the C program if it cannot run the FMU.
    """
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    rows: list[dict[str, Any]] = [{"quantity": "file_MB", "kind": kind, "host": "C", "value": fmu.stat().st_size / 1e6}]
    hosts = {
        "C": time_from_c(folder, steps, repeats, instances if kind == "native" else 30),
        "FMPy": time_from_fmpy(folder, steps, repeats),
    }
    for host, values in hosts.items():
        rows += [{"quantity": name, "kind": kind, "host": host, "value": value} for name, value in values.items()]
    return rows


def time_from_c(folder: Path, steps: int, repeats: int, instances: int) -> dict[str, float]:
    """Figures of the C program by quantity, us unless named otherwise; empty if it cannot run the FMU."""
    description = fmpy.read_model_description(str(folder))
    outputs = [v.valueReference for v in description.modelVariables if v.causality == "output"]
    program = folder / ("time_fmu.exe" if sys.platform == "win32" else "time_fmu")
    build.compile_c([SOURCE], build.host_target(), program, include=(FMI_HEADERS,), what="the timer", shared=False)
    library = (
        folder / "binaries" / fmpy.platform / (description.coSimulation.modelIdentifier + fmpy.sharedLibraryExtension)
    )
    numbers = (float(description.defaultExperiment.stepSize), steps, repeats, len(outputs), outputs[0], instances)
    command = [str(program), str(library), folder.joinpath("resources").as_uri(), description.guid, *map(str, numbers)]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    if process.returncode != 0:
        print(f"the C host cannot run it: {process.stderr.strip()}", file=sys.stderr)
    pairs = (line.split() for line in process.stdout.splitlines())
    return {name: float(value) for name, value in pairs}


def time_from_fmpy(folder: Path, steps: int, repeats: int) -> dict[str, float]:
    """Figures through FMPy by quantity, us; arrays of value references are prepared before."""
    description = fmpy.read_model_description(str(folder))
    outputs = [v.valueReference for v in description.modelVariables if v.causality == "output"]
    h = float(description.defaultExperiment.stepSize)
    references, values = (fmi2ValueReference * len(outputs))(*outputs), (fmi2Real * len(outputs))()
    first_input, value = (fmi2ValueReference * 1)(0), (fmi2Real * 1)(0.1)
    slave = FMU2Slave(
        guid=description.guid,
        unzipDirectory=str(folder),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="timed",
    )

    def start() -> None:
        slave.instantiate()
        slave.setupExperiment(startTime=0.0)
        slave.enterInitializationMode()
        slave.exitInitializationMode()

    def timed_start() -> float:
        begin = time.perf_counter()
        start()
        wall = time.perf_counter() - begin
        slave.fmi2FreeInstance(slave.component)
        return wall

    results = {"instantiate_to_initialised": 1e6 * best_time(timed_start, repeats)}
    start()
    clock = [0]

    def step() -> None:
        slave.doStep(clock[0] * h, h)
        clock[0] += 1

    def state() -> None:
        saved = slave.getFMUstate()
        slave.setFMUstate(saved)
        slave.freeFMUstate(saved)

    actions: dict[str, Callable[[], Any]] = {
        "step": step,
        "get_again": lambda: slave.fmi2GetReal(slave.component, references, len(outputs), values),
        "set_one": lambda: slave.fmi2SetReal(slave.component, first_input, 1, value),
        "save_restore_free": state,
    }
    for quantity, action in actions.items():
        results[quantity] = 1e6 * best_time(lambda action=action: _repeat(action, steps), repeats) / steps
    get = actions["get_again"]

    def get_after_steps() -> float:
        wall = 0.0
        for _ in range(steps):
            step()
            begin = time.perf_counter()
            get()
            wall += time.perf_counter() - begin
        return wall

    results["get_all"] = 1e6 * best_time(get_after_steps, repeats) / steps
    slave.fmi2FreeInstance(slave.component)
    return results


def _repeat(action: Callable[[], Any], count: int) -> None:
    for _ in range(count):
        action()


def fmu_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of microseconds per call by host."""
    results = {(r["quantity"], r["kind"], r["host"]): r["value"] for r in rows}
    lines = [
        {"microseconds": title} | {host: results.get((name, *key)) for host, key in HOSTS.items()}
        for name, title in CALLS.items()
    ]
    return {"fmu calls": table(lines, {"microseconds": "", **dict.fromkeys(HOSTS, ".3g")})}
