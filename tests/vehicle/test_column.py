"""Steering with a column: by angle and by torque, wind-up, friction, assistance, ends of the rack, self-centring."""

import math
from functools import cache

import numpy as np
import pytest

from mbs import Pose, Simulation, System, compile
from mbs.common.errors import ModelError
from mbs.shapes.pose_outputs import pose_outputs
from mbs.vehicle import Car, Fidelity, load
from mbs.vehicle.errors import CarFileError
from tests.vehicle.rigid_car import COLUMN, column_car

SMOOTH = {"friction": 0.0, "rack_friction": 0.0}
H = 0.005
LEFT = {"throttle": 0.12, "steering": lambda t: 0.08 * min(1.0, max(0.0, t - 1.0)) ** 2}


def car(**changes: object) -> Car:
    return column_car(**changes)


@cache
def system(*changes: tuple[str, float]) -> System:
    return compile(car(**dict(changes)).model())


def run(of: System, end: float, h: float = H, by_torque: int = 0, **inputs: object):
    simulation = Simulation(of, pose=Pose(speed=15.0), parameters={"steering.by_torque": by_torque})
    return simulation.run(end, h, inputs=inputs)


PER_RADIAN = -car().steering.rack_per_turn / (2.0 * math.pi)  # m to the left per rad to the left


def pinion_torque(t) -> float:
    """By virtual work with the tie rods, and with the rack's own weight and acceleration across the car."""
    across = t["chassis.ay"][-1] + 9.81 * math.sin(t["chassis.roll"][-1])
    return (COLUMN["rack_mass"] * across - t["steering_rack_force"][-1]) * PER_RADIAN


def test_in_a_steady_turn_the_hands_hold_the_tie_rods_by_the_ratio_and_the_column_winds_up():
    t = run(system(*SMOOTH.items()), 8.0, **LEFT)
    hands, bar = t["steering_wheel_torque"][-1], t["steering_column_torque"][-1]
    assert hands == pytest.approx(pinion_torque(t), rel=1e-3)
    assert bar == pytest.approx(hands, rel=1e-3)
    wind_up = t["steering_wheel_angle"][-1] - t["steering_rack"][-1] / PER_RADIAN
    assert wind_up == pytest.approx(bar / COLUMN["stiffness"], rel=1e-3)
    assert wind_up > 0.01
    assert t["chassis.ay"][-1] > 2.0  # to the left by a torque to the left
    assert 1.0 < hands < 6.0


def test_the_assistance_takes_its_share_of_the_tie_rods():
    changes = {**SMOOTH, "assistance": 4.0, "assistance_limit": 30.0}
    t = run(system(*changes.items()), 8.0, **LEFT)
    bar, assistance = t["steering_column_torque"][-1], t["steering_assistance"][-1]
    assert assistance == pytest.approx(4.0 * bar / math.hypot(1.0, 4.0 * bar / 30.0), rel=1e-9)
    assert bar + assistance == pytest.approx(pinion_torque(t), rel=1e-3)
    assert t["steering_wheel_torque"][-1] == pytest.approx(bar, rel=1e-3)


def test_friction_is_overcome_on_the_way_and_not_on_the_way_back():
    """A slow turn of the wheel there and back: the torque differs by twice the friction at one angle."""
    there_and_back = {
        "throttle": 0.12,
        "steering_wheel_angle_demand": lambda t: 0.5 * (1.0 - math.cos(math.pi * t / 4.0)),
    }
    smooth = run(system(*SMOOTH.items()), 8.0, **there_and_back)
    rough = run(system(), 8.0, **there_and_back)
    difference = rough["steering_wheel_torque"] - smooth["steering_wheel_torque"]
    expected = COLUMN["friction"] + COLUMN["rack_friction"] * abs(PER_RADIAN)
    half = int(2.0 / H), int(6.0 / H)
    assert difference[half[0]] - difference[half[1]] == pytest.approx(2.0 * expected, rel=0.05)


@pytest.mark.slow
def test_stiffer_columns_approach_the_rigid_rack():
    light = {**SMOOTH, "rack_mass": 0.2, "damping": 0.0}
    rigid = Simulation(compile(load("prototype").model()), pose=Pose(speed=15.0)).run(4.0, H, inputs=LEFT)
    gaps = []
    for stiffness in (800.0, 3200.0, 12800.0):
        t = run(system(*{**light, "stiffness": stiffness}.items()), 4.0, **LEFT)
        gaps.append(abs(t["steering_rack"][-1] - rigid["steering_rack"][-1]))
    ratios = np.array(gaps[:-1]) / gaps[1:]
    np.testing.assert_allclose(ratios, 4.0, rtol=0.06)
    assert gaps[-1] < 3e-6  # m


