"""Pilots hold a speed and steer by a table."""

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering_table import SteeringTable


def hold(pilot: SpeedHolder, start: float, seconds: float, push: float = 4.0, step: float = 0.01) -> np.ndarray:
    """Speeds of a car of at most `push` m/s2, slowed down by 0.1 m/s2 and 0.0005/m of the square of its speed."""
    speed, speeds = start, []
    for k in range(round(seconds / step)):
        act = pilot.act(k * step, {"speed": speed})
        speeds.append(speed)
        speed += step * (push * act["throttle"] - 9.0 * act.get("brake", 0.0) - 0.1 - 5e-4 * speed**2)
    return np.array(speeds)


def test_speed_is_held_without_a_lasting_error() -> None:
    assert hold(SpeedHolder(20.0), 18.0, 60.0)[-1] == pytest.approx(20.0, abs=0.01)


def test_a_rising_speed_is_followed_closer_with_the_acceleration_fed_forward() -> None:
    reference = 10.0 + 0.5 * np.arange(2000) * 0.01
    with_it, without = (
        np.abs(hold(SpeedHolder(lambda t: 10.0 + 0.5 * t, acceleration_gain=g), 10.0, 20.0) - reference).max()
        for g in (0.25, 0.0)
    )
    assert with_it < 0.5 * without
    assert with_it < 0.2


def test_it_starts_with_the_pedal_that_it_is_given() -> None:
    """What the acceleration asks for is part of it, and does not come on top."""
    pilot = SpeedHolder(lambda t: 20.0 - 7.0 * t, acceleration_gain=0.1, pedal=-0.3)
    first, second = (pilot.act(t, {"speed": 20.0 - 7.0 * t}) for t in (0.0, 0.01))
    assert first["brake"] == pytest.approx(0.3, abs=1e-9)
    assert second["brake"] == pytest.approx(0.3, abs=1e-6)


def test_without_brakes_a_car_that_is_too_fast_rolls() -> None:
    pilot = SpeedHolder(10.0, brakes=False)
    assert pilot.act(0.0, {"speed": 30.0}) == {"throttle": 0.0}


def slipping(left: float, right: float) -> dict[str, float]:
    return {"speed": 10.0, "wheel_FL.slip": 0.0, "wheel_FR.slip": 0.0, "wheel_RL.slip": left, "wheel_RR.slip": right}


def test_throttle_is_eased_where_both_wheels_of_an_axle_slide() -> None:
    """Not where one of them does, as the lighter one behind an open differential."""
    acts = [
        SpeedHolder(20.0, gain=1.0, sliding=0.08).act(0.0, slipping(*s))
        for s in ((0.08, 0.3), (0.12, 0.12), (0.12, 0.16), (0.2, 0.3), (-0.2, -0.2), (0.3, 0.0))
    ]
    assert [act["throttle"] for act in acts] == pytest.approx([1.0, 0.5, 0.5, 0.0, 1.0, 1.0])
    assert SpeedHolder(20.0, gain=1.0).act(0.0, slipping(0.3, 0.3))["throttle"] == 1.0, "by default never"
    assert SpeedHolder(20.0, gain=1.0, sliding=0.08).act(0.0, {"speed": 10.0})["throttle"] == 1.0, "no slips are told"


def test_the_integral_waits_while_the_throttle_is_eased() -> None:
    free, slid = (SpeedHolder(10.1, gain=1.0, integral_gain=1.0, sliding=0.08) for _ in range(2))
    for k in range(100):
        free.act(0.01 * k, slipping(0.0, 0.0))
        slid.act(0.01 * k, slipping(0.1, 0.1))
    after, kept = (pilot.act(1.0, slipping(0.0, 0.0))["throttle"] for pilot in (free, slid))
    assert after == pytest.approx(0.1 + 0.1, abs=2e-3)
    assert kept == pytest.approx(0.1, abs=2e-3)


def test_tables_are_linear_between_and_step_where_a_time_stands_twice() -> None:
    table = SteeringTable([0.0, 1.0, 1.0, 2.0], [0.0, 0.0, 0.5, 1.5], "steering_wheel_angle_demand")
    values = [table.act(t, {})["steering_wheel_angle_demand"] for t in (-1.0, 0.999, 1.0 - 1e-12, 1.5, 3.0)]
    assert values == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.5], abs=1e-6)


@pytest.mark.parametrize(
    ("time", "values", "message"),
    [([0.0, 1.0], [0.0], "2 times and 1 values"), ([], [], "0 times"), ([0.0, 2.0, 1.0], [0.0] * 3, "from 2 s to 1 s")],
)
def test_a_wrong_table_is_reported(time: list[float], values: list[float], message: str) -> None:
    with pytest.raises(HostError, match=message):
        SteeringTable(time, values)


def test_the_later_pilot_wins() -> None:
    pilots = CombinedPilot(SteeringTable([0.0], [0.1]), SpeedHolder(5.0), SteeringTable([0.0], [0.2]))
    assert pilots.act(0.0, {"speed": 5.0}) == {"steering": 0.2, "throttle": 0.0, "brake": 0.0}
