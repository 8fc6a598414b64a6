"""Compliance: exactly none of a rigid car, a torsion bar by hand, a flexible frame against the engine's equilibrium."""

from functools import cache

import numpy as np
import pytest

from mbs import Affine, Simulation, compile
from mbs.common.errors import ModelError
from mbs.vehicle import Fidelity, load
from mbs.vehicle.kinematics.axle_compliance import LOADS, compliance
from mbs.vehicle.kinematics.car_kinematics import wheel_by_rack
from mbs.vehicle.kinematics.curves import steer_curve
from mbs.vehicle.kinematics.held_car import held_model
from mbs.vehicle.kinematics.wheel_loads import wheel_loads
from mbs.vehicle.linkages.continuation import HEAVE, ROLL
from mbs.vehicle.linkages.linkage import Linkage

COLUMN = {
    "kind": "column",
    "rack_travel": 0.067,
    "rack_per_turn": 0.047,
    "frequency": 10.0,
    "front_wheel_angle_max": 0.5654,
    "rack_mass": 2.5,
    "wheel_inertia": 0.035,
    "stiffness": 115.0,
    "assistance": 1.5,
    "assistance_limit": 60.0,
}


@cache
def flexible():
    return compliance(load("prototype"))


@pytest.mark.parametrize(
    ("car", "fidelity"),
    [("hatchback", Fidelity.RIGID), ("prototype", Fidelity.QUASI_STATIC), ("hatchback", Fidelity.TABLE)],
)
def test_a_rigid_car_does_not_give(car, fidelity):
    actual = compliance(load(car), fidelity)
    assert actual.freedoms == 0
    assert "exactly zero" in actual.sentence
    for values in actual.values.values():
        assert {v for name, v in values.items() if "rate" not in name} == {0.0}


def test_its_wheel_rates_are_those_of_the_curves():
    """By the stiffness of small motions with the multipliers here, by the bending of the ways there."""
    car = load("hatchback")
    for axle, values in compliance(car, "rigid").values.items():
        linkage = Linkage(car, axle)
        for name, direction in (("wheel_rate", HEAVE), ("roll_wheel_rate", ROLL)):
            slope = wheel_loads(linkage, linkage.drawn, direction)[1][0]
            assert values[name] == pytest.approx(slope, rel=1e-6)


def test_a_flexible_frame_gives():
    actual, rigid = flexible(), compliance(load("prototype"), 0)
    assert (actual.fidelity, actual.sentence) == (Fidelity.DYNAMIC, "")
    assert actual.freedoms > 50
    for axle, values in actual.values.items():
        for load_ in LOADS:  # a load moves what it acts on its own way
            moved = {"lateral_force": "contact_y", "aligning_torque": "steer_angle"}.get(load_, "centre_x")
            if load_ != "longitudinal_force":
                assert values[f"{load_}.same.{moved}"] > 0.0
                assert values[f"{load_}.opposed.{moved}"] > 0.0
        assert 0.0 < values["wheel_rate"] <= rigid.values[axle]["wheel_rate"] * (1.0 + 1e-3)
        assert values["roll_wheel_rate"] < rigid.values[axle]["roll_wheel_rate"]
        # Maxwell and Betti: a torque shifts the contact as a force at the contact turns the wheel
        for sense in ("same", "opposed"):
            one, other = values[f"aligning_torque.{sense}.contact_y"], values[f"lateral_force.{sense}.steer_angle"]
            assert one == pytest.approx(other, rel=0.02, abs=1e-11)


def test_the_engine_finds_the_same_in_static_equilibrium():
    """The same car held by drives, loaded by forces: differences of nonlinear equilibria with both signs of a load."""
    m, b, carriers = held_model(load("prototype"), Fidelity.DYNAMIC)
    loads = [m.input(name, min=-1e4, max=1e4) for name in ("lateral", "torque")]
    origin, axes, _ = b.chassis.contact_frame
    still = m.guide_time("still", ([0.0, 1.0], [0.0, 0.0]), unit="m")
    drawn = np.array([c.reference for c in m.coordinates])
    coordinates = {"x": origin[0], "y": origin[1], "z": origin[2], "1": axes[0][1], "2": axes[0][2], "3": axes[1][2]}
    for name, (carrier, centre) in carriers.items():
        coordinates[name] = carrier.point(centre)[2]
    for name, value in coordinates.items():
        m.drive(f"held {name}", value + Affine({}, -value.value(drawn)), still)
    for name in ("FL", "FR"):
        carrier, centre = carriers[name]
        m.force(f"lateral {name}", carrier, (centre[0], centre[1], 0.0), inputs=(None, loads[0], None))
        m.torque(f"torque {name}", carrier, inputs=(None, None, loads[1]))
    carrier = carriers["FL"][0]
    leftward = carrier.vector((0.0, 1.0, 0.0))
    m.sense_coordinate("ax", leftward[0], unit="1")
    m.sense_coordinate("az", leftward[2], unit="1")
    system = compile(m)

    def at(lateral, torque):
        simulation = Simulation(system, inputs={"lateral": lateral, "torque": torque})
        simulation.static_equilibrium()
        return simulation.sensors

    actual = flexible().values["front"]
    for name, size in (("lateral_force", 200.0), ("aligning_torque", 50.0)):
        pair = (size, 0.0) if name == "lateral_force" else (0.0, size)
        ahead, back = at(*pair), at(-pair[0], -pair[1])
        steer, lean = (sign * (ahead[a] - back[a]) / (2.0 * size) for a, sign in (("ax", -1.0), ("az", 1.0)))
        assert actual[f"{name}.same.steer_angle"] == pytest.approx(steer, rel=0.01)
        assert actual[f"{name}.same.inclination_angle"] == pytest.approx(lean, rel=0.01)


def test_a_torsion_bar_gives_by_the_square_of_the_steering_ratio():
    """Both torques act on the pinion over the ratio; the assistance carries its part."""
    car = load("hatchback").changed({"steering": COLUMN})
    actual = compliance(car)
    assert (actual.fidelity, actual.freedoms, actual.sentence) == (Fidelity.RIGID, 1, "")
    linkage = Linkage(car, "front")
    curve = steer_curve(linkage, np.array([-0.001, 0.0, 0.001]), wheel_by_rack(car))
    ratio = curve.drawn()["steering_ratio"]
    by_hand = 2.0 / ratio**2 / (115.0 * (1.0 + 1.5))
    values = actual.values["front"]
    assert values["aligning_torque.same.steer_angle"] == pytest.approx(by_hand, rel=0.01)
    assert values["aligning_torque.opposed.steer_angle"] == pytest.approx(0.0, abs=1e-6 * by_hand)
    trail = curve.drawn()["caster_trail_left"]  # a force to the left at the contact behind the axis turns it right
    assert values["lateral_force.same.steer_angle"] == pytest.approx(-trail * by_hand, rel=0.03)


def test_invalid_requests_are_refused():
    with pytest.raises(ModelError, match="The fidelity of the car is 7"):
        compliance(load("prototype"), 7)
    car = load("hatchback").changed({"steering": COLUMN})
    with pytest.raises(ModelError, match="The car 'hatchback' has fidelity 0 only, not 2"):
        compliance(car, "2")
    with pytest.raises(TypeError, match=r"a Car of mbs.vehicle.load\(\)"):
        compliance("hatchback")
