"""Variants of a System one after the other, in lanes and in threads: the same steps in turn, and what they take."""

import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmarks.car import manoeuvres
from benchmarks.shared.pages import Row, table
from mbs import Model, Simulation, System, compile
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.many import Many, widest_lanes
from mbs.scenes import assembly_defect_four_bar, double_four_bar, kerb_test, prototype_car
from mbs.settings.input_signals import InputSignals
from mbs.simulation.prepared_system import prepared

CARS = 16  # two full groups of the widest lanes
PARTS = 20  # parts of a run
SECONDS = 4.0  # length of a run, s
LANES = {
    "lanes": ("slalom", "lane change"),
    "lanes tables": ("slalom, tables", "lane change, tables"),
    "lanes planar": ("double four-bar", "40 windows"),
    "lanes flexible": ("slalom, flexible frame", "kerb test, flexible frame", "flexible four-bar"),
}
"""Scenes by table."""
WAYS = {"single": "one after the other"}
Start: TypeAlias = Callable[[int, float, float], Simulation]
"""Of the number of a variant, the step and the end of the run, s."""


def varied_cars(name: str, fidelity: int) -> tuple[System, Start]:
    """Cars whose springs and dampers differ by 1 % from one to the next."""
    manoeuvre, system = manoeuvres.load(name), compile(prototype_car.build(fidelity=fidelity))
    parameters, pose = manoeuvres.start_of(manoeuvre, system)
    signals = InputSignals(manoeuvres.inputs_of(manoeuvre, system), system.meta["inputs"])

    def start(number: int, h: float, seconds: float) -> Simulation:
        factors = dict.fromkeys(("front.spring.factor", "rear.damper.factor"), 1.0 + 0.01 * number)
        car = Simulation(system, inputs=signals.start_values(0.0, h), parameters=parameters | factors, pose=pose)
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
    scene: str, h: float, make: Callable[[], tuple[System, Start]], seconds: float = SECONDS, *, rounds: int = 1
) -> list[dict[str, Any]]:
    """Rows of one scene: us of a core for a step of a car, and the ratio to cars one after the other.

    Each way makes a part of the same steps in turn, so that ratios hold on a busy machine; seconds are those in which
    its threads had a core, and each part counts by the least of the rounds.
    """
    system, start = make()
    loaded, steps = prepared(system).loaded, int(seconds / h / PARTS)
    ways = _ways(loaded)
    least: dict[str, NDArray[np.float64]] = {}  # of each part
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for _ in range(rounds):
            cars = {way: [start(k, h, seconds) for k in range(CARS)] for way in ways}
            spent: dict[str, list[float]] = {way: [] for way in ways}
            alone = dict.fromkeys(ways, 0)
            for _ in range(PARTS):
                for way, many in ways.items():
                    used, made_alone = _step(cars[way], many, h, steps, pool)
                    spent[way].append(used)
                    alone[way] += made_alone
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
            "steps_alone": alone[way],
        }
        for way in ways
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


def lane_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the gain by lanes."""
    tables = {name: [row for row in rows if row["scene"] in scenes] for name, scenes in LANES.items()}
    return {name: _table_of_ways(part) for name, part in tables.items() if part}


def scene_of(row: Row) -> str:
    """Scene and step."""
    return f"{row['scene']}, {row['step_ms']:g} ms"


def _table_of_ways(rows: Sequence[Row]) -> str:
    """us a step and car by way and scene, with the ratio to one after the other."""
    lines: dict[str, dict[str, str]] = {}
    for row in rows:
        line = lines.setdefault(row["way"], {"way": WAYS.get(row["way"], row["way"])})
        line[scene_of(row)] = f"{row['us_a_step']:.1f} ({row['ratio']:.2f})"
    return table(list(lines.values()), dict.fromkeys(["way", *dict.fromkeys(map(scene_of, rows))], ""))


KERB = 7.0  # s: shortly before the front wheels are over it
SCENES = (
    ("slalom", 0.005, partial(varied_cars, "slalom", 0)),
    ("lane change", 0.01, partial(varied_cars, "double_lane_change_replay", 0)),
    ("slalom, tables", 0.005, partial(varied_cars, "slalom", 10)),
    ("lane change, tables", 0.01, partial(varied_cars, "double_lane_change_replay", 10)),
    ("slalom, flexible frame", 0.005, partial(varied_cars, "slalom", 3)),
    ("kerb test, flexible frame", 0.01, partial(one_after_another, partial(kerb_test.build, 3), KERB)),
    ("double four-bar", 0.01, partial(varied_four_bars, 2)),
    ("40 windows", 0.01, partial(varied_four_bars, 40)),
    ("flexible four-bar", 0.01, partial(one_after_another, assembly_defect_four_bar.build, 1.0)),
)
