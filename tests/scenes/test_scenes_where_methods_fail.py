"""The scenes of the charts against closed forms, published values and minimum-norm accelerations."""

import numpy as np
import pytest

from benchmarks.baselines.run import METHODS, run
from benchmarks.references import motions as references
from mbs import Settings, compile, simulate
from mbs.scenes import (
    bricard,
    cart_pole,
    double_four_bar,
    flyball,
    pendulum,
    slider_crank,
    spatial_chain,
    spatial_slider_crank,
    squeezer,
)

TIGHT = Settings(tolerance_r=1e-13, tolerance_phi=1e-13)
# s: position of F, m; angle of OF at 0.03 s from the published end point of the test set
SQUEEZER = {0.01: (-0.003891, 0.005819), 0.02: (-0.002274, 0.006620), 0.03: (-0.006963, -0.000718)}
SQUEEZER_ANGLE = 15.810771195  # rad, at 0.03 s
PRINTED = 1.0e-6  # m, what the published positions show


def places(trajectory, names):
    return np.column_stack([trajectory[name] for name in names])


def largest_error(scene, names, exact, end, h, interval):
    trajectory = simulate(compile(scene), end, h, settings=TIGHT, every=round(interval / h))
    expected = exact(trajectory.t)
    assert np.ptp(expected, axis=0).max() > 0.1 * np.abs(expected).max()  # it moves
    return float(np.linalg.norm(places(trajectory, names) - expected, axis=1).max())


@pytest.mark.slow
def test_the_squeezer_follows_the_published_motion():
    system = compile(squeezer.build())
    names = ("F.position.x", "F.position.y")
    t = np.array([0.0, *SQUEEZER])
    exact = references.minimum_norm(system, names, t)
    np.testing.assert_allclose(exact[1:], list(SQUEEZER.values()), atol=PRINTED)
    arm = np.array([np.cos(SQUEEZER_ANGLE), np.sin(SQUEEZER_ANGLE)])
    np.testing.assert_allclose(exact[-1], 0.007 * arm, atol=1e-11)
    steps = np.array([4e-5, 2e-5, 1e-5])
    errors = [np.linalg.norm(places(simulate(system, 0.03, h, settings=TIGHT), names)[-1] - exact[-1]) for h in steps]
    assert errors[-1] < 3e-6
    assert 1.8 < np.polyfit(np.log(steps), np.log(errors), 1)[0] < 2.2


def test_the_squeezer_s_start_closes_as_published():
    system = compile(squeezer.build())
    assert (system.report["degrees_of_freedom"], system.report["rank"]) == (1, system.nc)
    first = simulate(system, 1e-5, 1e-5)
    assert first["F.position.x"][0] == pytest.approx(0.007 * np.cos(squeezer.BETA), abs=1e-15)
    assert first["energy.total"][0] == pytest.approx(
        0.5 * squeezer.STIFFNESS * (np.hypot(*_spring()) - squeezer.FREE_LENGTH) ** 2, rel=1e-12
    )


def _spring():
    """Vector from C to D at the start."""
    c, s = np.cos(squeezer.GAMMA), np.sin(squeezer.GAMMA)
    B, C = squeezer.B, squeezer.C
    return B[0] + 0.018 * s + 0.020 * c - C[0], B[1] - 0.018 * c + 0.020 * s - C[1]


@pytest.mark.parametrize(("h", "tolerance"), [(0.01, 3e-3), (0.001, 5e-5)])
def test_the_flyball_slider_reaches_its_published_heights(h, tolerance):
    t = simulate(compile(flyball.build()), 10.0, h)
    z = t["slider.position.z"]
    np.testing.assert_allclose([z.min(), z.max(), z[-1]], (0.49992, 0.74356, 0.619623), atol=tolerance)
    assert t.t[z.argmax()] == pytest.approx(0.52, abs=0.015)
    assert t["shaft.rate"][0] == pytest.approx(2.0 * np.pi)
    assert t["shaft.rate"].min() == pytest.approx(5.10, abs=0.01)  # rad/s, at full opening
    energy = t["energy.total"]
    assert (energy - energy[0]).max() < 2e-4 * energy[0]  # the dampers only take, up to the error of the rule


def test_the_equal_arms_stay_on_their_branch_through_every_singular_position():
    steps = np.array([0.002, 0.001, 0.0005])
    names = ("A.position.x", "A.position.y")
    errors = [largest_error(slider_crank.build(), names, references.equal_arms, 3.0, h, 0.01) for h in steps]
    assert errors[-1] < 1e-4
    assert 1.7 < np.polyfit(np.log(steps), np.log(errors), 1)[0] < 2.4
    t = simulate(compile(slider_crank.build()), 10.0, 0.001)
    crossings = np.flatnonzero(np.diff(np.sign(t["A.position.x"])))
    assert len(crossings) > 5
    np.testing.assert_allclose(t["slider.position.x"], 2.0 * t["A.position.x"], atol=1e-9)


