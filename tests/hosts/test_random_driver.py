"""The random driver: repeatable by its seed, within the ranges of the controls, and its targets."""

import math

import numpy as np
import pytest

from hosts.driving.pilots.pilot import OBSERVED
from hosts.driving.random_driver import TOP_SPEED, RandomDriver, Target, random_start

CONTROLS = ("steering", "throttle", "brake", "hand_brake", "selector")
STEP = 0.01


def drive(seed: int, speed: float = 10.0, seconds: float = 200.0) -> np.ndarray:
    driver = RandomDriver(seed, CONTROLS)
    acts = [driver.act(k * STEP, {"speed": speed}) for k in range(round(seconds / STEP))]
    return np.array([[act[name] for name in CONTROLS] for act in acts])


def test_a_seed_gives_the_same_drive_and_another_seed_another() -> None:
    assert np.array_equal(drive(3, seconds=20.0), drive(3, seconds=20.0))
    assert not np.array_equal(drive(3, seconds=20.0), drive(4, seconds=20.0))


def test_controls_use_their_whole_ranges_and_no_more() -> None:
    acts = drive(1)
    assert np.min(acts, axis=0).tolist() == pytest.approx([-1.0, 0.0, 0.0, 0.0, -1.0], abs=0.02)
    assert np.max(acts, axis=0).tolist() == pytest.approx([1.0, 1.0, 1.0, 1.0, 1.0], abs=0.02)
    assert np.all(np.abs(acts[:, :1]) <= 1.0)
    assert np.all((acts[:, 1:4] >= 0.0) & (acts[:, 1:4] <= 1.0))
    assert set(acts[:, 4]) == {-1.0, 0.0, 1.0}
    turns = np.abs(np.diff(acts[:, 0]))
    assert np.count_nonzero(turns > 1.5) > 5  # from lock to lock within a step
    assert np.count_nonzero((turns > 0.0) & (turns < 0.1)) > 100  # sines


def test_above_the_top_speed_the_throttle_is_let_go() -> None:
    acts = drive(2, TOP_SPEED + 1.0)
    assert np.all(acts[:, 1] == 0.0)
    assert np.all(acts[:, 2] > 0.0)


def test_inputs_that_there_are_not_are_left_out() -> None:
    assert set(RandomDriver(1, ["throttle", "torque"]).act(0.0, {})) == {"throttle"}
    driver = RandomDriver(1, ["steering_wheel_angle_demand"])
    angles = [driver.act(k * STEP, {})["steering_wheel_angle_demand"] for k in range(5000)]
    assert np.ptp(angles) > 10.0


def test_the_driver_crosses_the_target_in_its_direction() -> None:
    """A point that turns as its driver steers, at 10 m/s with a turning circle of 5 m."""
    target, step = Target(20.0, -10.0, 0.5), 0.01
    met = []
    for seed in range(40):
        driver = RandomDriver(seed, CONTROLS, [target])
        x, y, yaw = -10.0, 30.0, 2.0
        for k in range(2000):
            observation = dict(zip(OBSERVED, (x, y, yaw, 10.0), strict=True))
            yaw += step * 10.0 / 5.0 * driver.act(k * step, observation)["steering"]
            x, y = x + step * 10.0 * math.cos(yaw), y + step * 10.0 * math.sin(yaw)
            if math.hypot(x - target.x, y - target.y) < 1.5:
                met.append(math.remainder(yaw - target.yaw, 2.0 * math.pi))
                break
    assert len(met) >= 5
    assert np.median(np.abs(met)) < 0.3


def test_starts_are_fast_in_the_air_and_far_away() -> None:
    starts = [random_start(seed) for seed in range(400)]
    assert starts[7] == random_start(7)
    values = {name: np.array([start[f"initial.{name}"] for start in starts]) for name in ("x", "z", "yaw", "speed")}
    assert 35.0 < values["speed"].max() <= TOP_SPEED
    assert np.count_nonzero(values["z"] == 0.0) > 100
    assert 0.9 < values["z"].max() <= 1.0
    assert np.count_nonzero(np.abs(values["x"]) > 5e4) > 20
    assert np.abs(values["x"]).max() <= 1e5
    target = Target(100.0, 50.0, 1.0)
    before = [start for start in (random_start(seed, [target]) for seed in range(50)) if start["initial.yaw"] == 1.0]
    assert len(before) > 10
    for start in before:
        along = (start["initial.x"] - 100.0) * math.cos(1.0) + (start["initial.y"] - 50.0) * math.sin(1.0)
        assert -60.0 <= along <= -30.0
