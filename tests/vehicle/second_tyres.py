"""Copies of the tyres of a car outside of its model, at the ports of its hubs, and tables of their stability.

python -m tests.vehicle.second_tyres [--limits]
"""

import sys
from collections.abc import Callable, Mapping
from functools import cache

import numpy as np

import mbs
from mbs.elements import PlaneRoad
from mbs.kernel.binding import KernelError
from mbs.vehicle import Car, load
from tests.elements.harness import Element
from tests.vehicle.cars_with_ports import WHEELS, hatchback, rigid, simulation

HUB = [f"hub_{letter}{c}" for letter in "FM" for c in "xyz"]
INNER = 0.002  # s


@cache
def saloon() -> Car:
    """A car with tyres of a property file, which have less damping."""
    return load("saloon")


class SecondTyre:
    """A tyre that is computed from the motion of its hub alone."""

    def __init__(self, wheel: str, car: Car) -> None:
        record = next(e for e in car.model().elements if e.name == f"tyre {wheel}")
        self.wheel, self.element = wheel, Element(record, PlaneRoad(friction=car.road.friction))
        self.states = np.array(record.states)

    def wrench(self, now: dict[str, float], step: float) -> tuple[np.ndarray, float]:
        """Force and moment on the hub, and the load, after a step to the present motion."""
        names = [*"xyz", *(f"axis_{c}" for c in "xyz")]
        rates = [*(f"earth_v{c}" for c in "xyz"), *(f"axis_rate_{c}" for c in "xyz"), "omega"]
        u = np.array([*(now[f"wheel_{self.wheel}.{n}"] for n in names), 0.0])
        ud = np.array([now[f"wheel_{self.wheel}.{n}"] for n in rates])
        r = self.element(u, ud, self.states, step, accept=True)
        self.states, axis = r.y, u[3:6]
        return np.r_[r.f[:3], np.cross(axis, r.f[3:6]) + r.f[6] * axis], r.out["vertical_force"]


def drive(
    step: float,
    speed: float,
    *,
    make: Callable[[], Car] = hatchback,
    slopes: bool = False,
    late: bool = False,
    time: float = 0.6,
    steer: float = 0.3,
    pedals: Mapping[str, float] | None = None,
) -> tuple[float, float, float, mbs.Simulation]:
    """Relative differences of wheel loads, path and wheel speeds to the closed model, and the car with the loop.
    `step`: s.

    With `slopes` forces are extrapolated linearly within a step, as by derivatives of inputs; with `late` they act one
    step later, as when both parts step at the same time.
    """
    closed, loop = simulation(make, speed), simulation(make, speed, tyre="hub")
    names = [entry["name"] for entry in loop.system.meta["inputs"]]
    tyres = [SecondTyre(w, make()) for w in WHEELS]
    indices = [[names.index(f"wheel_{w}.{n}") for n in HUB] for w in WHEELS]
    n, loads, last = max(1, round(step / INNER)), [], None
    coming = None
    for k in range(round(time / step)):
        now = loop.sensors
        wrenches = [tyre.wrench(now, step if k else 0.0) for tyre in tyres]
        computed = np.array([each for each, _ in wrenches])
        wrench, coming = computed if not late or coming is None else coming, computed
        rate = np.zeros_like(wrench) if last is None or not slopes else (wrench - last) / step
        last = wrench
        loads.append([[closed.sensors[f"wheel_{w}.Fz"], load] for w, (_, load) in zip(WHEELS, wrenches, strict=True)])
        for s in (closed, loop):
            s.set_input("steering", steer * np.sin(5.0 * s.time))
            for pedal, value in (pedals or {}).items():
                s.set_input(pedal, value)
        for wheel_indices, values in zip(indices, wrench, strict=True):
            for index, value in zip(wheel_indices, values, strict=True):
                loop.set_input(names[index], float(value))
        row = np.array([loop.instance.get_input(i) for i in range(len(names))])
        for j in range(n):
            row[np.array(indices)] = wrench + rate * (j + 1) * step / n
            loop.instance.run(step / n, 1, row)
        closed.step(step / n, n)
    pairs, first, now = np.array(loads), closed.sensors, loop.sensors
    ends = [np.array([s["chassis.x"], s["chassis.y"]]) for s in (first, now)]
    spins = [np.array([s[f"wheel_{w}.omega"] for w in WHEELS]) for s in (first, now)]
    return (
        float(np.sqrt(np.mean(np.diff(pairs) ** 2)) / pairs.mean()),
        float(np.linalg.norm(ends[0] - ends[1]) / max(np.linalg.norm(ends[0]), 1.0)),
        float(np.abs(spins[1] - spins[0]).max() / max(np.abs(spins[0]).max(), 1.0)),
        loop,
    )


def longest(car: Car, speed: float, *, slopes: bool, late: bool) -> float:
    """Step at the stability limit of the spin of a front wheel (decision 225), s."""
    by_slip, stiffness, settling, fading = car.front.tyre.carcass
    lever = car.front.tyre.radius**2 / car.front.wheel.spin_inertia
    time = settling / (1.0 + fading * speed**2) + speed / (by_slip * lever)
    if late:
        return 2.0 / 3.0 * time
    return float(np.cbrt(4.0 * time / (stiffness * lever))) if slopes else 2.0 * time


def print_limits() -> None:
    """Print the relative difference of the wheel speeds for steps near the stability limit, %."""
    parts = (0.85, 1.0, 1.2, 1.5)
    print("| car | forces | H, ms | " + " | ".join(f"{part:g} H" for part in parts) + " |")
    print("| --- | --- | --- |" + " --- |" * len(parts))
    for make in (hatchback, saloon, rigid):
        for late in (False, True):
            for slopes in (False, True):
                h = longest(make(), 5.0, slopes=slopes, late=late)
                results = [drive(part * h, 5.0, make=make, slopes=slopes, late=late, time=1.0)[2] for part in parts]
                forces = ("along derivatives" if slopes else "held") + (", at once" if late else "")
                name = "prototype" if make is rigid else make.__name__
                cells = " | ".join(f"{100.0 * deviation:.2g}" for deviation in results)
                print(f"| {name} | {forces} | {1e3 * h:.2g} | {cells} |", flush=True)


def main() -> None:
    """Print the relative difference of the wheel speeds, %, for held and for extrapolated forces."""
    steps = (0.001, 0.002, 0.005, 0.008, 0.01)
    print("| car | speed, m/s | " + " | ".join(f"{1e3 * step:g} ms" for step in steps) + " |")
    print("| --- | --- |" + " --- |" * len(steps))
    drives = [(speed, 0.0) for speed in (20.0, 10.0, 5.0, 1.0, 0.0)] + [(20.0, 1.0)]
    for make in (hatchback, saloon):
        for speed, brake in drives:
            steer, cells = 0.3 * (1.0 - brake), []
            for h in steps:
                spins = []
                for slopes in (False, True):
                    try:
                        run = drive(h, speed, make=make, slopes=slopes, time=1.0, steer=steer, pedals={"brake": brake})
                        spins.append(f"{100.0 * run[2]:.2g}")
                    except KernelError:
                        spins.append("fails")
                cells.append(", ".join(spins))
            name = f"{make.__name__}, full brakes" if brake else make.__name__
            print(f"| {name} | {speed:g} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    print_limits() if "--limits" in sys.argv[1:] else main()
