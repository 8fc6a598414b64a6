"""The rigid bicycle: published speeds and eigenvalues, from the System and from a model of rolling outside the kernel,
and the run of the library at 4.6 m/s against that model.
"""

import numpy as np
import pytest

import mbs
from benchmarks.references import motions as references
from benchmarks.references.bicycle import AT_FIVE, CAPSIZE, WEAVE, eigenvalues, stable_speeds
from benchmarks.references.cases import exact_of, system_of
from benchmarks.references.rolling_wheels import RollingBicycle
from mbs.scenes import bicycle

PRINTED = 1e-8  # 1/s: of the published eigenvalues
DIFFERENCES = 1e-5  # of the central differences
PLACE = 1e-6


@pytest.fixture(scope="module")
def rolling():
    return RollingBicycle()


def test_the_wheels_roll_without_slip_when_it_runs_straight(rolling):
    q, qd = rolling.state(5.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(rolling.contact_rows(q) @ qd, 0.0, atol=1e-12)
    moved = rolling.forms["front wheel", "centre"]
    np.testing.assert_allclose([g @ qd for g, _ in moved], (5.0, 0.0, 0.0), atol=1e-11)
    assert rolling.spins["front wheel"] @ qd == pytest.approx(5.0 / bicycle.FRONT_RADIUS)
    np.testing.assert_allclose(rolling.accelerations(q, qd), 0.0, atol=1e-8)


def test_it_is_stable_by_itself_between_the_published_speeds(rolling):
    np.testing.assert_allclose(rolling.stable_speeds(), (WEAVE, CAPSIZE), rtol=DIFFERENCES)


def test_the_eigenvalues_at_five_metres_a_second_are_the_published_ones(rolling):
    actual = sorted(np.linalg.eigvals(rolling.matrix(5.0)), key=lambda v: (v.real, -v.imag))
    np.testing.assert_allclose(actual, AT_FIVE, atol=DIFFERENCES)


def test_at_rest_it_falls_over(rolling):
    assert rolling.growth(0.0, oscillating=False) > 1.0


def test_the_system_has_the_published_eigenvalues():
    model = mbs.linearise(mbs.Simulation(mbs.compile(bicycle.build(5.0, 0.0))))
    assert (model.degrees_of_freedom, len(model.A)) == (7, 10)  # seven places, three velocities
    actual = sorted(eigenvalues(5.0), key=lambda v: (v.real, -v.imag))
    np.testing.assert_allclose(actual, AT_FIVE, atol=PRINTED)


@pytest.mark.slow
def test_the_system_has_the_published_speeds():
    weave, capsize = stable_speeds()
    assert weave == pytest.approx(WEAVE, abs=1e-10)
    assert capsize == pytest.approx(CAPSIZE, abs=1e-6)


@pytest.mark.parametrize(("speed", "grows"), [(4.0, True), (5.0, False), (6.8, True)])
def test_in_time_a_small_lean_dies_out_between_the_speeds_only(speed, grows):
    run = mbs.simulate(mbs.compile(bicycle.build(speed, 1e-4)), 12.0, 0.01, every=10)
    early, late = (np.abs(run["lean"][part]).max() for part in (slice(10, 40), slice(-30, None)))
    assert (late > 1.3 * early) == grows
    assert grows or late < 0.1 * early


@pytest.mark.parametrize(
    ("method", "h", "error"),
    [("runge_kutta_8", 0.02, PLACE), ("energy_momentum_4", 0.02, PLACE), ("ali3p", 0.0025, 1e-5)],
)
def test_the_run_at_4_6_metres_a_second_is_that_of_rolling_outside_the_kernel(method, h, error):
    run = mbs.simulate(system_of("bicycle"), 5.0, h, method=method, every=round(0.1 / h))
    values = np.column_stack([run[name] for name in references.BICYCLE])
    expected = exact_of("bicycle")
    assert np.abs(values - expected).max() < error
    assert np.ptp(expected, axis=0).min() > 0.15  # it leans and steers
    # lean rate 0.5 rad/s to the right: it steers to the right, rights itself and has taken up most of the lean's energy
    assert run["lean"].max() > 0.09
    assert run["steer"].min() < -0.13
    assert bicycle.SPEED < run["speed"][-1] < bicycle.SPEED + 0.03


@pytest.mark.parametrize(
    ("method", "kept"), [("runge_kutta_8", 1e-9), ("energy_momentum", 1e-8), ("energy_momentum_4", 1e-5)]
)
def test_rolling_does_no_work(method, kept):
    run = mbs.simulate(system_of("bicycle"), 5.0, 0.01, method=method)
    assert np.ptp(run["energy.total"]) < kept


def test_the_steps_of_the_default_cost_few_iterations_and_lose_energy_at_second_order():
    runs = [mbs.simulate(system_of("bicycle"), 5.0, h) for h in (0.02, 0.01, 0.005)]
    lost = [np.abs(r["energy.total"] - r["energy.total"][0]).max() for r in runs]
    assert np.log2(lost[0] / lost[1]) == pytest.approx(2.0, abs=0.1) == np.log2(lost[1] / lost[2])
    assert lost[1] < 0.01
    # flying, with its gyroscopic forces alone, it needs 3.3
    assert runs[1].report.mean_iterations < 4.0
    assert sum(r.report.halvings for r in runs) == 0
