"""`Simulation.settle`: a start in motion is held while the rest settles."""

import math

import numpy as np
import pytest

import mbs
from mbs.elements import KerbRoad, PlaneRoad
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.results.simulation_error import SimulationError
from mbs.scenes import double_four_bar
from mbs.vehicle import car_names, load
from tests.quick import quick

H = 0.005  # s
G = 9.81  # m/s2
POSE = mbs.Pose(speed=15.0, lateral_speed=0.2, yaw_rate=0.4)


@pytest.fixture(scope="module")
def car() -> mbs.System:
    return mbs.compile(mbs.vehicle.load("prototype").model())


def test_it_is_that_of_the_kernel(car: mbs.System) -> None:
    run = mbs.Simulation(car, pose=POSE, inputs={"steering": 0.1})
    drawn = run.sensors["chassis.roll"]
    speed = run.settle(1.0, H)
    instance = Instance(LoadedSystem(car.to_bytes()))
    instance.set_input([entry["name"] for entry in car.meta["inputs"]].index("steering"), 0.1)
    instance.set_pose(0.0, 0.0, 0.0, 0.0, 15.0, 0.2, 0.4)
    instance.initialise(0.0)
    assert instance.settle(1.0, H) == speed
    assert list(run.instance.sensors()) == list(instance.sensors())
    assert run.time == 0.0
    assert abs(run.sensors["chassis.roll"]) > 100.0 * abs(drawn)


@pytest.mark.parametrize(
    ("duration", "h", "message"),
    [
        (-1.0, H, "between 0 and 10 s"),
        (11.0, H, "between 0 and 10 s"),
        (math.nan, H, "duration of settling"),
        ("long", H, "duration of settling"),
        (1.0, 0.0, "must be positive and finite"),
    ],
)
def test_invalid_values_are_refused(car: mbs.System, duration: float, h: float, message: str) -> None:
    run = mbs.Simulation(car, pose=POSE)
    before = run.save()
    with pytest.raises(ValueError, match=message):
        run.settle(duration, h)
    assert run.save() == before


def test_the_remaining_speed_after_settling_is_reported(car: mbs.System) -> None:
    """The speed of the motion beside the held one, which dies away: roll of 1 rad/s leaves centimetres a second."""
    speeds = []
    for duration in (0.1, 1.0, 3.0):
        run = mbs.Simulation(car, pose=POSE, inputs={"steering": 0.1})
        speeds.append(run.settle(duration, H))
    assert speeds[0] > 0.1
    assert speeds[0] > 5.0 * speeds[1] > 25.0 * speeds[2]
    rolled = run.sensors["chassis.roll"]
    run.settle(H, H)
    # A vector of the chassis is longer than a metre: its end moves by more than the roll.
    assert abs(run.sensors["chassis.roll"] - rolled) / H < speeds[2]


def test_the_clock_continues_after_settling(car: mbs.System) -> None:
    run = mbs.Simulation(car, pose=POSE)
    run.step(H, 100)
    run.settle(1.0, H)
    assert run.time == pytest.approx(0.5, abs=1e-12)
    run.step(H, 100)
    assert run.time == pytest.approx(1.0, abs=1e-12)


def test_a_scene_that_is_tied_to_the_ground_cannot() -> None:
    run = mbs.Simulation(mbs.compile(double_four_bar.build()))
    with pytest.raises(ValueError, match="tie it to the ground"):
        run.settle(1.0, H)


def test_after_a_step_that_fails_the_state_is_the_one_before(car: mbs.System) -> None:
    run = mbs.Simulation(car, pose=POSE, settings=mbs.Settings(max_iterations=1, max_halvings=0))
    before = run.save()
    with pytest.raises(SimulationError, match="did not settle"):
        run.settle(1.0, 0.5)
    assert run.save() == before
    run.step(1e-4)


def in_balance(name, road, duration, brake=0.0, **pose):
    """A car that settles on a road: the loads of its wheels then, after 10 ms and after a second, N, shape (3, 4), how
    far it has moved along x, m, and the speed that settling left, m/s."""
    system = mbs.compile(load(name).model(road))
    known = {entry["name"] for entry in system.meta["inputs"]}
    inputs = {name: value for name, value in {"brake": brake, "selector": 0.0}.items() if name in known}
    run = mbs.Simulation(system, inputs=inputs, pose=mbs.Pose(z=1.7, **pose))
    speed = run.settle(duration, H)
    loads, before = [], run.sensors["chassis.x"]
    for steps in (0, 2, 198):
        if steps:
            run.step(H, steps)
        loads.append([run.sensors[f"wheel_{w}.Fz"] for w in ("FL", "FR", "RL", "RR")])
    return np.array(loads), run.sensors["chassis.x"] - before, speed


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("prototype",), car_names(), "proof"))
def test_on_a_slope_it_begins_in_balance(name):
    """Parked along and across slopes the loads stay for a second; let go or driven it begins without a jump of them;
    in all of these the wheels carry the part of the weight across the road."""
    weight = in_balance(name, PlaneRoad(), 5.0, brake=1.0)[0][0].sum()
    for grade in ("grade_x", "grade_y"):
        slope = math.radians(10.0)
        road, across = PlaneRoad(**{grade: math.tan(slope)}, friction=1.0), weight * math.cos(slope)
        loads, moved, final_speed = in_balance(name, road, 5.0, brake=1.0)
        assert loads.sum(axis=1) == pytest.approx(across, rel=1e-3), grade
        assert np.abs(loads - loads[0]).max() < 1e-3 * weight, grade
        assert abs(moved) < 2e-3, grade
        assert final_speed < 1e-4, grade
        road, across = PlaneRoad(**{grade: math.tan(0.15)}, friction=1.0), weight * math.cos(0.15)
        for speed in (0.0, 15.0):
            loads, moved, _ = in_balance(name, road, 5.0, speed=speed)
            assert loads[0].sum() == pytest.approx(across, rel=2e-3), (grade, speed)
            assert np.abs(loads[1] - loads[0]).max() < 1e-4 * weight, (grade, speed)
            if (grade, speed) == ("grade_x", 0.0):  # wheels and gears turn with it
                assert -0.5 * G * math.sin(0.15) * math.cos(0.15) < moved < -0.35 * G * math.sin(0.15), speed


@pytest.mark.slow
def test_with_its_front_on_a_kerb_it_begins_in_balance():
    road = KerbRoad(-1.3, 0.1, upper="after")
    loads, moved, speed = in_balance("prototype", road, 5.0, brake=1.0)
    assert np.abs(loads - loads[0]).max() < 0.1
    assert abs(moved) < 1e-6
    assert speed < 1e-5
    assert loads[0].sum() == pytest.approx(in_balance("prototype", PlaneRoad(), 5.0, brake=1.0)[0][0].sum(), rel=1e-3)
