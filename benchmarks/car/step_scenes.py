"""Scenes whose first steps are repeated by a small program in C with the kernel alone.

`against_checkout` runs this file with the packages of another checkout: it imports only what that has too.
"""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.car import manoeuvres
from hosts.driving.manoeuvre import Manoeuvre
from mbs import Simulation, System, compile
from mbs.kernel import build
from mbs.scenes import bricard, double_four_bar, flyball, kerb_test, prototype_car, spatial_chain

SOURCE = Path(__file__).parents[1] / "shared" / "c" / "run_system.c"


class Scene(NamedTuple):
    """The first steps of a motion, which are counted."""

    name: str
    step: float
    """s."""
    steps: int
    """Number of steps."""
    system: Callable[[], System]
    """Compiles the System."""
    manoeuvre: str = ""
    """Name of the manoeuvre that gives a car its start and inputs; empty: none."""


def _compile_flexible() -> System:
    return compile(prototype_car.build(fidelity=3))


def _compile_rigid() -> System:
    return manoeuvres.system_of("slalom")


def _compile_tables() -> System:
    return compile(prototype_car.build(fidelity=10))


SCENES = (
    Scene("double four-bar", 0.03, 330, lambda: compile(double_four_bar.build())),
    Scene("40 windows", 0.01, 200, lambda: compile(double_four_bar.build(windows=40))),
    Scene("Bricard's mechanism", 0.01, 300, lambda: compile(bricard.build())),
    Scene("flyball governor", 0.01, 300, lambda: compile(flyball.build())),
    Scene("spatial chain", 0.01, 200, lambda: compile(spatial_chain.build())),
    Scene("lane change", 0.01, 500, _compile_rigid, "double_lane_change_replay"),
    Scene("lane change", 0.002, 500, _compile_rigid, "double_lane_change_replay"),
    Scene("slalom", 0.005, 500, _compile_rigid, "slalom"),
    Scene("launch and brake", 0.01, 500, _compile_rigid, "launch_and_brake"),
    Scene("full lock", 0.01, 500, _compile_rigid, "full_lock"),
    Scene("drop", 0.002, 500, _compile_rigid, "drop"),
    Scene("lane change, tables", 0.01, 500, _compile_tables, "double_lane_change_replay"),
    Scene("slalom, tables", 0.005, 500, _compile_tables, "slalom"),
    Scene("slalom, flexible frame", 0.005, 100, _compile_flexible, "slalom"),
    Scene("drop, flexible frame", 0.002, 200, _compile_flexible, "drop"),
    Scene("kerb test, flexible frame", 0.01, 100, lambda: compile(kerb_test.build(3))),
    Scene("kerb test, load paths", 0.01, 100, lambda: compile(kerb_test.build(2))),
)


def compile_program(folder: Path) -> Path:
    """The program that repeats steps."""
    program, label = folder / "run_system", "the program that repeats steps"
    sources, include = [SOURCE, *build.sources(lanes=False)], (build.HERE / "include",)
    build.compile_c(sources, build.host_target(), program, include=include, what=label, shared=False)
    return program


def command_of(scene: Scene, program: Path, folder: Path) -> list[str]:
    """The program with its arguments; its files are written."""
    system = scene.system()
    files = [folder / name for name in ("system", "state", "inputs")]
    if scene.manoeuvre:
        manoeuvre = manoeuvres.load(scene.manoeuvre)
        parameters, pose = manoeuvres.start_of(manoeuvre, system)
        inputs = input_rows(manoeuvre, system, scene.step * np.arange(scene.steps + 1))
        names = [entry["name"] for entry in system.meta["inputs"]]
        start = Simulation(system, inputs=dict(zip(names, inputs[0], strict=True)), parameters=parameters, pose=pose)
    else:
        inputs, start = np.empty((1, 0)), Simulation(system)
    contents = (system.kernel_bytes(), start.save(), inputs[1:].astype("<f8").tobytes())
    for file, data in zip(files, contents, strict=True):
        file.write_bytes(data)
    return [str(program), *map(str, files), repr(scene.step), str(scene.steps)]


def input_rows(manoeuvre: Manoeuvre, system: System, times: np.ndarray) -> np.ndarray:
    """Values of all inputs of a System at these times, a row each."""
    signals = manoeuvres.inputs_of(manoeuvre, system)
    columns = []
    for entry in system.meta["inputs"]:
        signal = signals.get(entry["name"], entry["start"])
        columns.append(np.interp(times, *signal) if isinstance(signal, tuple) else np.full(len(times), signal))
    return np.array(columns, float).T
