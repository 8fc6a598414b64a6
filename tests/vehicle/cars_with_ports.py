"""Cars with ports, and a copy of a drive that closes a loop through them."""

from collections.abc import Callable
from functools import cache

import numpy as np

import mbs
from mbs.vehicle import load
from mbs.vehicle.car import Car
from tests.elements.harness import Element
from tests.vehicle.rigid_car import rigid_chassis

WHEELS = ("FL", "FR", "RL", "RR")
STEP = 0.002


@cache
def rigid() -> Car:
    """The prototype without the flexible frame."""
    return rigid_chassis()


@cache
def hatchback() -> Car:
    return load("hatchback")


def with_ports(car: Car, **ports: object) -> Car:
    return car.changed({f"ports.{name}": kind for name, kind in ports.items()})


@cache
def system(make: Callable[[], Car], ports: tuple[tuple[str, object], ...]) -> mbs.System:
    return mbs.compile(with_ports(make(), **dict(ports)).model())


def simulation(make: Callable[[], Car], speed: float = 10.0, **ports: object) -> mbs.Simulation:
    return mbs.Simulation(system(make, tuple(ports.items())), pose=mbs.Pose(speed=speed))


def works_of(sensors: dict[str, float]) -> dict[str, float]:
    """Works on a car, J, by the names of their outputs."""
    stored = {f"energy.{kind}" for kind in ("kinetic", "gravity", "elastic", "total")}
    return {n: x for n, x in sensors.items() if n.startswith("energy.") and n not in stored}


class SecondDrive:
    """A copy of the drive of a car in another place, which knows the speeds of the wheels alone."""

    def __init__(self, car: Car) -> None:
        record = next(e for e in car.model().elements if e.name == "drive")
        self.wheels = car.drive.wheels[0].upper()
        inputs = car.model().inputs
        self.element = Element(record, n_inputs=len(inputs))
        self.throttle = next(i.index for i in inputs if i.name == "throttle")
        self.selector = next(i.index for i in inputs if i.name == "selector")
        self.states = np.array(record.states)

    def torque(self, left: float, right: float, throttle: float, h: float) -> float:
        """On each driven wheel after a step."""
        inputs = np.zeros(self.element.n_inputs)
        inputs[self.throttle], inputs[self.selector] = throttle, 1.0
        u = np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
        ud = np.array([left, right, *6 * [0.0]])
        result = self.element(u, ud, self.states, h, 0.5 * h, 0.25 * h * h, inputs, True)
        self.states = result.y
        return float(result.f[0])


def throttle_at(t: float) -> float:
    return 0.2 + 0.6 * np.sin(1.5 * t) ** 2