def test_the_recorded_torque_gives_the_angle_again_to_second_order():
    gaps = []
    for h in (0.005, 0.0025):
        guided = run(system(), 4.0, h, **LEFT)
        torque = guided.t, guided["steering_wheel_torque"]
        turned = run(system(), 4.0, h, 1, throttle=0.12, steering_torque=torque)
        np.testing.assert_allclose(turned["steering_wheel_torque"], torque[1], atol=1e-6)
        gaps.append(np.max(np.abs(turned["steering_wheel_angle"] - guided["steering_wheel_angle"])))
    assert gaps[0] < 2e-3  # rad, of 0.7
    assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.15)


def test_without_hands_the_car_centres_its_steering_and_goes_straight_on():
    guided = run(system(), 4.0, **LEFT)
    torque = (np.append(guided.t, 4.0 + 1e-9), np.append(guided["steering_wheel_torque"], 0.0))
    t = run(system(), 9.0, by_torque=1, throttle=0.12, steering_torque=torque)
    angle, release = t["steering_wheel_angle"], int(4.0 / H)
    assert angle[release] > 0.7
    back = t.t[release:][np.argmax(np.abs(angle[release:]) < 0.1 * angle[release])] - 4.0
    assert 0.2 < back < 1.5
    late = angle[release + int(2.0 / H) :]
    assert np.max(np.abs(late)) < 0.1  # what friction leaves
    assert np.ptp(late) < 1e-3  # and it does not swing
    assert abs(t["chassis.wz"][-1]) < 0.05


def test_a_standing_car_keeps_its_wheel_where_friction_holds_it():
    simulation = Simulation(system(), parameters={"steering.by_torque": 1})
    hold = COLUMN["friction"] + COLUMN["rack_friction"] * abs(PER_RADIAN)
    t = simulation.run(3.0, 0.01, inputs={"brake": 1.0, "steering_torque": lambda t: 0.8 * hold * min(1.0, t)})
    still = t["steering_wheel_angle"][200:]
    assert abs(still[-1]) < 0.02
    assert np.ptp(still) < 1e-5


def test_the_ends_of_the_rack_stop_a_strong_driver():
    simulation = Simulation(system(*SMOOTH.items()), parameters={"steering.by_torque": 1})
    t = simulation.run(4.0, 0.002, inputs={"steering_torque": lambda t: 40.0 * min(1.0, t)})
    travel = car().steering.rack_travel
    assert travel < abs(t["steering_rack"][-1]) < travel + 0.004
    assert np.max(np.abs(t["steering_rack"])) < travel + 0.008
    assert t["steering_wheel_angle"][-1] > 0.0


def test_the_energy_balance_closes_with_the_work_of_the_driver():
    t = run(system(), 5.0, 0.002, 1, throttle=0.3, steering_torque=lambda t: 3.0 * math.sin(3.0 * t))
    works = sum(t[n] for n in t if n.startswith("energy.") and n.split(".")[1] in WORKS)
    change = t["energy.total"] - t["energy.total"][0]
    size = np.ptp(t["energy.drive"])
    assert np.ptp(t["energy.steering"]) > 1.0  # J
    np.testing.assert_allclose(change, works, rtol=0, atol=2e-3 * size)
    assert np.ptp(change - works) < 0.2 * np.ptp(t["energy.steering"])


WORKS = ("drive", "brakes", "tyres", "dampers", "drag", "ground", "steering", "lift")


def test_the_way_of_steering_is_chosen_before_the_start():
    simulation = Simulation(system())
    with pytest.raises(ValueError, match=r"'steering\.by_torque' is fixed"):
        simulation.set_parameter("steering.by_torque", 1)
    for value in (0.5, 2.0):
        with pytest.raises(ValueError, match="steering.by_torque"):
            Simulation(system(), parameters={"steering.by_torque": value})
    from_file = run(compile(car(by_torque=1.0).model()), 1.0, by_torque=1, steering_torque=0.8)
    by_parameter = run(system(), 1.0, by_torque=1, steering_torque=0.8)
    np.testing.assert_array_equal(from_file["steering_wheel_angle"], by_parameter["steering_wheel_angle"])


