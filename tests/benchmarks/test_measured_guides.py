"""Motions from accelerometers: from known signals, and as guides of the kerb test."""

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from benchmarks.paper import measured_guides as guides
from mbs import Settings, compile, simulate
from mbs.scenes import kerb_test

T = np.arange(0.0, kerb_test.DURATION + 0.5 * guides.RATE, guides.RATE)
WAY = float(kerb_test.distance(kerb_test.DURATION))


def signals(pitch_rate: float = 0.0) -> guides.Signals:
    """Of a level chassis that goes its way and, if asked for, pitches between 6 and 9 s."""
    along = np.gradient(kerb_test.speed(T), T)
    turning = pitch_rate * np.pi * np.sin(2.0 * np.pi * (T - 6.0) / 3.0) * (T > 6.0) * (T < 9.0)
    turn = np.stack([0.0 * T, turning, 0.0 * T], axis=1)
    force = np.array([0.0, 0.0, guides.GRAVITY]) + along[:, np.newaxis] * np.array([1.0, 0.0, 0.0])
    return guides.Signals(T, np.stack([force + np.cross(turn, place) for place in guides._ARMS], axis=1))


def test_signals_without_faults_return_the_motion() -> None:
    actual = guides.motion(signals(0.05), WAY)
    assert np.max(np.abs(actual.way - kerb_test.distance(T))) < 1e-3
    assert np.max(np.abs(actual.guide(T) - actual.way)) < 1e-3


def test_offset_and_drift_are_taken_out_and_a_sign_is_seen() -> None:
    original = signals()
    faulty = guides.Signals(T, original.force + 0.3 - 0.03 * T[:, np.newaxis, np.newaxis])
    result = guides.motion(faulty, WAY)
    assert np.sqrt(np.mean((result.way - kerb_test.distance(T)) ** 2)) < 0.05
    plain = cumulative_trapezoid(cumulative_trapezoid(faulty.force[:, 0, 0], T, initial=0.0), T, initial=0.0)
    assert np.abs(plain - kerb_test.distance(T)).max() > 5.0  # what drift would do
    turned = guides.motion(guides.Signals(T, -original.force), -WAY)
    assert turned.way[-1] == pytest.approx(-WAY, rel=1e-9)


def test_the_weight_of_a_pitched_chassis_is_in_its_signals() -> None:
    """Nose down by 0.1 rad at rest: gravity along the chassis, felt as an acceleration to the rear."""
    n = 1001
    names = {f"accelerometer_{place}.a{c}": np.zeros(n) for place in guides.POSITIONS for c in "xyz"}
    values = names | {"chassis.pitch": np.full(n, 0.1), "chassis.roll": np.full(n, 0.0)}
    still = type("Still", (), {"t": np.arange(n) * guides.FINE_STEP, "__getitem__": lambda self, name: values[name]})()
    seen = guides.accelerometer_signals(still, noise=0.0, offset=0.0, drift=0.0)
    np.testing.assert_allclose(
        seen.force[100, 0], guides.GRAVITY * np.array([-np.sin(0.1), 0.0, np.cos(0.1)]), atol=1e-9
    )


def test_moments_that_come_later_are_found_so() -> None:
    wave = np.exp(-(((T - 8.0) / 0.1) ** 2))[:, np.newaxis]
    assert guides.best_shift(wave, np.roll(wave, 7, axis=0)) == (7, pytest.approx(0.0, abs=1e-9))
    assert guides.best_shift(wave, np.roll(wave, -5, axis=0))[0] == -5


@pytest.mark.proof
def test_the_kerb_test_runs_on_measured_guides_and_takes_more_iterations() -> None:
    """With the signs of the signals: the car gets where it was, and the moments are those of the smooth test."""
    true = guides.simulate_smooth()
    plain = simulate(compile(kerb_test.build()), kerb_test.DURATION, kerb_test.STEP)
    clean, noisy = (
        guides.row_of(name, true, plain, [1]) for name in ("no noise, offset or drift", "and noise of 3 m/s²")
    )
    assert clean["way, m"] < 0.03
    assert clean["peaks, %"] < 3.0
    assert abs(clean["later, s"]) <= 0.02
    assert clean["iterations"] < 1.1 * guides.cost(plain)["iterations"]
    assert 1.5 < noisy["iterations"] / clean["iterations"] < 3.0
    noise = guides.accelerometer_signals(true, seed=1)
    whole = guides.simulate_guided(guides.motion(noise, float(np.ptp(true["chassis.x"]))), Settings(max_halvings=0))
    assert guides.cost(whole)["most"] <= 10  # a divided step counts the iterations of all its parts
    assert noisy["way, m"] < 0.3
