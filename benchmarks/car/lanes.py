"""Variants of a System one after the other, in lanes and in threads: the same steps in turn, and what they take."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeAlias

import numpy as np

from benchmarks.car import manoeuvres
from mbs import Simulation, System, compile
from mbs.kernel.binding.many import Many, widest_lanes
from mbs.scenes import double_four_bar, prototype_car
from mbs.settings.input_signals import InputSignals
from mbs.simulation.prepared_system import prepared

CARS = 16  # two full groups of the widest lanes
PARTS, SECONDS = 20, 4.0  # parts of a run, length of it, s
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


def measure(
    scene: str, h: float, make: Callable[[], tuple[System, Start]], seconds: float = SECONDS
) -> list[dict[str, Any]]:
    """Rows of one scene: us of a core for a step of a car, and the ratio to cars one after the other."""
    system, start = make()
    loaded, steps = prepared(system)[0], int(seconds / h / PARTS)
    widths = [w for w in (2, 4, 8) if w <= widest_lanes()]
    cores = os.cpu_count() or 1
    threads = f"{widths[-1]} lanes, {cores} threads"
    ways = ["single", *(f"{w} lanes" for w in widths), threads]
    cars = {way: [start(k, h, seconds) for k in range(CARS)] for way in ways}
    lanes = {w: Many(loaded, w) for w in widths}
    more = [Many(loaded, widths[-1]) for _ in range(cores)]
    spent, alone = dict.fromkeys(ways, 0.0), dict.fromkeys(ways, 0)

    def together(many: Many, group: list[Simulation]) -> int:
        nothing = [None] * len(group)
        ended = many.run([c.instance for c in group], h, steps, steps, nothing, nothing)
        for end in ended:
            if end.error is not None:
                raise end.error
        return sum(end.alone for end in ended)

    def on_all_cores(group: list[Simulation]) -> int:
        size = min(widths[-1], -(-len(group) // cores))
        parts = [group[i : i + size] for i in range(0, len(group), size)]
        return sum(pool.map(together, more, parts))

    with ThreadPoolExecutor(cores) as pool:
        for _ in range(PARTS):
            spent["single"] += _timed(lambda: [c.instance.run(h, steps) for c in cars["single"]], time.thread_time)
            for w in widths:
                way = f"{w} lanes"
                for first in range(0, CARS, w):
                    group, many = cars[way][first : first + w], lanes[w]
                    begin = time.thread_time()
                    alone[way] += together(many, group)
                    spent[way] += time.thread_time() - begin
            begin = time.process_time()
            alone[threads] += on_all_cores(cars[threads])
            spent[threads] += time.process_time() - begin
    for way in ways[1:]:  # a faster run of other numbers would be none
        if any(a.instance.save() != b.instance.save() for a, b in zip(cars["single"], cars[way], strict=True)):
            raise RuntimeError(f"{scene}: the cars in {way} are not those one after the other.")
    made = CARS * PARTS * steps
    rows = []
    for way in ways:
        us = 1e6 * spent[way] / made
        group_bytes = 0.0 if way == "single" else lanes[int(way.split()[0])].size / int(way.split()[0])
        rows.append(
            {
                "scene": scene,
                "step_ms": 1e3 * h,
                "way": way,
                "us_a_step": us,
                "ratio": spent["single"] / spent[way],
                "cars_in_real_time_a_core": h / (1e-6 * us),
                "steps_alone": alone[way],
                "kilobytes_a_car": 1e-3 * (loaded.instance_size + group_bytes),
            }
        )
    return rows


def _timed(action: Callable[[], object], clock: Callable[[], float]) -> float:
    begin = clock()
    action()
    return clock() - begin
