"""Ground marks of a manoeuvre: the circle, the line where braking begins, and cones of a course."""

import math
from dataclasses import astuple, replace
from pathlib import Path

import numpy as np
import pytest

from ali3.scene.base64_numbers import encoded
from hosts.catalogue.car import TestedCar
from hosts.common.errors import HostError
from hosts.driving.co_simulation import run
from hosts.driving.course import course_of
from hosts.driving.course_scenery import scenery_of, with_marks
from hosts.driving.ground_marks import lanes, marks_of_inputs
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.braking_pilot import Braking
from hosts.driving.pilots.circle_follower import CircleFollower
from hosts.driving.pilots.course_follower import CourseFollower, DriverSettings
from hosts.driving.pilots.run_up_pilot import RunUpPilot
from hosts.driving.pilots.steering_table import FixedSteering
from hosts.driving.result import Result
from hosts.driving.runs_with_progress import run_with_bar
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.view.result_record import with_recorded_marks

TIME = np.arange(0.0, 15.01, 0.01)
PLANE = {"kind": "plane", "point": [1.0, 0.0, 0.5], "normal": [-0.1, 0.2, 1.0]}


def driven(**columns: np.ndarray) -> Result:
    """A result with these columns; the others are zero."""
    names = ("steering", "brake", "chassis.x", "chassis.y", "chassis.yaw", "speed", "chassis.wz", "sideslip")
    values = np.column_stack([np.broadcast_to(columns.get(name.replace(".", "_"), 0.0), TIME.shape) for name in names])
    return Result(list(names), dict.fromkeys(names, "1"), TIME, values, 0.0, TIME[-1], 0, [])


def on_circle(radius: float, speed: float, sideslip: float) -> Result:
    """Steady driving on a circle about (3, -4), with the steering as it is from 1 s on."""
    angle = TIME * speed / radius
    return driven(
        steering=np.where(TIME < 1.0, 0.0, 0.1),
        chassis_x=3.0 + radius * np.sin(angle),
        chassis_y=-4.0 - radius * np.cos(angle),
        chassis_yaw=angle - sideslip,
        speed=speed,
        chassis_wz=speed / radius,
        sideslip=sideslip,
    )


def test_steering_that_stays_brings_the_circle_it_begins_with() -> None:
    radius = -25.0
    (actual,) = marks_of_inputs(on_circle(radius, 8.0, -0.05))
    assert actual["centre"] == pytest.approx([3.0, -4.0], abs=1e-9)
    assert actual["radius"] == pytest.approx(abs(radius))


@pytest.mark.slow
def test_runs_that_are_looked_at_have_their_marks(prototype_fmu: Path) -> None:
    """Those of commands with a bar and of the catalogue, with a pilot and without; a run that nobody sees has none."""
    table = np.array([0.0, 1.0, 11.5])
    turn = Manoeuvre("turn", table, {"steering": np.array([0.0, 0.1, 0.1])}, 11.5, {"initial.speed": 8.0})
    pilot = CircleFollower(30.0, 8.0, 2.0, 6.0)
    with Fmu(prototype_fmu) as fmu:
        shown = run_with_bar(fmu, turn, 0.01)
        fmu.reset()
        assert run(fmu, replace(turn, stop_time=0.1), 0.01).marks == []
    assert [mark["kind"] for mark in shown.marks] == ["circle"]
    tested = TestedCar("prototype", FmuSource(prototype_fmu), step=0.01).drive(replace(turn, stop_time=0.1), pilot)
    assert tested.marks == pilot.marks != []


def test_a_straight_run_brings_the_line_where_it_begins_to_stop() -> None:
    speed = np.where(TIME < 10.0, 20.0, np.maximum(0.0, 20.0 - 8.0 * (TIME - 10.0)))
    distance = np.cumsum(speed) * 0.01
    brake = np.where(TIME < 0.5, 0.3, np.where(TIME > 10.0, 0.8, 0.0))  # it holds the car at the start, too
    (actual,) = marks_of_inputs(driven(brake=brake, speed=speed, chassis_x=distance))
    begins = np.flatnonzero(TIME <= 10.0)[-1]
    assert np.array(actual["points"])[:, 0] == pytest.approx(distance[begins], abs=0.21)
    assert np.ptp(np.array(actual["points"])[:, 1]) == pytest.approx(4.0)


@pytest.mark.parametrize(
    "columns",
    [
        {},
        {"brake": np.full(len(TIME), 0.3), "speed": np.full(len(TIME), 5.0)},  # brakes from the start
        {"brake": np.where(TIME > 5.0, 0.3, 0.0)},  # stands
        {"steering": np.where(TIME < 8.0, 0.0, 0.1), "speed": 8.0, "chassis_wz": 0.2},  # stays too short
        {"steering": np.where(TIME < 1.0, 0.0, 0.1), "speed": 8.0, "chassis_wz": 1e-4},  # goes straight
    ],
)
def test_other_inputs_bring_nothing(columns) -> None:
    assert marks_of_inputs(driven(**columns)) == []


