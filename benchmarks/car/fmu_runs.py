"""Manoeuvres of a car through its FMU."""

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import fmpy

from ali3.errors import UserError
from benchmarks.car import manoeuvres, trajectories
from benchmarks.car.manoeuvres import Column
from fmu_src.build.build import build_fmu
from hosts.common.numbers import Value
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import with_names_of
from hosts.fmu.fmu import Fmu


class _FmuWithHeldInputs(Fmu):
    """An FMU whose inputs are constant in each communication step."""

    follows_slopes = False


def start_of_fmu(name: str, car: str = manoeuvres.PROTOTYPE) -> dict[str, Value]:
    """Start values of a manoeuvre under the names of the car's FMU."""
    manoeuvre, system = manoeuvres.load(name, car), manoeuvres.system_of(name, car)
    names = [v["name"] for kind in ("parameters", "inputs") for v in system.meta[kind]]
    return with_names_of(manoeuvre, names).start


def run_of_fmu(
    file: Path, name: str, h: float, follow: bool, car: str = manoeuvres.PROTOTYPE, inner: float | None = None
) -> dict[str, Column]:
    """Signals of the FMU with communication steps of `h`, s, at those times of the reference that are among them.

    The inputs are constant in a communication step, or if `follow` linear by their first derivatives. `inner`: step of
    the engine, s; by default `h`. Raises `UserError` if the FMU refuses a step.
    """
    manoeuvre, every = manoeuvres.load(name, car), max(1, round(manoeuvres.sampling(name, car) / h))
    start = {**manoeuvre.start, "step_size": h if inner is None else inner}
    with Fmu(file) if follow else _FmuWithHeldInputs(file) as fmu:
        result = run(fmu, replace(manoeuvre, start=start), h, every=every)
    if result.refusal:
        raise UserError(f"{file.name} in {name}: {result.refusal}.")
    return {sensor: result[sensor] for sensor in trajectories.SENSORS}


def built_fmu(folder: Path) -> Path:
    """Build the FMU of the prototype for this platform."""
    show = partial(print, file=sys.stderr, flush=True)
    return build_fmu(manoeuvres.system_of("drop"), f"{manoeuvres.PROTOTYPE}_car", folder, (fmpy.platform,), show)
