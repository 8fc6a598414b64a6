"""A steering whose ratio varies: from the file by drawing, kinematics, run and torque, and what is refused."""

import math

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.interpolate import PchipInterpolator

from mbs import Simulation, compile
from mbs.vehicle import load
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.kinematics import kinematics
from mbs.vehicle.steering.rack_by_angle import RackByAngle

CAR = load("prototype")
KEY = "steering.rack_by_wheel_angle"
ROWS = [[0.0, 0.0], [60.0, 6.0], [150.0, 18.0], [300.0, 42.0], [420.0, 66.0]]
SIDE = np.array(ROWS) * (math.pi / 180.0, 1e-3)
CURVE = PchipInterpolator(*np.concatenate([-SIDE[:0:-1], SIDE]).T)
PER_TURN = 2.0 * math.pi * float(CURVE(0.0, 1))
TABLED = CAR.changed({KEY: ROWS, "steering.rack_per_turn": PER_TURN})
TURN = {"throttle": 0.3, "steering": lambda t: 0.6 * math.sin(2.0 * t)}


def run(car, inputs=TURN, parameters=None):
    simulation = Simulation(compile(car.model()), parameters=parameters or {})
    return simulation.run(1.5, 0.005, inputs=inputs, estimate_error=False)


@pytest.fixture(scope="module")
def tabled():
    return run(TABLED)


def test_the_file_gives_full_lock_by_the_table():
    largest = TABLED.steering.wheel_angle_max
    assert float(CURVE(largest)) == pytest.approx(CAR.steering.rack_travel, abs=1e-15)
    assert largest < 0.8 * CAR.steering.wheel_angle_max
    model = TABLED.model()
    assert {c.name: c.value for c in model.constants}["vehicle.steering_wheel_angle_max"] == largest


@pytest.mark.slow
def test_a_straight_table_is_the_constant_ratio():
    straight = [[k * 60.0, k * 42.0 / 6.0] for k in range(11)]
    car = CAR.changed({KEY: straight})
    assert car.steering.wheel_angle_max == pytest.approx(CAR.steering.wheel_angle_max, rel=1e-14)
    a, b = run(car), run(CAR)
    for name in ("chassis.y", "steering_rack", "steering_wheel_angle", "steering_wheel_speed", "wheel_FL.steer"):
        np.testing.assert_allclose(a[name], b[name], rtol=0, atol=1e-12 * max(1.0, np.ptp(b[name])), err_msg=name)


@pytest.mark.slow
def test_kinematics_has_the_angle_and_the_ratio_of_the_table():
    c = kinematics(TABLED, points=9).curves["front", "steer"].columns
    angle, rack = c["steering_wheel_angle"], CAR.rack_direction * c["rack_travel"]
    np.testing.assert_allclose(CURVE(angle), rack, rtol=0, atol=1e-14)
    usual = kinematics(CAR, points=9).curves["front", "steer"].columns
    constant = CAR.steering.rack_per_turn / (2.0 * math.pi)
    np.testing.assert_allclose(
        c["steering_ratio"] * CURVE(angle, 1), usual["steering_ratio"] * constant, rtol=1e-12, atol=0
    )
    assert c["steering_ratio"][0] < 0.7 * c["steering_ratio"][4]


def test_a_run_moves_the_rack_by_the_table(tabled):
    angle, rack = tabled["steering_wheel_angle"], CAR.rack_direction * tabled["steering_rack"]
    assert np.ptp(angle) > 4.0
    np.testing.assert_allclose(rack, CURVE(angle), rtol=0, atol=1e-14)


def test_power_of_the_hands_is_power_of_the_rack(tabled):
    speed = CAR.rack_direction * CURVE(tabled["steering_wheel_angle"], 1) * tabled["steering_wheel_speed"]
    hands, rack = (
        tabled["steering_wheel_torque"] * tabled["steering_wheel_speed"],
        -tabled["steering_rack_force"] * speed,
    )
    assert np.ptp(hands) > 1.0
    np.testing.assert_allclose(hands, rack, rtol=0, atol=1e-9 * np.ptp(hands))


