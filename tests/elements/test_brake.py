"""The brake sticks, slips at its bound and lets go."""

from dataclasses import replace

import numpy as np
import pytest

from mbs.elements import Brake, InputForce
from tests.elements.harness import Element, frame, signals, tangent_by_differences, vectors
from tests.elements.stepper import Part, Stepper

TORQUE = 650.0  # N m
RADIUS = 0.27  # m
INERTIA = 0.55  # kg m2
STIFFNESS = TORQUE * RADIUS / 0.9e-3  # the tread gives 0.9 mm at full torque
BRAKE = Brake(TORQUE, STIFFNESS, 2.0 * np.sqrt(STIFFNESS * INERTIA))  # damped critically


def brake_element() -> Element:
    f, g, spin = vectors(3, 3, 1)
    return Element(BRAKE.record("brake", f, g, spin[0], 0))


def signals_of(
    spin: float, omega: np.ndarray | None = None, R: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Signals of a wheel with absolute rate `spin` on a carrier that turns with omega."""
    R = np.eye(3) if R is None else R
    omega = np.zeros(3) if omega is None else omega
    f, g = R[:, 0], R[:, 1]
    return np.r_[f, g, 0.0], np.r_[np.cross(omega, f), np.cross(omega, g), spin]


def wheel(pedal: float, torque: float, rate: float = 0.0, ramp: float = 0.0) -> Stepper:
    """One wheel on a fixed carrier, driven by a torque that is constant after a linear ramp (s)."""
    B = np.zeros((7, 1))
    B[6, 0] = 1.0
    part = Part(brake_element(), B, np.r_[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0], lambda t: (pedal,))
    drive = Part(
        Element(InputForce(0).record("drive", signals(1))),
        np.eye(1),
        np.zeros(1),
        lambda t: (torque * (min(1.0, t / ramp) if ramp else 1.0),),
    )
    return Stepper(np.array([INERTIA]), np.zeros(1), [part, drive], [0.0], [rate])


def test_torque_acts_on_the_wheel_relative_to_its_carrier_by_virtual_work() -> None:
    rng = np.random.default_rng(14)
    R, omega = frame(rng), rng.normal(size=3)
    axis = R[:, 2]
    u, ud = signals_of(20.0, omega, R)
    r = brake_element()(u, ud, [0.0, 0.0], 0.01, inputs=[0.5])
    assert r.out["rate"] == pytest.approx(20.0 - omega @ axis, rel=1e-12)
    assert r.out["torque"] == pytest.approx(-0.5 * TORQUE)
    assert r.out["sticking"] == 0.0
    assert r.f @ ud == pytest.approx(r.out["torque"] * r.out["rate"], rel=1e-12)
    for turn in np.eye(3):  # a virtual rotation of carrier and wheel together meets no torque
        virtual = np.r_[np.cross(turn, R[:, 0]), np.cross(turn, R[:, 1]), turn @ axis]
        assert r.f @ virtual == pytest.approx(0.0, abs=1e-10)
    assert r.f[6] == r.out["torque"]


def test_held_wheel_gives_by_less_than_a_millimetre_and_does_not_creep() -> None:
    h = 0.01
    s = wheel(1.0, 0.95 * TORQUE, ramp=0.5)
    s.run(1.0, h)
    assert s.q[0] * RADIUS < 1e-3
    assert s.q[0] == pytest.approx(0.95 * TORQUE / BRAKE.stick_stiffness, rel=1e-4)
    rest = s.q[0]
    s.run(4.0, h)
    assert s.q[0] == pytest.approx(rest, rel=1e-4)
    assert s.results[0].out["sticking"] == 1.0


@pytest.mark.parametrize("h", [0.01, 0.001])
def test_stick_rings_out_within_a_few_steps(h: float) -> None:
    s = wheel(1.0, 300.0)
    deviations = []
    for _ in range(30):
        s.step(h)
        deviations.append(abs(s.results[0].out["torque"] + 300.0))
    assert max(deviations[15:]) < 0.02 * max(deviations[:3])


def test_wheel_stops_when_the_torque_has_taken_its_momentum() -> None:
    rate = 40.0
    expected = INERTIA * rate / TORQUE
    s = wheel(1.0, 0.0, rate)
    h, energies = 0.0005, []
    while s.qd[0] > 0.5:
        s.step(h)
        energies.append(s.energy)
    assert s.t == pytest.approx(expected, abs=3 * h)
    s.run(s.t + 0.1, h)
    assert abs(s.qd[0]) < 1e-6
    assert np.max(np.diff(energies)) <= 0.0


@pytest.mark.parametrize("h", [0.0005, 0.2])
def test_slip_never_gives_energy(h: float) -> None:
    element, rng = brake_element(), np.random.default_rng(15)
    slipped = 0
    for _ in range(300):
        y = np.r_[rng.normal() * 0.004, rng.normal()]
        u, ud = signals_of(rng.normal() * 10.0 ** rng.uniform(-3.0, 1.5))
        r = element(u, ud, y, h, inputs=[rng.uniform()])
        sliding = r.out["rate"] - r.y[1]
        assert -r.out["torque"] * sliding >= -1e-9 * TORQUE * abs(r.out["rate"])
        slipped += r.out["sticking"] == 0.0
    assert slipped > 50


def test_released_brake_has_no_torque_and_unwinds() -> None:
    element = brake_element()
    y = np.r_[0.003, 0.1]
    for _ in range(40):
        u, ud = signals_of(7.0)
        r = element(u, ud, y, 0.01)
        assert np.array_equal(r.f, np.zeros(7))
        assert r.out["sticking"] == 0.0
        y = r.y
    assert abs(y[0]) < 1e-9
    assert element(u, ud, y, 0.01, inputs=[-3.0]).out["torque"] == 0.0
    assert element(u, ud, y, 0.01, inputs=[9.0]).out["torque"] == -TORQUE


def test_a_released_brake_does_not_stick_at_rest_either() -> None:
    element = brake_element()
    u, ud = signals_of(0.0)
    assert element(u, ud, [0.0, 0.0], 0.01).out["sticking"] == 0.0
    assert element(u, ud, [0.0, 0.0], 0.01, inputs=[1e-3]).out["sticking"] == 1.0


def test_tangent_is_exact_while_sticking_and_a_safe_secant_while_slipping() -> None:
    element, rng = brake_element(), np.random.default_rng(16)
    h = 0.01
    R = frame(rng)
    u, ud = signals_of(0.02, 0.01 * rng.normal(size=3), R)
    r = element(u, ud, [1e-4, 0.0], h, 0.5 * h, 0.0, [1.0])
    assert r.out["sticking"] == 1.0
    expected = tangent_by_differences(element, u, ud, np.r_[1e-4, 0.0], h, 0.5 * h, 0.0, [1.0])
    assert np.max(np.abs(r.S - expected)) < 1e-6 * np.max(np.abs(expected))
    u, ud = signals_of(30.0, np.zeros(3), R)
    r = element(u, ud, [0.0, 0.0], h, 0.5 * h, 0.0, [1.0])
    assert r.out["sticking"] == 0.0
    eigenvalues = np.linalg.eigvalsh(r.S)
    assert eigenvalues[0] > -1e-12
    assert 0.5 * TORQUE / 30.0 < r.S[6, 6] / (0.5 * h) < 0.6 * TORQUE / 30.0
    D = BRAKE.stick_damping + 0.5 * h * BRAKE.stick_stiffness
    back = 30.0 - TORQUE / D  # rad/s to where it sticks
    far = element(u, ud, [0.0, 0.0], h, 0.5 * h, 0.0, [1.0], reach=1.01 * back)
    assert np.array_equal(far.S, r.S)
    near = element(u, ud, [0.0, 0.0], h, 0.5 * h, 0.0, [1.0], reach=0.99 * back)
    expected = tangent_by_differences(element, u, ud, np.zeros(2), h, 0.5 * h, 0.0, [1.0])
    assert np.max(np.abs(near.S - expected)) < 1e-6 * np.max(np.abs(r.S))


def two_pedals(share: float = 1.0, hand_torque: float = 0.0, hand: int | None = 1, side: float = 1.0) -> Element:
    f, g, spin = vectors(3, 3, 1)
    brake = replace(BRAKE, share=share, hand_torque=hand_torque, side=side)
    return Element(brake.record("brake", f, g, spin[0], 0, hand))


def test_the_torque_is_the_share_of_the_pedals_and_that_of_the_hand_brake() -> None:
    element = two_pedals(0.3, 200.0, side=1.25)
    for pedal, hand in ((1.0, 0.0), (0.0, 1.0), (0.5, 0.25), (3.0, 9.0), (-1.0, -1.0)):
        bound = 0.3 * 1.25 * TORQUE * min(max(pedal, 0.0), 1.0) + 200.0 * min(max(hand, 0.0), 1.0)
        for rate in (30.0, -30.0):
            u, ud = signals_of(rate)
            r = element(u, ud, [0.0, 0.0], 0.01, inputs=[pedal, hand])
            assert r.out["torque"] == pytest.approx(-bound * np.sign(rate), rel=1e-14)


def test_bad_hand_brakes_are_refused() -> None:
    f, g, spin = vectors(3, 3, 1)
    with pytest.raises(ValueError, match="hand brake of the brake 'FL' is -2"):
        BRAKE.record("FL", f, g, spin[0], 0, -2)
    element = two_pedals()
    assert "input that does not exist" in (element.check(n_inputs=1) or "")  # of the hand brake
    with pytest.raises(AssertionError, match="sizes"):
        Element(replace(element.element, integer=element.element.integer[:1]))
