"""A start with slip: rates of carcasses are there at once, so that what follows is of the order of the method."""

import numpy as np
import pytest

import mbs
from mbs.vehicle import Car, load
from tests.vehicle.test_tyre_by_file import folder_with

SHORT = 1e-9  # s: over such a step deflections keep their values and rates become those that belong to them
START = {"steering": -0.29}, mbs.Pose(speed=17.5)


@pytest.fixture(params=["TMeasy", "TMeasy with bore torque", "Magic Formula"])
def car(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Car:
    """One whose front wheels are steered."""
    if request.param == "Magic Formula":
        return load(folder_with(tmp_path_factory.mktemp("cars") / "car"))
    return load("saloon" if "bore" in request.param else "hatchback")


def test_slots_at_a_start_are_those_of_a_short_step(car: Car) -> None:
    inputs, pose = START
    simulation = mbs.Simulation(mbs.compile(car.model()), inputs=inputs, pose=pose)
    s = simulation.state
    after = np.array(simulation.instance.element_step(s.q.tolist(), s.qd.tolist(), s.y.tolist(), SHORT)[0])
    assert np.abs(s.y).max() > 0.1  # m/s
    np.testing.assert_allclose(s.y, after, rtol=1e-5, atol=1e-6)


def test_a_car_that_starts_with_steered_wheels_is_off_by_order_two() -> None:
    """Its way to the side was off by 1.6e-4 m at 2.5 ms, of order one."""
    inputs, pose = START
    system = mbs.compile(load("hatchback").model())
    ways = [
        mbs.simulate(system, 0.06, h, inputs, pose=pose, progress=False, estimate_error=False)["chassis.y"][-1]
        for h in (5e-3, 2.5e-3, 1.25e-3, 3.125e-4)
    ]
    off = np.abs(np.array(ways[:3]) - ways[3])
    assert off[1] < 1e-6
    assert off[0] / off[1] > 2.5