def test_the_other_way_of_steering_is_not_heard():
    guided = run(system(), 2.0, **LEFT)
    both = run(system(), 2.0, **LEFT, steering_torque=20.0)
    np.testing.assert_allclose(both["chassis.y"], guided["chassis.y"], atol=1e-9)
    np.testing.assert_allclose(both["steering_wheel_torque"], guided["steering_wheel_torque"], atol=1e-6)
    free = run(system(), 2.0, by_torque=1, throttle=0.12, steering_torque=1.0)
    requested = run(system(), 2.0, by_torque=1, throttle=0.12, steering_torque=1.0, steering=0.5)
    np.testing.assert_allclose(requested["chassis.y"], free["chassis.y"], atol=1e-9)


@pytest.mark.slow
def test_a_car_with_a_frame_and_a_column_is_rigid_only():
    """The frame changes no bit of it; what needs a chassis that bends is refused."""
    with_frame = load("prototype").changed({f"steering.{name}": value for name, value in COLUMN.items()})
    assert list(with_frame.fidelities()) == [Fidelity.RIGID]
    for fidelity in (1, 2, 3):
        with pytest.raises(ModelError, match=f"needs a rigid chassis, fidelity 0; for fidelity {fidelity}"):
            with_frame.model(fidelity=fidelity)
    inputs = {"steering": 0.3, "throttle": 0.5}
    framed, alone = (Simulation(compile(each.model())).run(0.5, 0.005, inputs=inputs) for each in (with_frame, car()))
    assert set(alone) == set(framed)
    for name in alone:
        np.testing.assert_array_equal(framed[name], alone[name], err_msg=name)
    with pytest.raises(KeyError, match="'stress.SG1' is not computed by this System"):
        framed["stress.SG1"]
    posed = with_frame.model()
    pose_outputs(posed)
    assert not posed.flexible_scene
    assert not any(sensor.name.startswith("chassis.mode_") for sensor in posed.sensors)


def test_bad_numbers_are_refused():
    for value in (0.5, 0.7):
        with pytest.raises(CarFileError, match=rf"steering\.by_torque is {value}; it must be 0 or 1\."):
            car(by_torque=value)
    with pytest.raises(CarFileError, match=r"steering\.assistance_limit is missing; without it .* has no effect"):
        car(assistance=1.5)
    assert car(assistance=1.5, assistance_limit=0.0).steering.assistance_limit == 0.0
    with pytest.raises(CarFileError, match=r"stiffness"):
        car(stiffness=115e3)


def test_parameters_are_the_numbers_of_the_file():
    base = {"assistance": 2.0, "assistance_limit": 40.0}
    values = {"assistance": 3.0, "assistance_limit": 20.0}
    values |= {name: 1.5 * float(COLUMN[name]) for name in ("stiffness", "damping", "friction", "rack_friction")}
    parameters = {f"steering.{name}": value for name, value in values.items()}
    changed = Simulation(system(*base.items()), pose=Pose(speed=15.0), parameters=parameters)
    rebuilt = Simulation(compile(car(**values).model()), pose=Pose(speed=15.0))
    a, b = (s.run(2.0, H, inputs=LEFT) for s in (changed, rebuilt))
    for output in ("steering_wheel_torque", "steering_assistance", "chassis.y"):
        np.testing.assert_allclose(a[output], b[output], rtol=0, atol=1e-9)


def test_a_saved_state_continues_with_the_same_bits():
    def fresh() -> Simulation:
        return Simulation(system(), pose=Pose(speed=15.0), parameters={"steering.by_torque": 1})

    inputs = {"throttle": 0.2, "steering_torque": lambda t: 1.5 * math.sin(4.0 * t)}
    first = fresh()
    first.run(1.0, H, inputs=inputs)
    state = first.save()
    on = first.run(2.0, H, inputs=inputs)
    again = fresh()
    again.restore(state)
    assert not again.switch("steering angle")
    resumed = again.run(2.0, H, inputs=inputs)
    np.testing.assert_array_equal(resumed["steering_wheel_angle"], on["steering_wheel_angle"])
    np.testing.assert_array_equal(resumed["chassis.y"], on["chassis.y"])
