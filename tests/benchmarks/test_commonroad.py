"""Cars by CommonRoad's parameters against that project's own multi-body model, whose runs are stored."""

import pytest

from benchmarks.validation.commonroad import compare
from benchmarks.validation.commonroad_reference import CARS
from tests.quick import quick

NAMES = quick(["commonroad_vanagon"], sorted(CARS))


@pytest.mark.parametrize("name", NAMES)
def test_it_turns_as_that_model_does_once_that_is_consistent(name: str) -> None:
    """Yaw rate after 3 s, way to the side; roll and loads within what the page says of that model's axles."""
    both = compare(name, "consistent_step_steer")
    assert both.simulated["yaw_rate"][-1] == pytest.approx(both.reference["yaw_rate"][-1], rel=0.004)
    assert both.simulated["y"][-1] == pytest.approx(both.reference["y"][-1], rel=0.01)
    assert both.simulated["roll"][-1] == pytest.approx(both.reference["roll"][-1], rel=0.08)


@pytest.mark.parametrize("name", NAMES)
def test_it_brakes_as_that_model_does(name: str) -> None:
    both = compare(name, "braking")
    for quantity, within in (("vx", 0.002), ("x", 0.001), ("Fz_FL", 0.01), ("Fz_RL", 0.02), ("pitch", 0.08)):
        assert both.simulated[quantity][-1] == pytest.approx(both.reference[quantity][-1], rel=within), quantity


def test_as_published_two_of_them_turn_otherwise() -> None:
    """More and less than here: their wheels push against their lean."""
    more, less = (compare(name, "step_steer") for name in ("commonroad_escort", "commonroad_320i"))
    assert more.simulated["yaw_rate"][-1] > 1.05 * more.reference["yaw_rate"][-1]
    assert less.simulated["yaw_rate"][-1] < 0.97 * less.reference["yaw_rate"][-1]