def test_pilots_declare_their_ground_marks() -> None:
    circle = CircleFollower(30.0, 10.0, 2.5, 0.5)
    pilot = Braking(FixedSteering(circle, 1.0, 0.5), lambda time, observation: time > 2.0, 0.5, 0.1)
    assert pilot.marks == []
    observation = {"chassis.x": 1.0, "chassis.y": 2.0, "chassis.yaw": 0.5 * math.pi, "sideslip": 0.0, "speed": 10.0}
    pilot.act(0.0, observation)
    assert pilot.marks[0]["centre"] == pytest.approx([-29.0, 2.0])
    pilot.act(2.5, observation | {"chassis.x": 5.0})
    _, line = pilot.marks
    assert np.array(line["points"]) == pytest.approx(np.array([[3.0, 2.0], [7.0, 2.0]]))


def test_cones_stand_along_the_course_as_it_was_laid_out() -> None:
    course = course_of("iso_3888_1", 1.6)
    steering = CourseFollower(course, DriverSettings(15.0, 2.5, 0.5, 4.0, 1.6))
    pilot = RunUpPilot(steering, 15.0, lambda time, observation: time > 1.0)
    observation = {"chassis.x": 100.0, "chassis.y": 7.0, "chassis.yaw": 0.5 * math.pi, "speed": 15.0}
    pilot.act(0.0, observation)
    assert pilot.marks == []
    pilot.act(1.5, observation)
    places = scenery_of(pilot.marks)
    assert len(places) == 34
    first = course.gates[0]
    assert places[0]["at"] == pytest.approx([100.0 - first.y_right, 7.0 + first.x_start])


def test_marks_lie_on_the_road() -> None:
    marks = [
        {"kind": "circle", "centre": [2.0, 1.0], "radius": 100.0},
        {"kind": "line", "points": [[0.0, 1.0], [0.0, -1.0]], "colour": "yellow"},
        lanes([astuple(gate) for gate in course_of("iso_3888_2", 1.6).gates], (0.0, 0.0, 0.0)),
    ]
    circle, line, *upright = with_marks({"roads": [PLANE]}, marks, "marks")["scenery"]
    assert {thing["kind"] for thing in upright} == {"cone"}
    points = np.array([*circle["points"], *line["points"], *(thing["at"] for thing in upright)])
    assert points[:, 2] == pytest.approx(0.5 + 0.1 * (points[:, 0] - 1.0) - 0.2 * points[:, 1], abs=1e-12)
    round_ = np.array(circle["points"])
    assert np.hypot(round_[:, 0] - 2.0, round_[:, 1] - 1.0) == pytest.approx(100.0)
    assert round_[0] == pytest.approx(round_[-1])
    assert np.linalg.norm(np.diff(round_[:, :2], axis=0), axis=1).max() < 1.01


def test_marks_lie_on_a_grid_of_heights_or_are_named() -> None:
    """On a plane that a grid with other steps along x than along y has; far beyond its border there are none."""
    x, y = np.meshgrid(np.arange(-1.0, 4.1, 1.0), np.arange(-2.0, 2.1, 0.5), indexing="ij")
    road = {"kind": "grid", "origin": [-1.0, -2.0], "spacing": [1.0, 0.5], "shape": [*x.shape]}
    road |= {"heights": encoded(0.5 + 0.25 * x - 0.125 * y)}
    line = {"kind": "line", "points": [[-1.0, 2.0], [0.3, 0.7], [3.5, -1.9]], "colour": "white"}
    points = np.array(with_marks({"roads": [road]}, [line], "marks")["scenery"][0]["points"])
    assert points[:, 2] == pytest.approx(0.5 + 0.25 * points[:, 0] - 0.125 * points[:, 1], abs=1e-6)
    far = with_marks({"roads": [road]}, [line | {"points": [[0.0, 0.0], [34.5, -1.9]]}], "marks")
    assert "scenery" not in far
    assert [missed["name"] for missed in far["missing"]] == ["marks"]


@pytest.mark.parametrize(
    "marks",
    [
        [{"kind": "circle", "centre": [1.0], "radius": 3.0}],
        [{"kind": "circle", "centre": [1.0, 2.0], "radius": math.inf}],
        [{"kind": "tower", "at": [0.0, 0.0]}],
        [3],
    ],
)
def test_a_record_with_invalid_marks_is_refused(marks) -> None:
    with pytest.raises(HostError, match="does not say by 'marks' lanes, lines and circles"):
        with_recorded_marks({"roads": []}, {"marks": marks}, Path("run.json"))
