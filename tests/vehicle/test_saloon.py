"""The saloon has the masses, rates and roll stiffness of the measured car that its file names, and drives straight."""

import pytest

from mbs import compile, simulate
from mbs.vehicle import load
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.kinematics import kinematics
from mbs.vehicle.kinematics.curves import Curve

# of the sprung mass, with half of the tracks, of the measured car
MASS = 1093.3  # kg
AHEAD = 1.1717  # m
BEHIND = 2.5789 - 1.1717  # m
WHEEL_RATE = {"front": 24453.0, "rear": 19635.0}
DAMPING = {"front": 1786.0, "rear": 1649.0}
MORE_ROLL_STIFFNESS = {"front": 6915.0, "rear": 2644.0}


@pytest.fixture(scope="module")
def car():
    return load("saloon")


@pytest.fixture(scope="module")
def curves(car):
    return kinematics(car, (-0.02, 0.02), 5)


def _drawn(curve: Curve, name: str) -> float:
    return curve.drawn()[name]


def test_its_weight_is_on_the_axles_as_measured(car):
    rest = simulate(compile(car.model()), 0.05, 0.005, progress=False, estimate_error=False)
    for wheel, arm in (("FL", BEHIND), ("FR", BEHIND), ("RL", AHEAD), ("RR", AHEAD)):
        expected = 0.5 * MASS * GRAVITY * arm / (AHEAD + BEHIND)
        assert rest[f"wheel_{wheel}.Fz"][0] == pytest.approx(expected, rel=1e-3)
        assert abs(rest[f"wheel_{wheel}.travel"][0]) < 1e-5


@pytest.mark.parametrize("axle", ["front", "rear"])
def test_springs_bars_and_dampers_have_the_rates_of_the_measured_car(car, curves, axle):
    parallel, opposite = curves.curves[axle, "parallel"], curves.curves[axle, "opposite"]
    assert _drawn(parallel, "wheel_rate_left") == pytest.approx(WHEEL_RATE[axle], rel=2e-3)
    more = _drawn(opposite, "wheel_rate_left") - _drawn(parallel, "wheel_rate_left")
    assert 0.5 * more * getattr(car, axle).track ** 2 == pytest.approx(MORE_ROLL_STIFFNESS[axle], rel=0.02)
    ratio = _drawn(parallel, "damper_ratio_left")
    ratio = min(ratio, 1.0 / ratio)  # of damper over wheel
    assert getattr(car, axle).damper.damping * ratio**2 == pytest.approx(DAMPING[axle], rel=0.01)


def test_its_wheels_lean_over_travel_as_measured(curves):
    assert curves.drawn("front")["camber_gradient"] == pytest.approx(-0.394, abs=0.07)
    assert curves.drawn("rear")["camber_gradient"] == pytest.approx(-0.906, abs=0.01)
