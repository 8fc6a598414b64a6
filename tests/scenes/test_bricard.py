"""Bricard's loop (IFToMM benchmark A04): one redundant constraint at every position."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mbs import Settings, SimulationError, compile, simulate
from mbs.scenes import bricard

REFERENCE = Path(__file__).parents[1] / "data" / "reference" / "bricard.csv"
PERIOD = 5.0  # s
CAP = 20  # Newton iterations
ONE_STEP = Settings(max_iterations=CAP, max_halvings=0)
SOFTER = 1e-6  # eps_rel; (16) turns alpha times the round-off of Phi into multipliers, and so into the residual


@pytest.fixture(scope="module")
def system():
    return compile(bricard.build())


def place(trajectory):
    return np.column_stack([trajectory[f"P3.position.{c}"] for c in "xyz"])


def test_the_redundant_row_is_there_and_the_loop_swings_back_after_five_seconds(system):
    assert (system.report["rows"], system.report["rank"], system.report["degrees_of_freedom"]) == (24, 23, 1)
    p = place(simulate(system, PERIOD, 0.001))
    np.testing.assert_allclose(p[1000], (0.274481, -0.886708, -0.462330), atol=1e-5)
    np.testing.assert_allclose(p[-1], p[0], atol=1e-3)
    np.testing.assert_allclose([p.min(axis=0), p.max(axis=0)], [(-1, -1, -0.5), (1, -0.866025, 0)], atol=2e-4)


def test_it_follows_an_independent_reference_and_converges_with_the_square_of_the_step(system):
    """Its origin stands in the first line of the file."""
    table = np.loadtxt(REFERENCE, delimiter=",", skiprows=2)
    errors = []
    for h in (0.004, 0.001):
        run = simulate(system, 10.0, h, settings=Settings(eps_rel=1e-7), every=round((table[1, 0] - table[0, 0]) / h))
        np.testing.assert_allclose(run.t, table[:, 0], rtol=0, atol=1e-9)
        errors.append(np.linalg.norm(place(run) - table[:, 1:], axis=1).max())
    assert errors[1] < 1e-5
    assert 1.8 < np.log(errors[0] / errors[1]) / np.log(4.0) < 2.5


@pytest.mark.parametrize("h", [0.1, 0.05, 0.01, 0.005])
def test_the_linearised_update_needs_one_to_three_iterations(system, h):
    report = simulate(system, 10.0, h, settings=ONE_STEP, estimate_error=False).report
    assert report.max_iterations <= 3
    assert report.mean_iterations < (3.0 if h > 0.01 else 2.05)


@pytest.mark.parametrize("h", [0.1, 0.05])
def test_the_paper_s_update_hits_the_cap_and_with_a_softer_penalty_takes_more_iterations(system, h):
    linearised = replace(ONE_STEP, predictor="acceleration")
    paper = replace(linearised, update="paper")
    with pytest.raises(SimulationError, match="did not converge"):
        simulate(system, 10.0, h, settings=paper, estimate_error=False)
    by_paper, fewer = (
        simulate(system, 10.0, h, settings=replace(s, eps_rel=SOFTER), estimate_error=False)
        for s in (paper, linearised)
    )
    assert by_paper.report.mean_iterations > 1.05 * fewer.report.mean_iterations
    # the same converged step, by two roads
    np.testing.assert_allclose(place(by_paper), place(fewer), atol=1e-5)


def test_positions_do_not_depend_on_a_fixed_penalty_over_decades(system):
    expected = place(simulate(system, 2.0, 0.01))
    for k in range(8, 15):
        run = simulate(system, 2.0, 0.01, settings=Settings(alpha=10.0**k))
        np.testing.assert_allclose(place(run), expected, atol=1e-6)
    assert np.ptp(expected, axis=0).min() > 0.1


def test_a_step_too_large_to_converge_is_made_in_halves(system):
    """Three iterations are enough at 0.1 s, not at 0.2 s."""
    h, few = 0.2, 3
    with pytest.raises(SimulationError, match="did not converge"):
        simulate(system, 12.0, h, settings=Settings(max_iterations=few, max_halvings=0), estimate_error=False)
    halved = simulate(system, 12.0, h, settings=Settings(max_iterations=few), estimate_error=False)
    assert halved.report.halvings > 0
    assert halved.report.failures == 0
    assert halved.report.steps == len(halved.t) - 1
    assert halved.report.violation < Settings().tolerance_phi
    whole = simulate(system, 12.0, h, settings=Settings(max_halvings=0), estimate_error=False)
    assert np.ptp(whole["energy.total"]) > np.ptp(halved["energy.total"])  # half steps are more accurate
