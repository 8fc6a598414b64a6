"""FMUs of a car with all ports: whatever comes in, steps are made or refused with a word."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hosts.fmu.built_fmu import build_fmu
from hosts.fmu.fmu import StepRefusedError
from hosts.plant import Car
from tests.hosts.plant.conftest import Made

WHEELS = ("FL", "FR", "RL", "RR")
ANSWER = ("x", "y", "height", "normal_x", "normal_y", "normal_z", "friction")


@pytest.fixture(scope="session")
def ported(made_once: Made, request: pytest.FixtureRequest) -> Path:
    """The hatchback with the ports of the test."""
    ports = str(request.param)
    options = ("--car", "hatchback", "--ports", ports)
    folder = made_once(f"hatchback_{ports.replace(',', '_')}", lambda at: build_fmu("a car", options, at))
    return next(folder.glob("*.fmu"))


def level(car: Car) -> dict[str, float]:
    """What stands on level ground: answers for the wheels, and forces of tyres that carry the car."""
    given = dict.fromkeys(car.inputs, 0.0)
    for w in WHEELS:
        given |= {f"wheel_{w}.road_normal_z": 1.0, f"wheel_{w}.road_friction": 0.9, f"wheel_{w}.hub_Fz": 3065.0}
    return {name: value for name, value in given.items() if name in car.inputs}


@pytest.mark.slow
@pytest.mark.parametrize("ported", ["torque,brakes=pressure,road,forces,wind", "tyre,forces=vehicle"], indirect=True)
def test_steps_jumps_nan_and_silence_at_every_port(ported: Path) -> None:
    values = [np.nan, np.inf, -np.inf, 1e6, -1e6, 0.0, 1.0, -1.0, 1e-300]
    with Car(ported, step=0.005) as car:
        ports = [name for name in car.inputs if "." in name]
        told = 0
        for seed in range(4):
            random = np.random.default_rng(seed)
            car.reset(**{"initial.speed": 10.0})
            given = level(car)
            for _ in range(60):
                for name in ports:
                    if random.random() < 0.03:
                        given[name] = float(random.choice(values))
                before = len(car.messages)
                try:
                    car.step([given[name] for name in car.inputs])
                except StepRefusedError:
                    assert len(car.messages) > before
                    given = level(car)
                state = car.read(("chassis.x", "chassis.z", "speed", "energy.total"))
                assert np.isfinite(state).all()
            told += len(car.messages)
        assert told > 10


@pytest.mark.slow
@pytest.mark.parametrize("ported", ["torque,brakes=pressure,road,forces,wind"], indirect=True)
def test_road_answers_from_python_are_those_of_the_closed_car_on_level_ground(ported: Path) -> None:
    """Asked in turn every 2 ms, it rolls out as one on its own level road does: straight, at its height of rest."""
    asked = tuple(f"wheel_{w}.contact_{c}" for c in "xy" for w in WHEELS)
    with Car(ported, step=0.002) as car:
        car.reset(**{"initial.speed": 12.0})
        begin, first = car.read(("chassis.x", "chassis.z"))
        given = level(car)
        for _ in range(250):
            places = car.read(asked).reshape(2, 4)
            for w, x, y in zip(WHEELS, *places, strict=True):
                given |= {f"wheel_{w}.road_x": float(x), f"wheel_{w}.road_y": float(y)}
            car.step([given[name] for name in car.inputs])
        x, y, z, road = car.read(("chassis.x", "chassis.y", "chassis.z", "energy.road"))
        assert x - begin > 5.0
        assert abs(y) < 1e-6
        assert z == pytest.approx(first, abs=2e-3)
        assert abs(road) < 1e-6
        assert not car.messages
