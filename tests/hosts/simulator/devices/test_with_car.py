"""A virtual wheel drives the FMU of a car, and its motor feels the car."""

import math
from typing import Any

import pytest

from hosts.simulator.car import Car, CarSettings
from hosts.simulator.input_arbiter import InputArbiter
from tests.hosts.simulator.devices.haptics import Haptics
from tests.hosts.simulator.pages import until


@pytest.mark.slow
def test_the_car_follows_the_angle_of_the_wheel_and_pulls_it_back(prototype_fmu, wheel, start, monkeypatch):
    haptics = Haptics().install(monkeypatch)
    with Car(CarSettings(fmu=prototype_fmu, start={"initial.speed": 12.0}, priority=False)) as car:

        def now(name: str) -> float:
            return float(car.latest().values[car.names.index(name)])

        def torque() -> float | None:
            return now("steering_wheel_torque") if car.latest().running else None

        run: Any = start(torque, inputs=car.inputs, constants=car.constants)
        run.devices._reader._arbiter = InputArbiter(car.want, car.inputs)
        car.command("run")
        turned = math.radians(60.0)
        wheel.axis(0, -turned / math.radians(450.0))
        until(lambda: abs(now("steering_wheel_angle") - turned) < 1e-3)
        until(lambda: now("chassis.ay") > 1.0)
        until(lambda: haptics.levels[-1] < -200)
        assert now("steering_wheel_torque") > 0.0
        car.command("pause")
        until(lambda: haptics.levels[-1] == 0)
        car.command("run")
        wheel.pull_out()
        until(lambda: run.said("Wheel was pulled out; steering let go."))
        until(lambda: abs(now("steering_wheel_angle")) < 1e-3)
        run.devices.close()
