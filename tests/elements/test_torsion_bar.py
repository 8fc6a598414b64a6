"""The torsion bar of a steering: its spring, its assistance, its tangent."""

import numpy as np
import pytest

from mbs.elements import InputForce, ScalarSpringDamper, TorsionBar
from tests.elements.harness import Element, signals
from tests.elements.stepper import Part, Stepper

K = 100.0  # N m/rad
C = 0.8  # N m s/rad
GAIN = 6.0  # assistance over torque
LIMIT = 40.0  # N m, of the assistance


def bar(gain: float = 0.0, limit: float = 0.0) -> Element:
    return Element(TorsionBar(K, C, gain, limit).record("bar", *signals(2)))


def test_it_turns_the_pinion_on_and_the_wheel_back():
    r = bar()(np.array([0.03, 0.01]), np.array([0.5, 0.2]), [], 0.01)
    torque = K * 0.02 + C * 0.3
    assert r.out == pytest.approx({"torque": torque, "assistance": 0.0})
    assert r.f == pytest.approx([-torque, torque])
    assert r.potential == pytest.approx(0.5 * K * 0.02**2)


def test_the_assistance_grows_with_the_torque_up_to_its_limit():
    assisted = bar(GAIN, LIMIT)
    for twist, expected in ((1e-6, GAIN * K * 1e-6), (5.0, LIMIT), (-5.0, -LIMIT)):
        r = assisted(np.array([twist, 0.0]), np.zeros(2), [], 0.01)
        assert r.out["assistance"] == pytest.approx(expected, rel=1e-3)
        assert r.f == pytest.approx([-r.out["torque"], r.out["torque"] + r.out["assistance"]])
    r = assisted(np.array([0.1, 0.0]), np.zeros(2), [], 0.01)
    unlimited = GAIN * K * 0.1
    assert r.out["assistance"] == pytest.approx(unlimited / np.hypot(1.0, unlimited / LIMIT))


@pytest.mark.parametrize(("gain", "limit"), [(0.0, 0.0), (GAIN, LIMIT)])
def test_the_tangent_is_that_of_the_force_but_for_what_the_wheel_does_through_the_motor(gain, limit):
    element, u, ud, h = bar(gain, limit), np.array([0.04, -0.02]), np.array([0.3, 0.1]), 0.01
    r = element(u, ud, [], h, 0.5 * h, 0.25 * h * h)
    small, expected = 1e-6, np.zeros((2, 2))
    for k in range(2):
        e = small * np.eye(2)[k]
        for weight, of in (
            (0.25 * h * h, lambda s: element(u + s, ud, [], h).f),
            (0.5 * h, lambda s: element(u, ud + s, [], h).f),
        ):
            expected[:, k] -= weight * (of(e) - of(-e)) / (2.0 * small)
    assert r.S[[0, 0, 1], [0, 1, 1]] == pytest.approx(expected[[0, 0, 1], [0, 1, 1]], rel=1e-6)
    assert r.S[1, 0] == r.S[0, 1]
    assert np.all(np.linalg.eigvalsh(r.S) > -1e-12)
    if gain:
        assert expected[1, 0] < 2.0 * r.S[1, 0]  # what is left out is there


@pytest.mark.slow
def test_steps_converge_with_a_strong_assistance():
    """Wheel and pinion with a spring at the rack: the wheel ends where its torque has the spring in balance."""
    h = 0.02
    one, spring, hand = np.eye(2), 60.0, 2.0
    parts = [
        Part(bar(12.0, 80.0), one, np.zeros(2)),
        Part(Element(ScalarSpringDamper(spring, 1.5).record("rack", signals(1)[0])), one[1:], np.zeros(1)),
        Part(Element(ScalarSpringDamper(0.0, 0.3).record("column", signals(1)[0])), one[:1], np.zeros(1)),
        Part(Element(InputForce(0).record("hand", signals(1))), one[:1], np.zeros(1), lambda t: (hand,)),
    ]
    s = Stepper(np.array([0.03, 0.007]), np.zeros(2), parts, [0.0, 0.0], [0.0, 0.0])
    s.run(4.0, h)
    unlimited = 12.0 * hand
    load = hand + unlimited / np.hypot(1.0, unlimited / 80.0)
    assert s.q[1] == pytest.approx(load / spring, rel=1e-6)
    assert s.q[0] - s.q[1] == pytest.approx(hand / K, rel=1e-6)
    assert max(s.iterations) <= 1000.0 * h + 12
