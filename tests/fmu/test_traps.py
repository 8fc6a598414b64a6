"""A host that traps floating point drives each car without a trap: no invalid, no division by zero, no overflow."""

from __future__ import annotations

import platform
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import fmpy
import numpy as np
import pytest

from mbs.vehicle.read_car import car_names
from tests.fmu import native
from tests.in_process import build_fmu

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64", reason="the host reads the registers of x86-64 Linux"
)
STEP, STEPS = 0.002, 1500
PARTS = {"throttle": (0.0, 0.4), "steering": (0.2, 0.6), "brake": (0.5, 0.8), "hand_brake": (0.9, 1.0)}
"""Of the drive: from where to where an input that jumps to 1 and back is on."""

STARTS = ({}, {"initial.z": 1.5, "initial.speed": 15.0})
"""At rest on the ground; in the air and fast, from where it falls on its stops and its wheels turn alone."""


def drive(names: list[str]) -> np.ndarray:
    """A row of inputs for each step: a start, full lock, braking to a stop, and what stands, all by jumps."""
    part = np.arange(STEPS) / STEPS
    on = {name: (begin <= part) & (part < end) for name, (begin, end) in PARTS.items()}
    on["selector"] = np.ones(STEPS, bool)
    return np.column_stack([on.get(name, np.zeros(STEPS)) for name in names]).astype(float)


def traps(host: Path, folder: Path, *more: str) -> str:
    """What the host prints of a drive of an unpacked FMU; `more`: behind its other arguments."""
    description = fmpy.read_model_description(str(folder))
    inputs = [v for v in description.modelVariables if v.causality == "input"]
    outputs = [v.valueReference for v in description.modelVariables if v.causality == "output"]
    assert [v.valueReference for v in inputs] == list(range(len(inputs)))
    drive([v.name for v in inputs]).tofile(folder / "inputs")
    kinds = "".join("i" if v.type == "Integer" else "r" for v in inputs)
    (library,) = (folder / "binaries" / "linux64").glob("*.so")
    command = [host, library, (folder / "resources").as_uri(), description.guid, folder / "inputs", kinds, STEP]
    command += [f"{min(outputs)}-{max(outputs)}", *more]
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("car", car_names())
def test_a_drive_of_a_car_raises_no_trap(tmp_path: Path, car: str) -> None:
    host = native.compile_host(tmp_path, source=native.C_FOLDER / "traps.c")
    folder = native.unpack(build_fmu(tmp_path, "--car", car), tmp_path / "unpacked")
    numbers = {v.name: v.valueReference for v in fmpy.read_model_description(str(folder)).modelVariables}
    systems = len(list((folder / "resources").glob("system_*.ali3")))
    for fidelity in range(systems):
        chosen = [f"i{numbers['fidelity']}={fidelity}"] if systems > 1 else []
        for start in STARTS:
            placed = [f"r{numbers[name]}={value}" for name, value in start.items()]
            assert traps(host, folder, *chosen, *placed) == f"{STEPS} steps\n", f"fidelity {fidelity} from {start}"


def test_the_host_sees_a_trap(build: Callable[..., Path], tmp_path: Path) -> None:
    """A division by zero of its own is told once, however often it is made; without it there is none."""
    host = native.compile_host(tmp_path, source=native.C_FOLDER / "traps.c")
    folder = native.unpack(build("crane"), tmp_path / "unpacked")
    assert traps(host, folder) == f"{STEPS} steps\n"
    place, end = traps(host, folder, "by zero").splitlines()
    assert place.startswith("traps 0x")
    assert end == f"{STEPS} steps"
