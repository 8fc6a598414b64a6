"""Steps per second of a car in Python and of its environments, beside FMPy alone.

Each environment of `hosts.plant` is stepped with the action 0: its FMU through FMPy alone, with the inputs and outputs
of the environment; `hosts.plant.Car`; the environment; several by Gymnasium one after the other, in processes, and on
threads. All make the same steps from the same start in turn, `repeats` times. Steps per second are from the least time
of each step, which other work of the machine hardly changes; processor time is the mean of this process.
"""

import shutil
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import fmpy
import gymnasium
import numpy as np
from fmpy.simulation import instantiate_fmu
from gymnasium.vector import VectorEnv

from benchmarks.shared.pages import Row, crossed
from hosts.plant.environments import CarEnvironment

ENVIRONMENTS = ("LaneKeeping", "AntiLockBraking", "ProvingGroundLap")
FMPY = "FMPy"
CAR = "car in Python"
ONE = "environment"
Way: TypeAlias = tuple[Callable[[], object], Callable[[int], object]]
"""A function that starts a run, and one that makes its step k."""


def measure(name: str, several: int, repeats: int, steps: int, **options: Any) -> list[dict[str, Any]]:
    """Rows of an environment made with `options`.

    `several`: environments at the same time; `repeats`: runs; `steps`: number in a run. Raises `RuntimeError` if
    observations of several environments differ between the ways to step them.
    """
    single = gymnasium.make(f"ali3/{name}-v0", disable_env_checker=True, **options)
    plain = single.unwrapped
    assert isinstance(plain, CarEnvironment)
    together: dict[str, VectorEnv[Any, Any, Any]] = {
        f"{several} by {way}": gymnasium.make_vec(f"ali3/{name}-v0", several, vectorization_mode=mode, **options)
        for way, mode in (("SyncVectorEnv", "sync"), ("AsyncVectorEnv", "async"), ("threads", "vector_entry_point"))
    }
    folder = Path(tempfile.mkdtemp(prefix="plant_"))
    last: dict[str, np.ndarray] = {}
    try:
        ways: dict[str, Way] = {
            FMPY: _fmpy(plain, folder),
            CAR: _car(plain),
            ONE: _one(single),
            **{way: _several(vector_env, way, last) for way, vector_env in together.items()},
        }
        wall_times, cpu_times = {way: np.full(steps, np.inf) for way in ways}, dict.fromkeys(ways, 0.0)
        for _ in range(repeats):
            for way, (begin, advance) in ways.items():
                begin()
                cpu_begin = time.process_time()
                for k in range(steps):
                    wall_begin = time.perf_counter()
                    advance(k)
                    wall_times[way][k] = min(wall_times[way][k], time.perf_counter() - wall_begin)
                cpu_times[way] += (time.process_time() - cpu_begin) / repeats
        first, *others = last.values()
        if any((other != first).any() for other in others):
            raise RuntimeError(f"{name}: several environments are not the same in all ways.")
    finally:
        single.close()
        for env in together.values():
            env.close()
        shutil.rmtree(folder)
    count = {way: steps * (several if way in together else 1) for way in ways}
    return [
        {
            "environment": name,
            "step_ms": 1e3 * plain.car.step_length,
            "way": way,
            "steps_a_second": count[way] / float(wall_times[way].sum()),
            "us_of_processor": None if "Async" in way else 1e6 * cpu_times[way] / count[way],
        }
        for way in ways
    ]


def _fmpy(environment: CarEnvironment, folder: Path) -> Way:
    """Set inputs, step and read outputs by calls of FMPy."""
    path = str(environment.car.fmu.path)
    description = fmpy.read_model_description(path)
    reference = {v.name: v.valueReference for v in description.modelVariables}
    fmpy.extract(path, str(folder))
    slave = instantiate_fmu(str(folder), description)
    inputs = [reference[name] for name in environment.car.inputs]
    outputs = [reference[name] for name in environment._output_names]
    values, h = [0.0] * len(inputs), environment.car.step_length
    texts = {name: value for name, value in environment.car._parameters.items() if isinstance(value, str)}

    def begin() -> None:
        slave.reset()
        slave.setupExperiment(startTime=0.0)
        slave.setReal([reference["initial.speed"]], [15.0])
        slave.setString([reference[name] for name in texts], list(texts.values()))
        slave.enterInitializationMode()
        slave.exitInitializationMode()

    def advance(k: int) -> None:
        slave.setReal(inputs, values)
        slave.doStep(currentCommunicationPoint=k * h, communicationStepSize=h)
        slave.getReal(outputs)

    return begin, advance


def _car(environment: CarEnvironment) -> Way:
    car, reads = environment.car, environment._output_names
    values, into = np.zeros(len(car.inputs)), np.zeros(len(reads))

    def advance(k: int) -> None:
        car.step(values)
        car.read(reads, into)

    return lambda: car.reset(0, **{"initial.speed": 15.0}), advance


def _one(environment: gymnasium.Env[Any, Any]) -> Way:
    action = np.zeros(environment.action_space.shape or (), np.float32)
    return lambda: environment.reset(seed=0), lambda k: environment.step(action)


def _several(vector_env: VectorEnv[Any, Any, Any], way: str, last: dict[str, np.ndarray]) -> Way:
    actions = np.zeros(vector_env.action_space.shape or (), np.float32)

    def advance(k: int) -> None:
        last[way] = vector_env.step(actions)[0]

    return lambda: vector_env.reset(seed=0), advance


def plant_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of steps a second and processor time of a step, us, by way and environment."""

    def cell(row: Row) -> str:
        cpu_time = row["us_of_processor"]
        return f"{row['steps_a_second']:.0f}" + ("" if cpu_time is None else f" ({cpu_time:.0f})")

    names = [row | {"column": f"{row['environment']}, {row['step_ms']:g} ms"} for row in rows]
    return {"plant": crossed(names, lambda r: r["way"], "column", cell, "steps a second (us of processor a step)")}
