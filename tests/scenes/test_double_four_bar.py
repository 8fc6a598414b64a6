"""The double four-bar (paper, section 3.1): ten singular positions in 10 s, against its exact reduction."""

import numpy as np
import pytest

from benchmarks.references.motions import four_bar as exact
from mbs import Settings, SimulationError, compile, simulate
from mbs.scenes import double_four_bar

END = 10.0  # s
CROSSINGS = (0.7144, 1.2282, 2.6568, 3.1707, 4.5994, 5.1132, 6.5419, 7.0557, 8.4844, 8.9982)  # s, exact
ENERGY_BOUND = {0.01: 0.10, 0.03: 1.0, 0.05: 3.2}  # J at h in s; the paper's Table 1: 0.21, 0.83, 9.03
# at a singular position an open constraint of epsilon lets the mechanism stray by sqrt(epsilon)
TIGHT = Settings(tolerance_r=1e-12, tolerance_phi=1e-12)
# (16) turns the round-off of Phi into multipliers, which bounds the residual it can reach
PAPER_UPDATE = Settings(update="paper", tolerance_r=1e-7)


def tip(trajectory):
    return np.column_stack([trajectory["B0.position.x"], trajectory["B0.position.y"]])


def position_error(windows, t_end, h, settings=None):
    trajectory = simulate(compile(double_four_bar.build(windows)), t_end, h, settings=settings, estimate_error=False)
    return float(np.linalg.norm(tip(trajectory) - exact(windows, trajectory.t), axis=1).max())


def recorded(system, h, settings):
    """A run to the end or to the step that is refused."""
    try:
        return simulate(system, END, h, settings=settings, estimate_error=False)
    except SimulationError as error:
        return error.trajectory


def energy_deviation(trajectory):
    energy = trajectory["energy.total"]
    return float(np.abs(energy - energy[0]).max())


def crossing_times(trajectory):
    """Times at which B0 is level with its pivot, by linear interpolation."""
    t, y = trajectory.t, trajectory["B0.position.y"]
    k = np.flatnonzero(y[1:] * y[:-1] < 0.0)
    return t[k] - y[k] * (t[k + 1] - t[k]) / (y[k + 1] - y[k])


def test_the_exact_reduction_is_the_known_one():
    np.testing.assert_allclose(exact(2, np.array([0.0, END]))[-1], (0.3284581, 0.9445185), atol=1e-7)


@pytest.mark.parametrize("settings", [Settings(), PAPER_UPDATE], ids=["linearised", "paper's update"])
@pytest.mark.parametrize("h", ENERGY_BOUND)
def test_energy_stays_within_the_paper_s_and_all_ten_singular_positions_are_crossed(h, settings):
    trajectory = simulate(compile(double_four_bar.build()), END, h, settings=settings, estimate_error=False)
    assert energy_deviation(trajectory) < ENERGY_BOUND[h]
    assert trajectory["energy.total"][0] == pytest.approx(35.835, abs=1e-9)
    times = crossing_times(trajectory)
    assert len(times) == len(CROSSINGS)
    # before the phase drifts
    np.testing.assert_allclose(times[:2], CROSSINGS[:2], atol=max(1e-3, 6.0 * h**2))
    assert trajectory.report.halvings == 0
    assert trajectory.report.violation < settings.tolerance_phi


def test_two_newton_iterations_a_step_at_ten_milliseconds_and_one_at_one():
    system = compile(double_four_bar.build())
    coarse, tight, fine = (
        simulate(system, END, h, settings=s).report for h, s in ((0.01, None), (0.01, TIGHT), (0.001, None))
    )
    assert 1.0 <= coarse.mean_iterations <= tight.mean_iterations < 2.1
    assert tight.max_iterations <= 4
    assert fine.mean_iterations < 1.05
    for report in (coarse, tight, fine):
        assert report.factorizations <= report.iterations + 4  # the projections use the last tangent of the step


@pytest.mark.parametrize("windows", [1, 40])
def test_the_tip_follows_the_exact_reduction_with_order_two(windows):
    """Up to 2 s, two crossings, before the error of the phase grows by itself."""
    steps = np.array([0.02, 0.01, 0.005])
    errors = np.array([position_error(windows, 2.0, h, TIGHT) for h in steps])
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert 1.9 < order < 2.1
    assert errors[1] < 5e-3


def test_ten_seconds_at_one_millisecond():
    """Long after the first crossings; the bound is the error of the rule, not of the singular passages."""
    assert position_error(2, END, 0.001, TIGHT) < 3e-4


@pytest.mark.slow
def test_singular_passages_at_small_steps_need_a_violation_well_below_the_regularisation():
    """What is left of the violation, times alpha, is an error of the multipliers where a row loses its lever."""
    steps = np.random.default_rng(5).uniform(0.0006, 0.003, 12)
    loose, default = (
        np.array([position_error(2, END, h, s) / h**2 for h in steps])
        for s in (Settings(eps_rel=1e-9, tolerance_phi=1e-10), Settings())
    )
    assert default.max() < 900.0  # the method's own error, 450 h^2 at large steps
    assert loose.max() > 3.0 * default.max()


@pytest.mark.filterwarnings("ignore::mbs.BranchWarning")  # with that energy it jumps branches, and says so
@pytest.mark.parametrize("windows", [1, 2])
def test_without_projections_the_velocities_run_away(windows):
    system, h = compile(double_four_bar.build(windows)), 0.01
    projected = simulate(system, END, h)
    bare = recorded(system, h, Settings(project=False))
    assert energy_deviation(projected) < 0.1
    assert energy_deviation(bare) > 1e3
    assert projected.report.velocity_violation < 1e-10


def test_the_result_does_not_depend_on_the_penalty_over_decades():
    system, h = compile(double_four_bar.build()), 0.01
    runs = [simulate(system, END, h, settings=Settings(eps_rel=10.0**-k), estimate_error=False) for k in range(6, 14)]
    expected = energy_deviation(
        simulate(system, END, h, settings=Settings(eps_rel=1e-9, tolerance_phi=1e-14), estimate_error=False)
    )
    for run in runs:
        assert energy_deviation(run) == pytest.approx(expected, rel=0.02)
        assert run.report.halvings == 0
    # before the first singular position, to more digits
    early = [tip(r)[: int(0.6 / h)] for r in runs]
    for part in early[1:]:
        np.testing.assert_allclose(part, early[0], atol=3e-6)  # 1e-13 is where round-off begins to show


def test_the_increment_form_has_no_floor_of_round_off_at_small_steps():
    """The paper's form loses its digits below about 1e-5 s: the tangent's condition grows as 1/h^3."""
    trajectory = simulate(compile(double_four_bar.build()), 0.2, 1e-6, every=1000)
    error = np.linalg.norm(tip(trajectory) - exact(2, trajectory.t), axis=1).max()
    assert error < 1e-9
    assert energy_deviation(trajectory) < 1e-7 * 35.835


def test_many_windows_take_the_iterations_of_two():
    h, windows = 0.01, 100
    long, short = (
        simulate(compile(double_four_bar.build(n)), 0.3, h, settings=Settings(tolerance_phi=1e-9, tolerance_r=1e-9))
        for n in (windows, 2)
    )
    assert long.report.iterations <= short.report.iterations + 5
    assert np.linalg.norm(tip(long) - exact(windows, long.t), axis=1).max() < 1e-3
    assert np.ptp(tip(long)[:, 0]) > 0.2  # it moves
