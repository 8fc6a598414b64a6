"""Variants of a System one after the other, in lanes and in threads: the same steps in turn, and what they take."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmarks.car import manoeuvres
from benchmarks.car.older_cars import OlderCars
from mbs import Model, Simulation, System, compile
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.many import Many, widest_lanes
from mbs.scenes import double_four_bar, prototype_car
from mbs.settings.input_signals import InputSignals
from mbs.simulation.prepared_system import prepared

CARS = 16  # two full groups of the widest lanes
PARTS, SECONDS = 20, 4.0  # parts of a run, length of it, s
OLDER = "single, older"
Start: TypeAlias = Callable[[int, float, float], Simulation]
"""Of the number of a variant, the step and the end of the run, s."""


def varied_cars(name: str, fidelity: int) -> tuple[System, Start]:
    """Cars whose springs and dampers differ by 1 % from one to the next."""
    manoeuvre, system = manoeuvres.load(name), compile(prototype_car.build(fidelity=fidelity))
    parameters, pose = manoeuvres.start_of(manoeuvre, system)
    signals = InputSignals(manoeuvres.inputs_of(manoeuvre, system), system.meta["inputs"])
    names = [system.meta["inputs"][i]["name"] for i in signals.columns()]

    def start(number: int, h: float, seconds: float) -> Simulation:
        factors = dict.fromkeys(("front.spring.factor", "rear.damper.factor"), 1.0 + 0.01 * number)
        first = signals.at(np.zeros(1), 1e-6 * h, after_jump=True)[0].tolist()
        inputs = dict(zip(names, first, strict=True))
        car = Simulation(system, inputs=inputs, parameters=parameters | factors, pose=pose)
        signals.attach(car.instance, 0.0, seconds, 1e-6 * h)
        return car

    return system, start


def varied_four_bars(windows: int) -> tuple[System, Start]:
    """Mechanisms whose starting speeds differ by 1 % from one to the next."""
    system = compile(double_four_bar.build(windows))

    def start(number: int, h: float, seconds: float) -> Simulation:
        mechanism = Simulation(system)
        mechanism.instance.set_q(None, ((1.0 + 0.01 * number) * mechanism.state.qd).tolist())
        mechanism.instance.initialise()
        return mechanism

    return system, start


def one_after_another(build: Callable[[], Model], begin: float) -> tuple[System, Start]:
    """Systems each of which is a step further in its motion than the one before, the first at `begin`, s."""
    system = compile(build())
    first: dict[float, bytes] = {}

    def start(number: int, h: float, seconds: float) -> Simulation:
        simulation = Simulation(system)
        if h not in first:
            simulation.instance.run(h, round(begin / h))
            first[h] = simulation.instance.save()
        simulation.instance.restore(first[h])
        simulation.instance.run(h, number)
        return simulation

    return system, start


def measure(
    scene: str,
    h: float,
    make: Callable[[], tuple[System, Start]],
    seconds: float = SECONDS,
    *,
    rounds: int = 1,
    older: OlderCars | None = None,
) -> list[dict[str, Any]]:
    """Rows of one scene: us of a core for a step of a car, and the ratio to cars one after the other.

    Each part of a run counts by the least of the rounds. `older` are cars of another commit, which make the same steps
    in turn; then rows have the ratio to them too.
    """
    system, start = make()
    loaded, steps = prepared(system)[0], int(seconds / h / PARTS)
    ways = _ways(loaded)
    least: dict[str, NDArray[np.float64]] = {}  # of each part
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for _ in range(rounds):
            cars = {way: [start(k, h, seconds) for k in range(CARS)] for way in ways}
            spent: dict[str, list[float]] = {way: [] for way in ways}
            alone = dict.fromkeys(ways, 0)
            if older is not None:
                older.start()
                spent[OLDER] = []
            for _ in range(PARTS):
                for way, many in ways.items():
                    used, made_alone = _step(cars[way], many, h, steps, pool)
                    spent[way].append(used)
                    alone[way] += made_alone
                if older is not None:
                    spent[OLDER].append(older.run(steps))
            least = {way: np.minimum(part, least.get(way, np.inf)) for way, part in spent.items()}
    for way in ways:  # a faster run of other numbers would be none
        if any(a.instance.save() != b.instance.save() for a, b in zip(cars["single"], cars[way], strict=True)):
            raise RuntimeError(f"{scene}: the cars in {way} are not those one after the other.")
    us = {way: 1e6 * float(part.sum()) / (CARS * PARTS * steps) for way, part in least.items()}
    return [
        {
            "scene": scene,
            "step_ms": 1e3 * h,
            "way": way,
            "us_a_step": us[way],
            "ratio": us["single"] / us[way],
            "cars_in_real_time_a_core": h / (1e-6 * us[way]),
            "steps_alone": alone[way],
            "kilobytes_a_car": 1e-3 * (loaded.instance_size + (many[0].size / many[0].width if many else 0.0)),
        }
        | ({"ratio_to_older": us[OLDER] / us[way]} if older is not None else {})
        for way, many in ways.items()
    ]


def _ways(loaded: LoadedSystem) -> dict[str, list[Many]]:
    """Ways to step the cars by name, with the groups of each: none for a car alone, one a thread."""
    widths = [w for w in (2, 4, 8) if w <= widest_lanes()]
    cores = os.cpu_count() or 1
    ways: dict[str, list[Many]] = {"single": [], **{f"{w} lanes": [Many(loaded, w)] for w in widths}}
    return ways | {f"{widths[-1]} lanes, {cores} threads": [Many(loaded, widths[-1]) for _ in range(cores)]}


def _step(
    cars: list[Simulation], groups: list[Many], h: float, steps: int, pool: ThreadPoolExecutor
) -> tuple[float, int]:
    """Seconds of cores for so many steps of the cars, and how many were made alone."""

    def together(number: int) -> int:
        many, alone = groups[number], 0
        for first in range(number * size, len(cars), len(groups) * size):
            instances = [car.instance for car in cars[first : first + size]]
            nothing = [None] * len(instances)
            for end in many.run(instances, h, steps, steps, nothing, nothing):
                if end.error is not None:
                    raise end.error
                alone += end.alone
        return alone

    size = min(groups[0].width, -(-len(cars) // len(groups))) if groups else 1
    begin = time.process_time()
    if not groups:
        for car in cars:
            car.instance.run(h, steps)
    alone = sum((pool.map if len(groups) > 1 else map)(together, range(len(groups))))
    return time.process_time() - begin, alone
