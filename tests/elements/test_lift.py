"""Aerodynamic lift: a closed form, the axes of the body, and a wing that flies."""

import re

import numpy as np
import pytest

from mbs import Model, ModelError, compile, simulate
from mbs.elements import Lift, Wind
from tests.elements.harness import Element, frame, vectors

AXES = {"forward": (1.0, 0.0, 0.0), "up": (0.0, 0.0, 1.0)}


@pytest.mark.parametrize("area", [0.3, -0.5])
def test_lift_is_that_of_the_speed_along_the_body(area: float) -> None:
    rng = np.random.default_rng(4)
    R, velocity = frame(rng), 20.0 * rng.normal(size=3)
    element = Element(Lift(area, 1.2).record("wing", *vectors(3, 3, 3)))
    r = element(np.r_[rng.normal(size=3), R[:, 0], R[:, 2]], np.r_[velocity, rng.normal(size=6)])
    forward = velocity @ R[:, 0]
    size = 0.5 * 1.2 * area * forward**2
    assert r.out["force"] == pytest.approx(size, rel=1e-13)
    assert np.allclose(r.f[:3], size * R[:, 2], rtol=1e-13)
    assert not r.f[3:].any()
    assert r.potential == 0.0


def test_two_axles_hold_a_plate_at_the_speed_of_flight_without_pitching() -> None:
    """Lift of both axles is the weight at v: it goes on straight, and falls below v."""
    mass, v, g = 50.0, 30.0, 9.81
    area = 2.0 * mass * g / (1.225 * v**2)

    def flight(speed: float) -> tuple[float, float]:
        m = Model("plate", gravity=(0.0, 0.0, -g))
        plate = m.body("plate", mass=mass, com=(0.0, 0.0, 0.0), inertia=(5.0, 20.0, 20.0))
        m.lift("front", plate, (1.0, 0.0, 0.0), lift_area=0.25 * area, **AXES)
        m.lift("rear", plate, (-1.0 / 3.0, 0.0, 0.0), lift_area=0.75 * area, **AXES)
        m.initial_velocity(plate, linear=(speed, 0.0, 0.0), angular=(0.0, 0.0, 0.0))
        m.sense_position("z", plate, component="z")
        m.sense_element("lift", "front", "force")
        run = simulate(compile(m), 1.0, 0.005)
        return float(run["z"][-1]), float(run["lift"][0])

    height, front = flight(v)
    assert height == pytest.approx(0.0, abs=1e-9)
    assert front == pytest.approx(0.25 * mass * g, rel=1e-12)
    assert flight(0.5 * v)[0] < -3.0


def test_the_axes_are_those_of_the_body_as_drawn() -> None:
    m = Model("sideways")
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    m.lift("wing", body, (0.0, 0.0, 0.0), lift_area=1.0, air_density=2.0, forward=(0.0, 3.0, 0.0), up=(1.0, 0.0, 0.0))
    m.initial_velocity(body, linear=(0.0, 4.0, 0.0), angular=(0.0, 0.0, 0.0))
    m.sense_position("ax", body, component="x", order=2)
    assert simulate(compile(m), 0.01, 0.01)["ax"][0] == pytest.approx(16.0, rel=1e-12)


def test_bad_lifts_are_refused() -> None:
    with pytest.raises(ValueError, match=re.escape("has 2 components and its point 3; they must agree")):
        Lift(0.3).record("wing", *vectors(3, 2, 3))
    m = Model("points")
    bob = m.point_mass("bob", mass=1.0, position=(0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="bob"):
        m.lift("wing", bob, (0.0, 0.0, 0.0), lift_area=1.0, **AXES)
    assert m.elements == []


@pytest.mark.parametrize("missing", [Wind(0, 2), Wind(2, 1)])
def test_wind_by_inputs_that_the_model_does_not_have_is_refused(missing: Wind) -> None:
    m = Model("gust")
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    speed, heading = (m.input(name, min=-1.0, max=1.0).index for name in ("speed", "heading"))
    numbers = [missing.speed, missing.heading]
    message = re.escape(f"has the inputs {numbers}, but the model 'gust' has 2, counted from 0.")
    with pytest.raises(ModelError, match=f"The wind of drag 'air' {message}"):
        m.drag("air", body, (0.0, 0.0, 0.0), drag_area=1.0, wind=missing)
    with pytest.raises(ModelError, match=f"The wind of lift 'wing' {message}"):
        m.lift("wing", body, (0.0, 0.0, 0.0), lift_area=1.0, wind=missing, **AXES)
    m.drag("air", body, (0.0, 0.0, 0.0), drag_area=1.0, wind=Wind(speed, heading))
    m.lift("wing", body, (0.0, 0.0, 0.0), lift_area=1.0, wind=Wind(speed, heading), **AXES)
    assert [e.name for e in m.elements] == ["air", "wing"]
