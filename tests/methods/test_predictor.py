"""Start values of ALi3-P from past steps: fewer iterations where the motion is smooth, none more elsewhere."""

import numpy as np
import pytest

from mbs import Settings, Simulation, compile, simulate
from mbs.scenes import bricard, double_four_bar, pendulum, spatial_chain

PAPER = Settings(predictor="acceleration")
SAME_MOTION = 1e-3  # m of 2 m: both are within the tolerance of the same step
LONG = 60.0  # s: with dependent rows whole extrapolations of the multipliers blow up within ten


@pytest.fixture(scope="module")
def loop():
    return compile(bricard.build())


def both(system, t_end, h):
    runs = [simulate(system, t_end, h, settings=s, progress=False, estimate_error=False) for s in (Settings(), PAPER)]
    return [np.column_stack([t[n] for n in t if ".position." in n]) for t in runs], [t.report for t in runs]


@pytest.mark.parametrize(
    ("scene", "h", "share"),
    [(double_four_bar, 0.01, 0.7), (bricard, 0.005, 0.9), (spatial_chain, 0.005, 0.75)],
)
def test_a_smooth_motion_needs_fewer_iterations_and_is_the_same(scene, h, share):
    (places, expected), (report, paper) = both(compile(scene.build()), 2.0, h)
    assert report.iterations < share * paper.iterations
    np.testing.assert_allclose(places, expected, atol=SAME_MOTION)


def test_large_steps_need_hardly_more_iterations_and_no_halves(loop):
    _, (report, paper) = both(loop, LONG, 0.1)
    assert report.halvings == paper.halvings == 0
    assert report.iterations < 1.1 * paper.iterations


def test_steps_that_past_ones_do_not_foretell_take_the_start_value_of_the_paper():
    """Eight steps a second of loops that pass a singular position: a parabola through the past costs a tenth more."""
    _, (report, paper) = both(compile(double_four_bar.build()), 4.0, 0.125)
    assert report.iterations <= 1.02 * paper.iterations


def test_energy_momentum_foretells_a_smooth_motion_to_one_iteration_a_step():
    """From two, three and four past steps."""
    settings = Settings(method="energy_momentum")
    report = simulate(compile(pendulum.build()), 2.0, 0.01, settings=settings, progress=False).report
    assert report.iterations < 1.1 * report.steps


@pytest.mark.slow
def test_a_thousand_loops_pass_a_singular_position_in_small_steps():
    """Multipliers of rows that lose their lever are all round-off; with 0.8 of their change it stops at 0.72 s."""
    report = simulate(compile(double_four_bar.build(1000)), 1.0, 0.002, progress=False).report
    assert report.halvings == 0
    assert report.mean_iterations < 1.5


def test_multipliers_of_dependent_rows_stay_bounded(loop):
    simulation = Simulation(loop)
    largest = []
    for _ in range(6):
        simulation.step(0.02, n=round(LONG / 6 / 0.02))
        largest.append(np.abs(simulation.state.lam).max())
    assert max(largest[1:]) < 5.0 * largest[0]


def test_steps_of_other_sizes_do_not_mislead_it(loop):
    """A parabola through steps of a microsecond says nothing about one of 10 ms."""
    simulation = Simulation(loop)
    for h in (1e-6, 1e-2, 1e-5, 2e-2, 1e-6, 1e-2):
        simulation.step(h, n=6)
    assert simulation.report.max_iterations <= 3
    assert simulation.report.halvings == 0


def test_a_step_ten_times_as_long_leaves_the_past_aside():
    """A parabola through steps of 10 ms, extrapolated over 100 ms, costs a swinging chain 13 iterations for 5."""
    simulation = Simulation(compile(spatial_chain.build()))
    for _ in range(20):
        simulation.step(0.01, n=8)
        simulation.step(0.1)
    assert simulation.report.max_iterations <= 6
    assert simulation.report.halvings == 0
