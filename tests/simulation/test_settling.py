"""`Simulation.settle`: a start in motion is held while the rest settles."""

from __future__ import annotations

import math

import pytest

import mbs
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.results.simulation_error import SimulationError
from mbs.scenes import double_four_bar

H = 0.005
POSE = mbs.Pose(speed=15.0, lateral_speed=0.2, yaw_rate=0.4)


@pytest.fixture(scope="module")
def car() -> mbs.System:
    return mbs.compile(mbs.vehicle.load("prototype").model())


def test_it_is_that_of_the_kernel(car: mbs.System) -> None:
    run = mbs.Simulation(car, pose=POSE, inputs={"steering": 0.1})
    drawn = run.sensors["chassis.roll"]
    left = run.settle(1.0, H)
    instance = Instance(LoadedSystem(car.to_bytes()))
    instance.set_input([entry["name"] for entry in car.meta["inputs"]].index("steering"), 0.1)
    instance.set_pose(0.0, 0.0, 0.0, 0.0, 15.0, 0.2, 0.4)
    instance.initialise(0.0)
    assert instance.settle(1.0, H) == left
    assert list(run.instance.sensors()) == list(instance.sensors())
    assert run.time == 0.0
    assert abs(run.sensors["chassis.roll"]) > 100.0 * abs(drawn)


@pytest.mark.parametrize(
    ("duration", "h", "said"),
    [
        (-1.0, H, "between 0 and 10 s"),
        (11.0, H, "between 0 and 10 s"),
        (math.nan, H, "duration of settling"),
        ("long", H, "duration of settling"),
        (1.0, 0.0, "must be positive and finite"),
    ],
)
def test_what_it_refuses(car: mbs.System, duration: float, h: float, said: str) -> None:
    run = mbs.Simulation(car, pose=POSE)
    before = run.save()
    with pytest.raises(ValueError, match=said):
        run.settle(duration, h)
    assert run.save() == before


def test_what_is_left_is_told(car: mbs.System) -> None:
    """The speed of the motion beside the held one, which dies away: roll of 1 rad/s leaves centimetres a second."""
    left = []
    for duration in (0.1, 1.0, 3.0):
        run = mbs.Simulation(car, pose=POSE, inputs={"steering": 0.1})
        left.append(run.settle(duration, H))
    assert left[0] > 0.1
    assert left[0] > 5.0 * left[1] > 25.0 * left[2]
    rolled = run.sensors["chassis.roll"]
    run.settle(H, H)
    # A vector of the chassis is longer than a metre: its end moves by more than the roll.
    assert abs(run.sensors["chassis.roll"] - rolled) / H < left[2]


def test_the_clock_goes_on_where_it_was(car: mbs.System) -> None:
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
