"""Contradictory initial velocities are reported with the given and the actual values."""

import numpy as np
import pytest

import mbs
from mbs.model.model import Model


def arm(first=None, second=None, dimension=2) -> mbs.Model:
    """Two rods that are welded together and turn about z."""
    m = mbs.Model("arm", dimension=dimension)
    flat = dimension == 2
    places = [(x, 0.0) if flat else (x, 0.0, 0.0) for x in (0.0, 0.5, 1.0, 1.5)]
    inertia = 0.1 if flat else (0.01, 0.1, 0.1)
    a, b = (m.body(n, mass=1.0, com=places[k], inertia=inertia) for n, k in (("a", 1), ("b", 3)))
    m.revolute("pin", m.ground, a, point=places[0], **({} if flat else {"axis": (0.0, 0.0, 1.0)}))
    m.weld("weld", a, b)
    for body, velocity in ((a, first), (b, second)):
        if velocity is not None:
            m.initial_velocity(body, **velocity)
    return m


def spin(w, dimension=2):
    return {"angular": w if dimension == 2 else (0.0, 0.0, w)}


@pytest.mark.parametrize("dimension", [2, 3])
def test_both_numbers_of_a_contradiction_are_reported(dimension: int) -> None:
    initial, reached = ("1 rad/s", "3 rad/s") if dimension == 2 else ("0, 0, 1 rad/s", "0, 0, 3 rad/s"), []
    system = mbs.compile(arm(spin(1.0, dimension), spin(3.0, dimension), dimension))
    (notices,) = mbs.simulate(system, 0.01, 0.01, progress=False).notices
    assert notices in str(system)
    for name, number in zip("ab", initial, strict=True):
        assert f"the angular velocity of '{name}' is given as {number} and is " in notices
        reached.append(notices.split(f"given as {number} and is ")[1].split(" rad/s")[0])
    assert reached[0] == reached[1]  # the weld
    assert 1.0 < float(reached[0].split()[-1]) < 3.0


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (spin(2.0), {"linear": (0.0, 3.0)}),
        ({"linear": (0.0, 1.0), "angular": 2.0}, None),
        (spin(2.0), {"linear": (5.0, 3.0)}),  # along the rod the pin takes it away, with the other and without
        (spin(0.0), spin(0.0)),
    ],
)
def test_velocities_that_fit_are_kept(first: dict, second: dict | None) -> None:
    system = mbs.compile(arm(first, second))
    assert "contradict" not in str(system)
    w = first.get("angular")
    assert mbs.Simulation(system).state.qd == pytest.approx(
        mbs.Simulation(mbs.compile(arm(spin(w)))).state.qd, abs=1e-6
    )


@pytest.mark.parametrize(
    ("first", "second", "message"),
    [
        ({"linear": (0.0, 1.0), "angular": 3.0}, None, "velocity of 'a' is given as 0, 1 m/s"),
        (spin(2.0), {"linear": (0.0, 4.0)}, "velocity of 'b' is given as 0, 4 m/s"),
    ],
)
def test_parts_of_a_velocity_contradict_each_other_too(first: dict, second: dict | None, message: str) -> None:
    assert message in str(mbs.compile(arm(first, second)))


def test_a_rate_and_a_velocity_contradict_each_other() -> None:
    def pendulum(rate: float, w: float) -> Model:
        m = mbs.Model("pendulum", dimension=2)
        rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
        m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
        m.initial_rate(m.relative_angle("angle", m.ground, rod), rate)
        m.initial_velocity(rod, angular=w)
        return m

    assert "the rate of 'angle' is given as 5 1/s" in str(mbs.compile(pendulum(5.0, 1.0)))
    assert np.abs(mbs.compile(pendulum(5.0, 5.0)).arrays["qd0"]).max() == pytest.approx(5.0)


def test_the_parts_of_a_velocity_may_be_given_one_after_the_other() -> None:
    m = Model("tumbling", gravity=(0, 0, 0))
    body = m.body("body", mass=1.0, com=(0, 0, 0), inertia=(0.1, 0.1, 0.1))
    m.initial_velocity(body, (9.0, 0, 0))
    m.initial_velocity(body, (1.0, 0, 0))
    m.initial_velocity(body, angular=(0, 0, 2.0))
    m.sense_position("speed", body, None, "x", order=1)
    m.sense_rotation("rate", body, "z", order=1)
    sensors = mbs.Simulation(mbs.compile(m)).sensors
    assert (sensors["speed"], sensors["rate"]) == pytest.approx((1.0, 2.0))


