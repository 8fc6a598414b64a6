"""Energy balance of elements that a user adds to a car; without them a car is unchanged."""

import numpy as np
import pytest

import mbs
from mbs.elements import SpringDamper
from mbs.vehicle import load
from tests.scenes.car import ON_ICE

WORKS = tuple(f"energy.{name}" for name in ("drive", "brakes", "tyres", "dampers", "drag", "ground"))


def car() -> mbs.Model:
    return load("prototype").model()


@ON_ICE
def test_works_of_added_elements_close_the_balance() -> None:
    """A torque by an input turns the standing car on ice, and a damper holds it against the ground."""
    m = car()
    chassis = next(body for body in m.bodies if body.name == "chassis")
    turn = m.input("port.turn", unit="N.m")
    m.torque("port", chassis, inputs=(None, None, turn))
    hold = SpringDamper(2000.0, 500.0, 1.0)
    m.add(hold.record("tie", chassis.point((0.0, 1.0, 0.5)) - m.ground.point((0.0, 3.0, 0.5))))
    m.sense_solver("solver.energy_error", "energy_error")
    r = mbs.simulate(mbs.compile(m), 2.0, 0.002, {"port.turn": 3000.0}, parameters={"road.friction": 0.0})
    change = {n: float(r[n][-1] - r[n][0]) for n in (*WORKS, "energy.total", "energy.added", "solver.energy_error")}
    residual = change["energy.total"] - sum(change[n] for n in WORKS) - change["solver.energy_error"]
    assert np.abs(r["chassis.yaw"]).max() > 0.05
    assert change["energy.added"] == pytest.approx(residual, rel=1e-6)
    assert abs(change["energy.added"]) > 10.0


def test_a_refused_element_opens_no_book() -> None:
    m = car()
    with pytest.raises(mbs.ModelError):
        m.add(SpringDamper(1.0, 1.0, 1.0).record("spring FL", m.bodies[0].point((0.0, 0.0, 0.0))))
    assert "energy.added" not in [s.name for s in m.sensors]
    assert m.book_of_added is not None
