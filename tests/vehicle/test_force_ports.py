"""Forces, wind and tyres at ports: closed forms, works that close, a copy of the tyre in a second place."""

from collections.abc import Callable
from itertools import product

import numpy as np
import pytest

import mbs
from mbs.vehicle import Car, CarFileError
from tests.quick import quick
from tests.scenes.car import ON_ICE
from tests.vehicle.cars_with_ports import STEP, WHEELS, hatchback, rigid, simulation, system, with_ports, works_of
from tests.vehicle.second_tyres import drive, longest, saloon

ORDERS = [*product((hatchback, saloon, rigid), (False, True))]
"""Whether the tyre is stepped at once with the car, by the car."""


def test_works_of_forces_and_wind_close_the_balance() -> None:
    """To 1e-6 of the largest work, beside the step's own error."""
    s = simulation(hatchback, 12.0, forces="vehicle", wind="speed")
    start = s.sensors
    for k in range(600):
        s.set_input("point_reference.Fx", 2500.0)
        s.set_input("point_reference.Fy", 2000.0 * np.sin(k / 100))
        s.set_input("point_reference.Mz", 1500.0 * np.cos(k / 80))
        s.set_input("wind.speed", 20.0)
        s.set_input("wind.heading", 1.5)
        s.step(STEP)
    end = s.sensors
    works = works_of(end)
    assert works["energy.ports"] > 1e4
    residual = end["energy.total"] - start["energy.total"] - sum(works.values())
    own = abs(s.instance.report()["energy_error"])
    assert abs(residual) < 1e-6 * max(map(abs, works.values())) + own


@pytest.mark.slow
def test_a_hitch_pulls_as_a_trailer_does() -> None:
    """Force F at a point h above the ground and d behind the rear axle: wheel loads move by F h and Fz d over the
    wheelbase; the point tells where it is and how fast.
    """
    car = with_ports(hatchback(), forces="earth", force_points={"hitch": [-3.2, 0.0, 0.45]})
    loads = {}
    for pull in (0.0, 1.0):
        s = mbs.Simulation(mbs.compile(car.model()), inputs={"brake": 1.0, "hand_brake": 1.0})
        s.set_input("point_hitch.Fx", -600.0 * pull)
        s.set_input("point_hitch.Fz", -700.0 * pull)
        s.step(STEP, 3000)
        loads[pull] = s.sensors
    first, now = loads[0.0], loads[1.0]
    front, back = (sum(now[f"wheel_{a}{b}.Fz"] - first[f"wheel_{a}{b}.Fz"] for b in "LR") for a in "FR")
    assert front + back == pytest.approx(700.0, rel=1e-3)
    arm = now["wheel_RL.contact_x"] - now["point_hitch.x"]
    assert arm > 0.3
    weight = sum(first[f"wheel_{w}.Fz"] for w in WHEELS)
    about_rear = {}
    for pull, at in loads.items():  # the car moves on its springs, so its weight has another lever
        rear = at["wheel_RL.contact_x"]
        fronts = sum(at[f"wheel_F{b}.Fz"] for b in "LR") * (at["wheel_FL.contact_x"] - rear)
        about_rear[pull] = fronts - weight * (at["chassis.x"] - rear)
    pulled = about_rear[1.0] - about_rear[0.0]
    assert -pulled == pytest.approx(700.0 * arm + 600.0 * now["point_hitch.z"], rel=0.01)
    moving = mbs.Simulation(mbs.compile(car.model()), pose=mbs.Pose(speed=8.0, yaw_rate=0.3))
    motion = moving.sensors
    turned = 0.3 * (motion["chassis.x"] - motion["point_hitch.x"])
    assert motion["point_hitch.vy"] == pytest.approx(motion["chassis.earth_vy"] - turned, rel=1e-6)


@ON_ICE
def test_a_torque_about_the_vertical_axis_turns_the_car_on_ice() -> None:
    car = with_ports(hatchback(), forces="vehicle")
    ice = mbs.Simulation(mbs.compile(car.model()), parameters={"road.friction": 0.0})
    ice.set_input("point_reference.Mz", 1000.0)
    ice.step(STEP, 100)
    first = ice.sensors["chassis.wz"]
    ice.set_input("point_reference.Mz", -1000.0)
    ice.step(STEP, 100)
    assert first > 0.05
    assert abs(ice.sensors["chassis.wz"]) < 0.02 * first


@pytest.mark.slow
def test_copies_of_the_tyres_in_a_second_place_converge_to_the_closed_car() -> None:
    """By order one, held over 2 and 4 ms."""
    (fine, path, _, loop), (coarse, *_) = (drive(step, 15.0, pedals={"throttle": 0.4}) for step in (0.002, 0.004))
    assert fine < 1e-2
    assert path < 2e-3
    assert 1.6 < coarse / fine < 2.6
    end = loop.sensors
    works = works_of(end)
    assert abs(works["energy.ports"]) > 100.0
    assert works["energy.tyres"] == 0.0


@pytest.mark.slow
@pytest.mark.parametrize(("make", "late"), quick({(hatchback, True), (saloon, False)}, ORDERS, "proof"))
def test_a_wheel_is_calm_up_to_the_step_that_its_tyre_bears(make: Callable[[], Car], late: bool) -> None:
    """At 5 m/s, with forces that are held; an FMU tells from 0.85 of it on."""
    h = longest(make(), 5.0, slopes=False, late=late)
    calm, shaken = (drive(part * h, 5.0, make=make, late=late, time=1.0)[2] for part in (0.85, 1.4))
    assert calm < 0.015
    assert shaken > 0.05


def test_what_a_tyre_at_a_port_replaces_is_left_out() -> None:
    car = with_ports(hatchback(), tyre="hub")
    m = car.model()
    assert not [e.name for e in m.elements if e.name.startswith("tyre ")]
    assert not [p.name for p in m.parameters if ".tyre." in p.name]
    own = [s.name for s in hatchback().model().sensors]
    mine = [s.name for s in m.sensors]
    assert [n for n in mine if n in own] == [n for n in own if n in set(mine)]
    assert "wheel_FL.Fz" not in mine
    with pytest.raises(CarFileError, match=r"ports\.tyre and ports\.road"):
        with_ports(hatchback(), tyre="hub", road="planes")


@pytest.mark.slow
def test_free_hubs_let_the_car_fall() -> None:
    """Without tyres nothing carries it: its centre of mass has the acceleration of gravity."""
    s = mbs.Simulation(system(hatchback, (("tyre", "hub"),)))
    before = s.sensors
    s.step(STEP, 50)
    now = s.sensors
    weight = sum(simulation(hatchback, 0.0).sensors[f"wheel_{w}.Fz"] for w in WHEELS)
    fallen = now["energy.gravity"] - before["energy.gravity"]
    assert fallen == pytest.approx(-weight * 0.5 * 9.81 * 0.1**2, rel=1e-3)
