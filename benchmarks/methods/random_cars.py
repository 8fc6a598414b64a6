"""Random drives of cars over kerbs, and falls, with references by two methods."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

import mbs
from benchmarks.references.newton_euler import NoReferenceError
from mbs.elements.road import KerbRoad
from mbs.results.comparison import compared_sensors, differences
from mbs.simulation.prepared_system import length_of
from mbs.vehicle import load as load_car

Array = NDArray[np.float64]
CARS = ("prototype", "hatchback")
STEPS = (0.02, 0.01, 0.005, 0.002)  # s
INTERVAL = 0.02  # s between recorded instants
CHECK_STEP = 2.5e-4  # step of energy-momentum, s
FINE_STEP = 1e-4  # step of ALi3-P, s
MAX_DIFFERENCE = 0.01  # largest difference of both, relative to the range


@dataclass(frozen=True)
class Drive:
    """A drive; the kerb is 3 m ahead of the front axle, `step` m up (positive) or down; 0: no kerb.

    `z`: initial height, m; `yaw`: rad; `speed`: m/s; `steering`: values at the start and from 0.3 s; `pedals`: throttle
    and brake; `span`: duration, s.
    """

    car: str
    step: float
    z: float
    yaw: float
    speed: float
    steering: tuple[float, float]
    pedals: tuple[float, float]
    span: float

    def run(self, method: str = "ali3p", h: float | None = None, **more: Any) -> mbs.Trajectory:
        """Simulate the drive with a method and a step, s."""
        times = np.array([0.0, 0.3, self.span])
        inputs = {
            "steering": (times, np.array([self.steering[0], *[self.steering[1]] * 2])),
            "throttle": self.pedals[0],
            "brake": self.pedals[1],
        }
        pose = mbs.Pose(z=self.z, yaw=self.yaw, speed=self.speed)
        if h is not None:
            more["every"] = round(INTERVAL / h)
        return mbs.simulate(
            self.system, self.span, h, inputs, pose=pose, method=method, progress=False, **more
        )  # fmt: skip

    @property
    def system(self) -> mbs.System:
        """The car on its road."""
        return system_of(self.car, self.step)

    def reference(self) -> dict[str, Array]:
        """Compared sensors at the recorded instants, by `reference_by_two_methods`."""
        return reference_by_two_methods(self.system, lambda method, h: self.run(method, h, estimate_error=False))


def random_drive(rng: np.random.Generator) -> Drive:
    """A random drive over a kerb, or a fall."""
    car = str(rng.choice(CARS))
    falls = rng.random() < 0.3
    step = 0.0 if falls else float(round(rng.choice([-1.0, 1.0]) * rng.uniform(0.02, 0.12), 3))
    return Drive(
        car,
        step,
        float(rng.uniform(0.05, 0.5)) if falls else 0.0,
        float(rng.choice([0.0, rng.uniform(-0.6, 0.6)])),
        float(rng.uniform(0.0, 25.0)) if falls else float(rng.uniform(3.0, 25.0)),
        (0.0, float(rng.choice([0.0, rng.uniform(-0.3, 0.3)]))),
        (float(rng.choice([0.0, 0.3])), 0.0) if rng.random() < 0.7 else (0.0, float(rng.uniform(0.0, 0.6))),
        float(round(rng.uniform(1.2, 2.2) / INTERVAL) * INTERVAL),
    )


def reference_by_two_methods(system: mbs.System, simulate: Callable[[str, float], mbs.Trajectory]) -> dict[str, Array]:
    """Compared sensors at the recorded instants, confirmed by a second method.

    `simulate`: simulates with a method and a step, s. Raises `NoReferenceError` if both runs differ, or one is refused.
    """
    try:
        fine, other = simulate("ali3p", FINE_STEP), simulate("energy_momentum", CHECK_STEP)
    except mbs.SimulationError as refused:
        raise NoReferenceError(str(refused)) from refused
    judged = {name: sensor for name, sensor in compared_sensors(system).items() if sensor.always}
    apart = max(differences(other, fine, judged, None, length_of(system))[0].values())
    if not apart <= MAX_DIFFERENCE:
        raise NoReferenceError(f"two methods differ by {apart:.1e} of the range")
    return {name: fine[name] for name in judged}


@cache
def system_of(name: str, step: float) -> mbs.System:
    """A car on level ground with a kerb, `step` m up (positive) or down; 0: on the road of its file."""
    car = load_car(name)
    if step == 0.0:
        return mbs.compile(car.model())
    upper = "after" if step > 0.0 else "before"
    return mbs.compile(car.model(KerbRoad(3.0, abs(step), min(step, 0.0), upper, car.road.friction)))
