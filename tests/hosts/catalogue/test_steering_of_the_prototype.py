"""The tests with steering on the prototype: they agree with each other where they measure the same."""

import math

import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform
from hosts.catalogue.registry import standard_test

pytestmark = pytest.mark.slow


def measured(car: TestedCar, test: str, **settings: float) -> dict[str, float]:
    recorded: list[float] = []
    record = perform(standard_test(test), car, settings, recorded.append)
    assert len(recorded) > 2
    assert recorded == sorted(recorded)
    return {m.name: m.value for m in record.measures}


def test_step_sine_and_chirp_agree(prototype: TestedCar) -> None:
    step = measured(prototype, "step_steer", level_1=0.0, level_2=2.0, level_3=0.0, speed=80.0)
    chirp = measured(prototype, "chirp_steer", speed=80.0, duration=40.0)
    sine = measured(prototype, "sine_steer", speed=80.0, lateral_acceleration=2.0)
    # the chirp begins at 0.2 Hz, where the gain is a little below that of the steady state
    assert chirp["yaw_rate.gain"] == pytest.approx(step["level_2.yaw_rate.gain"], rel=0.03)
    assert chirp["lateral_acceleration.gain"] == pytest.approx(step["level_2.lateral_acceleration.gain"], rel=0.06)
    assert chirp["sideslip.gain"] == pytest.approx(
        abs(step["level_2.sideslip.steady"]) / step["level_2.steering_wheel_angle"], rel=0.1
    )
    assert sine["yaw_rate.lag"] == pytest.approx(-chirp["yaw_rate.phase_0_5_hz"] / math.pi, abs=0.02)
    assert sine["lateral_acceleration.lag"] == pytest.approx(
        -chirp["lateral_acceleration.phase_0_5_hz"] / math.pi, abs=0.03
    )
    assert step["level_2.asymmetry"] < 1e-3
    # a steady turn: lateral acceleration is speed times yaw rate
    ratio = step["level_2.lateral_acceleration.gain"] / step["level_2.yaw_rate.gain"]
    assert ratio == pytest.approx(80.0 / 3.6, rel=0.02)


def test_sine_with_dwell_of_a_car_without_stability_control(prototype: TestedCar) -> None:
    actual = measured(prototype, "sine_with_dwell", first=3.0, increment=2.0)
    assert math.degrees(actual["angle_at_0_3_g"]) == pytest.approx(18.6, abs=0.5)
    # it spins before the largest amplitudes, and to both sides at the same
    assert actual["yaw_rate_ratio_1_75"] > 0.2
    assert actual["stable_amplitude.left"] == pytest.approx(actual["stable_amplitude.right"])
    assert actual["stable_amplitude.left"] > 2.9 * actual["angle_at_0_3_g"]