def test_full_lock_is_that_of_the_rack():
    t = run(TABLED, {"steering": 0.9, "steering_wheel_angle_demand": 3.0})
    largest = TABLED.steering.wheel_angle_max
    assert t["steering_wheel_angle"][-1] == pytest.approx(largest, abs=1e-6)
    assert CAR.rack_direction * t["steering_rack"][-1] == pytest.approx(CAR.steering.rack_travel, abs=1e-7)
    assert t["steering_demand_excess"][-1] == pytest.approx(3.0 - 0.1 * largest, abs=1e-9)
    assert any("beyond full lock" in text for text in t.notices)


@pytest.mark.slow
def test_the_travel_per_turn_stretches_the_table():
    """As a parameter it gives what a file with it gives; the file then says by how much."""
    name, value = "steering.rack_per_turn", 1.1 * PER_TURN
    written, built = run(TABLED, parameters={name: value}), run(TABLED.changed({name: value}))
    for sensor in ("steering_rack", "steering_wheel_angle", "steering_wheel_torque", "chassis.y"):
        np.testing.assert_allclose(
            written[sensor], built[sensor], rtol=0, atol=1e-9 * np.ptp(built[sensor]), err_msg=sensor
        )
    angle = built["steering_wheel_angle"]
    np.testing.assert_allclose(CAR.rack_direction * built["steering_rack"], CURVE(1.1 * angle), rtol=0, atol=1e-14)
    assert not [*TABLED.steering.oddities()]
    (sentence,) = TABLED.changed({name: value}).steering.oddities()
    assert f"{PER_TURN:.6g} m of rack travel per turn" in sentence
    assert "divided by 1.1." in sentence


def test_an_axle_by_tables_has_it_too():
    t = Simulation(compile(TABLED.model(fidelity="table"))).run(0.5, 0.005, inputs=TURN, estimate_error=False)
    assert np.ptp(t["steering_wheel_angle"]) > 2.0
    rack = CAR.rack_direction * t["steering_rack"]
    np.testing.assert_allclose(rack, CURVE(t["steering_wheel_angle"]), rtol=0, atol=1e-14)
    power = t["steering_wheel_torque"] * t["steering_wheel_speed"]
    slope = CAR.rack_direction * CURVE(t["steering_wheel_angle"], 1)
    np.testing.assert_allclose(
        power, -t["steering_rack_force"] * slope * t["steering_wheel_speed"], rtol=0, atol=1e-9 * np.ptp(power)
    )


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([[0.0, 0.0]], "has 1 rows; it must have two or more"),
        ([[0.0, 1.0], [420.0, 66.0]], "is [0.0, 1.0]; the first row must be [0, 0]"),
        ([[0.0, 0.0], [200.0, 40.0], [420.0, 30.0]], "2 is [420.0, 30.0] after [200.0, 40.0]; both columns must rise"),
        ([[0.0, 0.0], [200.0, 40.0], [200.0, 70.0]], "both columns must rise"),
        (
            [[0.0, 0.0], [420.0, 59.0]],
            "ends at 59 mm of rack travel, 420 deg; it must reach to steering.rack_travel, 60",
        ),
        ([[0.0, 0.0], [420.0, math.nan]], "steering.rack_by_wheel_angle.1.1"),
        ([[0.0, 0.0], [420.0, 0.066, 1.0]], "steering.rack_by_wheel_angle.1"),
    ],
)
def test_an_invalid_table_is_reported(rows, message):
    with pytest.raises(CarFileError) as refusal:
        CAR.changed({KEY: rows})
    assert message in str(refusal.value)


def test_the_travel_per_turn_may_be_left_out():
    requested = {**CAR.steering.model_dump(exclude={"rack_per_turn"}), "rack_by_wheel_angle": ROWS}
    assert RackByAngle.model_validate(requested).rack_per_turn == pytest.approx(PER_TURN, rel=1e-14)
    for rows in ([[0.0, 0.0]], [[0.0, 0.0], [0.0, 6.0]], [[0.0, 0.0], [60.0, "6"]], [[0.0, 0.0], [60.0]], 7):
        with pytest.raises(ValidationError, match="rack_per_turn"):
            RackByAngle.model_validate(requested | {"rack_by_wheel_angle": rows})


def test_a_port_that_asks_for_the_rack_has_no_table():
    with pytest.raises(CarFileError, match="ports.steering asks for the travel of the rack itself"):
        TABLED.changed({"ports": {"steering": "rack_position"}})
