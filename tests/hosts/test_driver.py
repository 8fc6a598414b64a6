"""The driver steers a car without slip through the double lane change, and holds its speed."""

import math

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.driving.course import course_of
from hosts.driving.driver import make_driver
from hosts.driving.pilots.course_follower import DriverSettings
from hosts.recordings.load_manoeuvre import load_manoeuvre

SETTINGS = {"course": "iso_3888_1", "speed": "15"}
CAR = {"vehicle.wheelbase": 2.3, "vehicle.front_wheel_angle_max": 0.525, "vehicle.length": 3.2, "vehicle.width": 1.5}


def drive_bicycle(settings: dict[str, str], step: float = 0.01) -> dict[str, np.ndarray]:
    """A bicycle without slip that takes 0.2 s to answer the steering and accelerates by at most 4 m/s2."""
    driver = make_driver(settings, CAR)
    s = driver.settings
    rear_axle, curvature = 1.0, 0.0
    x, y, yaw, speed = -rear_axle, 0.0, 0.0, s.speed - 2.0
    rows = []
    for k in range(4000):
        cx, cy = x + rear_axle * math.cos(yaw), y + rear_axle * math.sin(yaw)
        rows.append((cx, cy, yaw, speed))
        act = driver.act(k * step, {"chassis.x": cx, "chassis.y": cy, "chassis.yaw": yaw, "speed": speed})
        speed += step * 4.0 * (act["throttle"] - act["brake"])
        curvature += step / 0.2 * (math.tan(act["steering"] * s.wheel_angle_max) / s.wheelbase - curvature)
        yaw += step * speed * curvature
        x += step * speed * math.cos(yaw)
        y += step * speed * math.sin(yaw)
    return dict(zip(("x", "y", "yaw", "speed"), np.array(rows).T, strict=True))


def test_course_has_the_lengths_and_widths_of_the_standard() -> None:
    course = course_of("iso_3888_1", vehicle_width=2.0, x_start=0.0)
    assert [(g.x_start, g.x_end) for g in course.gates] == [(0.0, 15.0), (45.0, 70.0), (95.0, 125.0)]
    widths = [g.y_left - g.y_right for g in course.gates]
    assert widths == pytest.approx([1.1 * 2.0 + 0.25, 1.2 * 2.0 + 0.25, 1.3 * 2.0 + 0.25])
    assert [g.centre for g in course.gates] == pytest.approx([0.0, 3.5, 0.0])


def test_path_runs_through_the_middle_of_the_gates_and_is_smooth() -> None:
    course = course_of("iso_3888_1", 1.5)
    for gate in course.gates:
        for x in np.linspace(gate.x_start, gate.x_end, 7):
            assert course.path(x)[0] == pytest.approx(gate.centre, abs=0.1)
    x = np.linspace(0.0, 160.0, 16001)
    y, slope, curvature = np.array([course.path(v) for v in x]).T
    assert np.gradient(y, x) == pytest.approx(slope, abs=1e-5)
    assert np.gradient(np.arctan(slope), x) == pytest.approx(curvature * np.sqrt(1.0 + slope**2), abs=1e-4)
    assert np.abs(np.diff(curvature)).max() < 1e-4


@pytest.mark.parametrize("speed", ["5", "15"])
def test_double_lane_change_is_passed(speed: str) -> None:
    run = drive_bicycle(SETTINGS | {"speed": speed})
    driver = make_driver(SETTINGS, CAR)
    outside = driver.course.corners_outside(run["x"], run["y"], run["yaw"], 3.2, 1.5)
    assert outside < 0.0
    assert run["y"].max() > 3.0
    assert run["x"].max() > 100.0
    assert run["speed"][-1] == pytest.approx(float(speed), abs=0.2)


def test_the_integral_waits_while_a_pedal_is_at_its_stop() -> None:
    """A minute of full throttle or brake leaves nothing behind: at the right speed neither pedal is pressed."""
    for speed, pedal in ((0.0, "throttle"), (60.0, "brake")):
        driver = make_driver(SETTINGS, CAR)
        observation = {"chassis.x": 0.0, "chassis.y": 0.0, "chassis.yaw": 0.0, "speed": speed}
        for k in range(60):
            assert driver.act(float(k), observation)[pedal] == 1.0
        now = driver.act(60.0, observation | {"speed": driver.settings.speed})
        assert now["throttle"] == now["brake"] == 0.0


def test_the_integral_removes_the_steady_error() -> None:
    """Half a metre a second too slow for two seconds, given twice: the pedal grows by gain times error times time."""
    driver = make_driver(SETTINGS, CAR)
    s = driver.settings
    observation = {"chassis.x": 0.0, "chassis.y": 0.0, "chassis.yaw": 0.0, "speed": s.speed - 0.5}
    pedals = [driver.act(t, observation)["throttle"] for t in (0.0, 2.0, 4.0)]
    assert np.diff(pedals) == pytest.approx([0.0, s.speed_integral * 0.5 * 2.0])


def test_settings_of_the_manoeuvre_are_those_of_a_driver() -> None:
    driver = make_driver(load_manoeuvre("double_lane_change").driver, CAR)
    assert driver.settings.speed == load_manoeuvre("double_lane_change").start["initial.speed"]
    assert driver.settings == DriverSettings(driver.settings.speed, 2.3, 0.525, 3.2, 1.5)
    assert make_driver(SETTINGS | {"wheelbase": "3.1"}, CAR).settings.wheelbase == 3.1


def test_constants_that_the_fmu_does_not_report_are_requested() -> None:
    constants = {name: value for name, value in CAR.items() if name != "vehicle.width"}
    with pytest.raises(HostError, match=r"this FMU does not provide .*'vehicle\.width'.*\[driver\]") as refusal:
        make_driver(SETTINGS, constants)
    assert "--driver vehicle_width=NUMBER" in str(refusal.value)
    assert make_driver(SETTINGS | {"vehicle_width": "1.25"}, constants)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"course": "moon", "speed": "1"}, "no course 'moon'"),
        ({"course": "iso_3888_1", "speed": "fast"}, "not a number"),
        ({"course": "iso_3888_1"}, "needs a course and a speed"),
        ({"course": "iso_3888_1", "speed": "1", "mood": "2"}, "'mood'"),
        ({"course": "iso_3888_1", "speed": "-20"}, r"speed is -20; it must be positive"),
        ({"course": "iso_3888_1", "speed": "nan"}, r"speed: the value is nan"),
        ({"course": "iso_3888_1", "speed": "9", "lateral_gain": "-1"}, r"lateral_gain is -1; it must be zero or"),
    ],
)
def test_bad_settings_are_refused(settings: dict[str, str], message: str) -> None:
    with pytest.raises(HostError, match=message):
        make_driver(settings, CAR)


def test_obstacle_avoidance_has_the_lengths_and_widths_of_public_summaries() -> None:
    """61 m in all; the right edges of the first and last lane in a line, the second 1 m beside the first."""
    for width, last in ((1.5, 3.0), (2.2, 1.3 * 2.2 + 0.25)):
        first, second, third = course_of("iso_3888_2", width, x_start=0.0).gates
        assert [(g.x_start, g.x_end) for g in (first, second, third)] == [(0.0, 12.0), (25.5, 36.5), (49.0, 61.0)]
        assert first.y_left - first.y_right == pytest.approx(1.1 * width + 0.25)
        assert second.y_left - second.y_right == pytest.approx(width + 1.0)
        assert third.y_left - third.y_right == pytest.approx(last)
        assert second.y_right - first.y_left == pytest.approx(1.0)
        assert third.y_right == pytest.approx(first.y_right)
        assert first.centre == 0.0
