"""Friction on a coordinate holds below its largest force, slides at it, and only takes energy."""

import numpy as np
import pytest

from mbs.elements import CoordinateFriction, InputForce, ScalarSpringDamper
from tests.elements.harness import Element, signals, tangent_by_differences
from tests.elements.stepper import Part, Stepper

LARGEST = 1.5
INERTIA = 0.03
GIVE = 0.004
FRICTION = CoordinateFriction(LARGEST, LARGEST / GIVE, 2.0 * np.sqrt(LARGEST / GIVE * INERTIA))  # damped critically


def element() -> Element:
    return Element(FRICTION.record("friction", signals(1)[0]))


def shaft(torque: float, rate: float = 0.0, ramp: float = 0.2, spring: float = 0.0) -> Stepper:
    """A shaft on which a torque acts that is constant after a ramp (s)."""
    parts = [
        Part(element(), np.eye(1), np.zeros(1)),
        Part(
            Element(InputForce(0).record("torque", signals(1))),
            np.eye(1),
            np.zeros(1),
            lambda t: (torque * min(1.0, t / ramp),),
        ),
    ]
    if spring:
        parts.append(Part(Element(ScalarSpringDamper(spring).record("s", signals(1)[0])), np.eye(1), np.zeros(1)))
    return Stepper(np.array([INERTIA]), np.zeros(1), parts, [0.0], [rate])


def test_it_holds_below_its_largest_force_and_does_not_creep() -> None:
    h = 0.01
    s = shaft(0.9 * LARGEST)
    s.run(1.0, h)
    elastic = s.q[0]
    assert elastic == pytest.approx(0.9 * GIVE, rel=1e-4)
    s.run(4.0, h)
    assert s.q[0] == pytest.approx(elastic, rel=1e-6)
    assert s.results[0].out["sticking"] == 1.0
    assert s.results[0].out["force"] == pytest.approx(-0.9 * LARGEST, rel=1e-6)


def test_beyond_it_the_rest_of_the_torque_accelerates() -> None:
    s = shaft(2.0 * LARGEST, ramp=1e-9)
    s.run(0.5, 0.001)
    before = s.qd[0]
    s.run(1.0, 0.001)
    assert (s.qd[0] - before) / 0.5 == pytest.approx(LARGEST / INERTIA, rel=1e-6)
    assert s.results[0].out["sticking"] == 0.0


def test_a_spring_leaves_it_within_the_friction_over_its_stiffness() -> None:
    spring = 8.0
    s = shaft(0.0, 12.0, spring=spring)
    s.run(4.0, 0.005)
    assert abs(s.q[0]) <= LARGEST / spring * (1.0 + 1e-6)
    assert abs(s.q[0]) > 1e-3  # it does not return to the middle


@pytest.mark.parametrize("h", [0.0005, 0.2])
def test_slip_never_gives_energy(h: float) -> None:
    friction, rng, slipped = element(), np.random.default_rng(3), 0
    for _ in range(300):
        y = np.r_[rng.normal() * GIVE, rng.normal()]
        rate = rng.normal() * 10.0 ** rng.uniform(-3.0, 1.5)
        r = friction(np.zeros(1), np.array([rate]), y, h)
        assert -r.out["force"] * (rate - r.y[1]) >= -1e-9 * LARGEST * abs(rate)
        assert abs(r.out["force"]) <= LARGEST
        slipped += r.out["sticking"] == 0.0
    assert slipped > 50


def test_the_tangent_is_exact_while_it_holds_and_a_secant_while_it_slides() -> None:
    friction, h = element(), 0.01
    u, ud, y = np.zeros(1), np.array([0.02]), np.array([1e-4, 0.0])
    r = friction(u, ud, y, h, 0.5 * h, 0.0)
    assert r.out["sticking"] == 1.0
    expected = tangent_by_differences(friction, u, ud, y, h, 0.5 * h, 0.0, [0.0])
    assert pytest.approx(expected, rel=1e-6) == r.S
    r = friction(u, np.array([30.0]), y, h, 0.5 * h, 0.0)
    assert r.out["sticking"] == 0.0
    assert 0.5 * 0.5 * h * LARGEST / 30.0 < r.S[0, 0] < 0.5 * h * LARGEST / 29.0
