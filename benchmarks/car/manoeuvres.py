"""Manoeuvres of cars: the host's files and further ones, simulated by the kernel without an FMU.

They are the prototype's; a car that needs other pedals or steering has a file in its folder. The replay of the double
lane change has the inputs that are stored with its reference.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmarks.shared.tables import read_csv
from hosts.driving.driver import make_driver
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.recordings.load_manoeuvre import load_manoeuvre
from mbs import Pose, Settings, Simulation, System, Trajectory, compile, simulate
from mbs.elements.road import GridRoad
from mbs.settings.input_signals import Signal
from mbs.simulation.step_time import step_time
from mbs.vehicle import load as load_car

Column: TypeAlias = NDArray[np.float64]
FOLDER = Path(__file__).with_name("data")
REFERENCES = Path(__file__).parents[2] / "tests" / "data" / "car"
HOST = ("launch_and_brake", "kerb_drop", "step_steer_given_throttle", "slalom", "drop", "steady_cornering")
REPLAY = "double_lane_change_replay"
CLOSED_LOOP = "double_lane_change"  # of the host, whose driver gave the inputs of `REPLAY`
PEDALS = ("steering", "throttle", "brake")
"""Inputs of that driver."""
OWN = ("full_lock", "brake_on_slope", "kerb_lock_brake")
NAMES = (*HOST, REPLAY, *OWN)
RISE_BEGINS = 20.0  # m
RISE_ENDS = 25.0  # m
GRADE = 0.1  # dz/dx after the rise
OTHER_ROAD = ("brake_on_slope",)  # on a road that the FMU does not have
INITIAL = "initial."
PROTOTYPE = "prototype"
CARS = (
    PROTOTYPE,
    "hatchback",
    "saloon",
    "commonroad_escort",
    "commonroad_320i",
    "commonroad_vanagon",
    "ferrari_250_lm",
)


def reference_file(name: str, car: str) -> Path:
    """File of the reference of a manoeuvre of a car."""
    return (REFERENCES if car == PROTOTYPE else REFERENCES / car) / f"{name}.csv"


def load(name: str, car: str = PROTOTYPE) -> Manoeuvre:
    """A manoeuvre of a car: one of `NAMES` or another one of the host."""
    if name == REPLAY:
        _, columns = read_csv(reference_file(name, car))
        return _replay(columns["time"], {pedal: columns[pedal] for pedal in PEDALS}, car)
    own_file = FOLDER / car / f"{name}.toml"
    if own_file.is_file():
        return load_manoeuvre(str(own_file))
    return load_manoeuvre(str(FOLDER / f"{name}.toml") if name in OWN else name)


@cache
def system_of(name: str, car: str = PROTOTYPE) -> System:
    """A car on the road of a manoeuvre."""
    if name in OTHER_ROAD:
        return compile(load_car(car).model(rise(car)))
    return _default_system(car)


@cache
def _default_system(car: str) -> System:
    return compile(load_car(car).model())


def rise(car: str = PROTOTYPE, grade: float = GRADE) -> GridRoad:
    """Level road followed by a slope dz/dx, with a transition whose curvature begins and ends at zero."""
    x = np.arange(-20.0, 200.1, 0.5)
    s = np.clip((x - RISE_BEGINS) / (RISE_ENDS - RISE_BEGINS), 0.0, 1.0)
    # integral of the slope 3 s^2 - 2 s^3
    height = grade * ((RISE_ENDS - RISE_BEGINS) * (s**3 - 0.5 * s**4) + np.clip(x - RISE_ENDS, 0.0, None))
    return GridRoad((-20.0, -10.0), (0.5, 20.0), np.column_stack([height, height]), load_car(car).road.friction)


def start_of(manoeuvre: Manoeuvre, system: System) -> tuple[dict[str, float], Pose | None]:
    """Parameters and initial pose of a manoeuvre."""
    start = _start(manoeuvre, system)
    pose = {k[len(INITIAL) :]: v for k, v in start.items() if k.startswith(INITIAL)}
    inputs = _names(system, "inputs")
    parameters = {k: v for k, v in start.items() if not k.startswith(INITIAL) and k not in inputs}
    return parameters, Pose(**pose) if pose else None


def inputs_of(manoeuvre: Manoeuvre, system: System) -> dict[str, Signal]:
    """Inputs of a manoeuvre over time, for `mbs.simulate`."""
    inputs: dict[str, Signal] = {name: (manoeuvre.time, values) for name, values in manoeuvre.inputs.items()}
    inputs_of_system = _names(system, "inputs")
    return inputs | {k: v for k, v in _start(manoeuvre, system).items() if k in inputs_of_system and k not in inputs}


def _start(manoeuvre: Manoeuvre, system: System) -> dict[str, float]:
    return with_names_of(manoeuvre, _names(system, "parameters") | _names(system, "inputs")).start


def _names(system: System, kind: str) -> set[str]:
    return {entry["name"] for entry in system.meta[kind]}


def run(
    name: str,
    h: float,
    *,
    car: str = PROTOTYPE,
    every: int = 1,
    settings: Settings | None = None,
    estimate_error: bool | None = False,
) -> Trajectory:
    """Simulate a manoeuvre of a car by name. `h`: step, s; `every`: steps between recorded instants."""
    system, manoeuvre = system_of(name, car), load(name, car)
    return run_on(system, manoeuvre, h, every=every, settings=settings, estimate_error=estimate_error)


def run_on(
    system: System,
    manoeuvre: Manoeuvre,
    h: float,
    *,
    every: int = 1,
    settings: Settings | None = None,
    estimate_error: bool | None = False,
) -> Trajectory:
    """Simulate a manoeuvre with any car; runs that are compared with a reference need no error estimate."""
    parameters, pose = start_of(manoeuvre, system)
    return simulate(
        system,
        manoeuvre.stop_time,
        h,
        inputs_of(manoeuvre, system),
        settings,
        parameters,
        every=every,
        pose=pose,
        progress=False,
        estimate_error=estimate_error,
    )


def time_on(system: System, manoeuvre: Manoeuvre, h: float, repeats: int, clock: Callable[[], float]) -> float:
    """Least time of all steps of a manoeuvre by a clock, s, without the start."""
    parameters, pose = start_of(manoeuvre, system)
    return step_time(system, manoeuvre.stop_time, h, repeats, clock, inputs_of(manoeuvre, system), parameters, pose)


def sampling(name: str, car: str = PROTOTYPE) -> float:
    """Interval between the samples of a reference, s: a multiple of 0.01 s that gives about 400 samples."""
    return max(1, round(load(name, car).stop_time / 400.0 / 0.01)) * 0.01


def record_driver(car: str) -> Manoeuvre:
    """The replay of the double lane change, driven now by the host's driver, which acts every 0.02 s."""
    h, interval = 1e-3, 0.02
    manoeuvre = load(CLOSED_LOOP, car)
    system = system_of(CLOSED_LOOP, car)
    driver = make_driver(manoeuvre.driver, {c["name"]: c["value"] for c in system.meta["constants"]})
    parameters, pose = start_of(manoeuvre, system)
    run = Simulation(system, parameters=parameters, pose=pose)
    rows = []
    for k in range(round(manoeuvre.stop_time / interval) + 1):
        acts = driver.act(k * interval, run.sensors)
        rows.append([float(f"{value:.6g}") for value in (k * interval, *(acts[pedal] for pedal in PEDALS))])
        for name, value in acts.items():
            run.set_input(name, value)
        run.step(h, round(interval / h))
    time, *inputs = np.array(rows).T
    return _replay(time, dict(zip(PEDALS, inputs, strict=True)), car)


def _replay(time: Column, inputs: dict[str, Column], car: str) -> Manoeuvre:
    return Manoeuvre(REPLAY, time, inputs, float(time[-1]), dict(load(CLOSED_LOOP, car).start))