@pytest.mark.slow
def test_the_spatial_slider_crank_follows_its_reduction_to_one_angle():
    names = ("slider.position.x",)
    steps = np.array([0.002, 0.001, 0.0005])
    errors = [largest_error(spatial_slider_crank.build(), names, references.spatial_crank, 0.5, h, 0.01) for h in steps]
    assert errors[-1] < 1e-5
    assert 1.8 < np.polyfit(np.log(steps), np.log(errors), 1)[0] < 2.5
    start = simulate(compile(spatial_slider_crank.build()), 0.001, 0.001)
    assert start["slider.position.x"][0] == pytest.approx(0.2, abs=1e-12)
    assert start["slider.velocity.x"][0] == pytest.approx(0.24, abs=1e-9)


def test_the_light_cart_swings_round_as_momentum_and_energy_ask():
    heavy, end = 0.5, 3.0  # kg: a cart that a step of a millisecond can follow
    names = ("bob.position.x", "bob.position.y")
    error = largest_error(cart_pole.build(heavy), names, lambda t: references.light_cart(t, heavy), end, 0.001, 0.01)
    assert error < 1e-4
    # the benchmark's cart of a millionth, up to the first spike
    error = largest_error(cart_pole.build(), names, references.light_cart, 0.45, 1e-4, 0.01)
    assert error < 1e-8
    assert np.sqrt(2.0 * cart_pole.GRAVITY * cart_pole.BOB / cart_pole.CART) == pytest.approx(4429.0, abs=1.0)


@pytest.mark.slow
def test_the_chain_follows_the_motion_of_minimum_norm_accelerations():
    system = compile(spatial_chain.build(4))
    names = tuple(f"tip.position.{c}" for c in "xyz")
    exact = references.minimum_norm(system, names, np.linspace(0.0, 2.0, 21))
    assert np.ptp(exact, axis=0).min() > 0.1  # a spatial motion
    steps = np.array([0.01, 0.005, 0.0025])
    errors = [
        np.linalg.norm(
            places(simulate(system, 2.0, h, settings=TIGHT, every=round(0.1 / h)), names) - exact, axis=1
        ).max()
        for h in steps
    ]
    assert errors[-1] < 1e-3
    assert 1.8 < np.polyfit(np.log(steps), np.log(errors), 1)[0] < 2.2
    assert compile(spatial_chain.build()).report["degrees_of_freedom"] == 10


def test_the_pendulum_keeps_its_energy_and_rod_over_a_thousand_seconds():
    t = simulate(compile(pendulum.build()), 1000.0, 0.01, every=10, estimate_error=False)
    length = np.hypot(t["bob.position.x"], t["bob.position.y"])
    np.testing.assert_allclose(length, 1.0, atol=1e-9)
    energy = t["energy.total"]
    assert np.abs(energy - energy[0]).max() < 0.5  # J of 9.81: no step adds any
    assert energy.max() - energy[0] < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_classical_methods_follow_the_pendulum_which_is_never_singular(method):
    names = ("bob.position.x", "bob.position.y")
    # before the dead point of the coordinate that the velocity transformation takes
    actual = run(compile(pendulum.build()), 0.3, 0.001, method, names)
    assert (actual.status, actual.reason) == ("finished", "")
    tolerance = 1e-2 if method == "penalty" else 1e-6
    np.testing.assert_allclose(actual.positions, references.pendulum(actual.t), atol=tolerance)


@pytest.mark.slow
def test_classical_methods_fail_as_the_theory_predicts_and_name_the_rank():
    four_bar, names = compile(double_four_bar.build()), ("B0.position.x", "B0.position.y")
    fixed = run(four_bar, 1.0, 0.001, "velocity transformation", names)
    assert fixed.status == "refused"
    assert fixed.stopped_at == pytest.approx(0.7144, abs=2e-3)  # s, the first horizontal position
    loop = compile(bricard.build())
    redundant = run(loop, 0.1, 0.01, "index-1 Lagrange, Baumgarte", ("P3.position.x",))
    assert (redundant.status, redundant.stopped_at) == ("refused", 0.0)
    assert "singular" in redundant.reason
    passes = run(loop, 1.0, 0.01, "index-1 minimum norm, Baumgarte", ("P3.position.x",))
    assert passes.status == "finished"
    assert passes.positions[-1, 0] == pytest.approx(0.274481, abs=1e-4)  # m, published
