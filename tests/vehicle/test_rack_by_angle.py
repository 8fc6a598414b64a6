"""Steering by an angle: both inputs, the torque of the hands; friction of every steering without compliance."""

import math

import numpy as np
import pytest

from mbs import Simulation, compile
from mbs.vehicle import load
from tests.vehicle.test_pitman_arm import TRAPEZOID
from tests.vehicle.test_rack_table import TABLED

CAR = load("prototype")
PER_RADIAN = -CAR.steering.rack_per_turn / (
    2.0 * math.pi
)  # m to the left per rad to the left: tie rods behind the axle
TURN = {"throttle": lambda t: 0.5 * (t < 2.0) + 0.15, "steering": lambda t: 0.2 * min(1.0, max(0.0, t - 2.0))}


@pytest.fixture(scope="module")
def car():
    m = CAR.model()
    for w, y in (("FL", 1.0), ("FR", -1.0)):
        m.sense_joint(f"tension {w}", f"tie rod {w}", "tension")
        upright = next(b for b in m.bodies if b.name == f"upright {w}")
        outer = np.array(CAR.front.suspension.points.tie_rod_outer) * (1.0, y, 1.0)
        chassis = next(b for b in m.bodies if b.name == "chassis")
        inner = np.array(CAR.front.suspension.points.tie_rod_inner) * (1.0, y, 1.0)
        gap = upright.point(outer) - chassis.point(inner)
        m.sense_vector(f"across {w}", gap, [chassis.vector((0.0, 1.0, 0.0))])
    return compile(m)


def test_an_angle_in_rad_steers_as_its_share_of_full_lock_does(car):
    largest = CAR.steering.wheel_angle_max
    one, two, both = (Simulation(car) for _ in range(3))
    a = one.run(3.0, 0.005, inputs=TURN)
    b = two.run(
        3.0,
        0.005,
        inputs=TURN | {"steering": 0.0, "steering_wheel_angle_demand": lambda t: largest * TURN["steering"](t)},
    )
    c = both.run(3.0, 0.005, inputs=TURN | {"steering_wheel_angle_demand": 0.5})
    for name in ("chassis.y", "chassis.wz", "steering_wheel_torque", "wheel_FL.steer"):
        np.testing.assert_allclose(b[name], a[name], rtol=0, atol=1e-9 * np.ptp(a[name]))
    assert c["steering_wheel_angle"][-1] == pytest.approx(a["steering_wheel_angle"][-1] + 0.5, rel=1e-6)


def test_the_torque_of_the_hands_is_that_of_the_tie_rods_times_the_travel_per_radian(car):
    t = Simulation(car).run(5.0, 0.005, inputs=TURN)
    force = np.zeros_like(t.t)
    for w in ("FL", "FR"):
        length = np.linalg.norm(
            np.array(CAR.front.suspension.points.tie_rod_outer) - CAR.front.suspension.points.tie_rod_inner
        )
        # tension pulls the end of the rack towards the upright
        force += t[f"tension {w}"] * (t[f"across {w}"] - t["steering_rack"]) / length
    np.testing.assert_allclose(t["steering_rack_force"], force, rtol=0, atol=1e-9 * np.max(np.abs(force)))
    np.testing.assert_allclose(
        t["steering_wheel_torque"], -force * PER_RADIAN, rtol=0, atol=1e-9 * np.max(np.abs(force))
    )
    assert t["chassis.ay"][-1] > 2.0  # to the left, and the wheels want to go straight on
    assert 0.5 < t["steering_wheel_torque"][-1] < 10.0


def test_beyond_full_lock_the_angle_is_limited_and_reported(car):
    simulation = Simulation(car)
    t = simulation.run(1.0, 0.01, inputs={"steering": 0.9, "steering_wheel_angle_demand": 2.0}, estimate_error=False)
    largest = CAR.steering.wheel_angle_max
    assert t["steering_wheel_angle"][-1] == pytest.approx(largest, abs=1e-6)
    assert t["steering_demand_excess"][-1] == pytest.approx(0.9 * largest + 2.0 - largest, abs=1e-9)
    assert any("beyond full lock" in text for text in t.notices)
    assert not Simulation(car).run(0.1, 0.01, inputs={"steering": 1.0}, estimate_error=False).notices


@pytest.mark.slow
@pytest.mark.parametrize("car", [CAR, TABLED, TRAPEZOID], ids=["rack", "table", "pitman_arm"])
def test_friction_is_the_additional_torque_of_the_hands(car):
    """At a constant rate of the wheel the torque is larger by the friction; the car does not notice."""
    inputs = {"steering_wheel_angle_demand": lambda t: 0.4 * t}
    smooth, rough = (
        Simulation(compile(c.model())).run(1.5, 0.01, inputs=inputs)
        for c in (car, car.changed({"steering.friction": 0.8}))
    )
    difference = rough["steering_wheel_torque"] - smooth["steering_wheel_torque"]
    np.testing.assert_allclose(difference[50:], 0.8, rtol=0, atol=1e-3)
    np.testing.assert_allclose(rough["chassis.y"], smooth["chassis.y"], rtol=0, atol=1e-9)