@pytest.mark.parametrize("declared", ["a", "ab", "abc"])
@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"a": 2.0}, (2.0, -2.0 * 0.4 / 0.46)),
        ({"a": 2.0, "b": 0.0}, (2.0, 2.0)),
        ({"b": 1.0}, (-0.86 / 3.61, 1.0 - 0.86 / 3.61)),
        ({"velocity": 2.0}, (2.0, -2.0 * 0.4 / 0.46)),
    ],
)
def test_what_is_not_given_has_the_least_kinetic_energy(declared: str, given: dict, expected: tuple) -> None:
    """A double pendulum with the mass matrix [[2.35, 0.4], [0.4, 0.46]] of the rates of its rods: as after an impulse.
    Angles without a given rate, which have no mass, change nothing."""
    m = Model("double pendulum", dimension=2)
    upper = m.body("upper", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    lower = m.body("lower", mass=2.0, com=(1.2, -0.3), inertia=0.2)
    m.revolute("pin", m.ground, upper, point=(0.0, 0.0))
    m.revolute("elbow", upper, lower, point=(1.0, 0.0))
    pairs = {"a": (m.ground, upper), "b": (upper, lower), "c": (m.ground, lower)}
    for name in sorted({*declared, *given} & set(pairs)):
        angle = m.relative_angle(name, *pairs[name])
        if name in given:
            m.initial_rate(angle, given[name])
    if "velocity" in given:
        m.initial_velocity(upper, angular=given["velocity"])
    for body in (upper, lower):
        m.sense_rotation(body.name, body, order=1)
    sensors = mbs.Simulation(mbs.compile(m)).sensors
    assert (sensors["upper"], sensors["lower"]) == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("inertia", [1e-2, 1e-6, 1e-9])
def test_a_light_body_gives_its_velocity_to_a_heavy_one(inertia: float) -> None:
    """Its energy, which weighs what is given, is far below that of the body it carries."""
    m = Model("carrier")
    light = m.body("light", mass=0.2, com=(0.5, 0, 0), inertia=3 * (inertia,))
    heavy = m.body("heavy", mass=2.0, com=(0.7, 0.2, 0), inertia=(0.1, 0.1, 0.1))
    m.weld("weld", light, heavy)
    m.spherical("ball", m.ground, light, point=(0, 0, 0))
    m.initial_velocity(light, angular=(1.0, 2.0, 3.0))
    for c in "xyz":
        m.sense_rotation(c, heavy, c, order=1)
    sensors = mbs.Simulation(mbs.compile(m)).sensors
    assert [sensors[c] for c in "xyz"] == pytest.approx([1.0, 2.0, 3.0], rel=1e-9)


@pytest.mark.parametrize("light", [1e-9, 1e-12, 1e-15])
def test_given_velocities_of_light_and_heavy_bodies_hold_beside_each_other(light: float) -> None:
    """However light: the body between counts beside one of 10 kg."""
    m = Model("chain", dimension=2, gravity=(0.0, 0.0))
    masses, names = (10.0, light, 1.0), ("heavy", "light", "last")
    bodies = [
        m.body(n, mass=mass, com=(k + 0.5, 0.0), inertia=mass)
        for k, (n, mass) in enumerate(zip(names, masses, strict=True))
    ]
    for k, body in enumerate(bodies):
        m.revolute(f"pin {k}", bodies[k - 1] if k else m.ground, body, point=(float(k), 0.0))
    m.initial_velocity(bodies[0], angular=2.0)
    m.initial_velocity(bodies[1], angular=-1.0)
    for body in bodies:
        m.sense_rotation(body.name, body, order=1)
    sensors = mbs.Simulation(mbs.compile(m)).sensors
    assert (sensors["heavy"], sensors["light"]) == pytest.approx((2.0, -1.0), rel=1e-6)
