"""Payloads of the prototype: wheel loads, and what they do to a frame that bends."""

from pathlib import Path

import numpy as np
import pytest

import mbs
from mbs.vehicle import Car
from mbs.vehicle.environment import GRAVITY
from tests.vehicle.frame_cars import PROTOTYPE, chassis_of, copied, prototype_with

REST = {"drive.creep_torque": 0.0}
MASS = 80.0  # kg
WHEELS = ("FL", "FR", "RL", "RR")
SHARE = {1: 2e-3, 2: 0.2, 3: 2e-3}
"""Error of what a payload adds: the modes of fidelity 2 are those of the car without it."""
MOMENTS = tuple(f"bending_moment.SG{k}" for k in (1, 2, 3, 4))


def at_rest(car: Car, fidelity: int, parameters: dict[str, float] | None = None) -> dict[str, float]:
    return mbs.Simulation(mbs.compile(car.model(fidelity=fidelity)), parameters=REST | (parameters or {})).sensors


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", [0, 3])
def test_wheels_carry_a_passenger_by_the_rule_of_the_lever(fidelity: int) -> None:
    """Axle loads and the moment about the x axis, of the places where the wheels stand then."""
    before, after = at_rest(PROTOTYPE, fidelity), at_rest(PROTOTYPE, fidelity, {"payload.passenger.mass": MASS})
    gained = {w: after[f"wheel_{w}.Fz"] - before[f"wheel_{w}.Fz"] for w in WHEELS}
    x, y, _ = PROTOTYPE.payload["passenger"].point
    assert sum(gained.values()) == pytest.approx(MASS * GRAVITY, rel=1e-6)
    front = MASS * GRAVITY * (PROTOTYPE.wheelbase + x) / PROTOTYPE.wheelbase
    assert gained["FL"] + gained["FR"] == pytest.approx(front, rel=0.02)  # the car sinks and leans a little
    tracks = {"F": PROTOTYPE.front.track, "R": PROTOTYPE.rear.track}
    turn = sum(0.5 * tracks[a] * (gained[f"{a}L"] - gained[f"{a}R"]) for a in "FR")
    lean = 597.0 * GRAVITY * (PROTOTYPE.vehicle.reference_point[2]) * after["chassis.roll"]
    assert turn + lean == pytest.approx(MASS * GRAVITY * y, rel=0.1)
    assert gained["FR"] > gained["FL"]


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", [1, 2, 3])
def test_a_payload_bends_the_frame_like_masses_on_the_joints_that_share_it(fidelity: int, tmp_path: Path) -> None:
    """At the mean of the joints each takes the same share: another frame carries these masses itself."""
    frame = PROTOTYPE.flexible_frame
    joints = [joint for pair in frame.joints.ground for joint in pair]
    middle = np.mean([frame.place(joint) for joint in joints], axis=0)
    loaded = PROTOTYPE.changed({"payload": {"weight": {"mass": MASS, "point": middle.tolist()}}})
    folder = copied(tmp_path)
    lines = [f"weight,{joint},{MASS / len(joints)}" for joint in joints if joint.endswith("L")]
    with (folder / "masses.csv").open("a") as file:
        file.write("\n".join(lines) + "\n")
    data = {**chassis_of(PROTOTYPE.frame_section.tubular(folder))}
    data["accelerometers"] = PROTOTYPE._data["chassis"]["accelerometers"]
    heavy = prototype_with(PROTOTYPE._data["chassis"]["frame"], folder, data, {"vehicle.mass": 597.0 + MASS})
    one, two, empty = (at_rest(car, fidelity) for car in (loaded, heavy, PROTOTYPE))
    for wheel in WHEELS:
        assert one[f"wheel_{wheel}.Fz"] == pytest.approx(two[f"wheel_{wheel}.Fz"], rel=1e-5)
    for name in MOMENTS:
        assert one[name] == pytest.approx(two[name], abs=SHARE[fidelity] * abs(two[name] - empty[name]) + 1e-4)
        assert abs(two[name] - empty[name]) > 0.05


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", [1, 2])
def test_a_payload_of_the_file_is_the_parameter_of_the_model(fidelity: int) -> None:
    rebuilt = PROTOTYPE.changed({"payload.luggage.mass": 30.0})
    one, two = at_rest(PROTOTYPE, fidelity, {"payload.luggage.mass": 30.0}), at_rest(rebuilt, fidelity)
    for name, value in one.items():
        assert two[name] == pytest.approx(value, rel=1e-9, abs=1e-9)
