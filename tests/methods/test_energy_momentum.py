"""Conservation by the energy-momentum step: energy, momenta, rows, and the energy balance of dampers and drives."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from mbs import Settings, Simulation, SimulationError, compile, simulate
from mbs.scenes import bricard, double_four_bar, spatial_chain
from tests.methods.models import MOVED_S, TRIANGLE_MASSES, driven, hinge, swing, triangle

END = 10.0  # s
EXACT_J = 1e-8
ROUND_OFF = 1e-9
STRADDLED_J = 1e-4  # of 40 loops; it was lost altogether
EM = Settings(method="energy_momentum", max_halvings=0)


def spread(trajectory, name="energy.total"):
    return float(np.abs(trajectory[name] - trajectory[name][0]).max())


def carried(x, start, h):
    """The velocity that the step carries, v1 = 2 (x1 - x0)/h - v0."""
    v = [start]
    for d in np.diff(x):
        v.append(2.0 * d / h - v[-1])
    return np.array(v)


def off_rows(simulation):
    """Largest second rate of a row beside what the velocities alone would make of it."""
    s, arrays = simulation.state, simulation.system.arrays
    value = simulation.instance.evaluate(s.q, s.qd)
    J = csr_array((np.array(value["jacobian"]), arrays["row_col"], arrays["row_ptr"]))
    gamma = np.array(value["gamma"])
    return np.abs(J @ s.qdd + gamma).max() / np.abs(gamma).max()


@pytest.fixture(scope="module")
def four_bar():
    return compile(double_four_bar.build())


@pytest.fixture(scope="module")
def loop():
    return compile(bricard.build())


@pytest.mark.parametrize(("scene", "h"), [("four_bar", 0.05), ("four_bar", 0.003), ("loop", 0.1), ("loop", 0.01)])
def test_energy_stays_through_singular_positions_and_with_a_redundant_row(scene, h, request):
    run = simulate(request.getfixturevalue(scene), END, h, settings=EM, estimate_error=False)
    assert spread(run) < EXACT_J
    assert run.report.halvings == 0
    assert np.ptp(run[next(iter(run))]) > 0.1  # it moves


def test_the_velocity_that_is_reported_lies_on_the_constraints_and_has_the_energy(four_bar):
    simulation = Simulation(four_bar, settings=EM)
    start = simulation.sensors["energy.total"]
    a = four_bar.arrays
    row = np.repeat(np.arange(four_bar.nc), np.diff(a["row_ptr"]))
    for _ in range(40):
        simulation.step(0.05)
        state = simulation.state
        J = np.array(simulation.instance.evaluate(state.q, state.qd)["jacobian"], float)
        rate = np.bincount(row, J * state.qd[a["row_col"]], minlength=four_bar.nc)
        assert np.abs(rate * a["row_measure"]).max() < 1e-8  # m/s
        assert abs(simulation.sensors["energy.total"] - start) < EXACT_J


def test_a_free_system_of_springs_keeps_both_momenta_and_its_energy():
    h = 0.02
    run = simulate(compile(triangle()), 5.0, h, settings=EM, estimate_error=False)
    assert spread(run, "energy") < ROUND_OFF
    assert np.ptp(np.hypot(run["a.x"] - run["c.x"], run["a.y"] - run["c.y"])) > 0.05
    momenta = {k: np.zeros(len(run.t)) for k in ("x", "y", "turn")}
    for n, m in TRIANGLE_MASSES.items():
        x, y = run[f"{n}.x"], run[f"{n}.y"]
        vx, vy = (carried(run[f"{n}.{c}"], run[f"{n}.v{c}"][0], h) for c in "xy")
        momenta["x"] += m * vx
        momenta["y"] += m * vy
        momenta["turn"] += m * (x * vy - y * vx)
    for values in momenta.values():
        np.testing.assert_allclose(values, values[0], atol=ROUND_OFF)
    momentum = sum(m * run[f"{n}.vx"] for n, m in TRIANGLE_MASSES.items())
    assert np.abs(momentum - momentum[0]).max() < 1e4 * h**4  # it is scaled to the energy


@pytest.mark.parametrize(("damping", "stops"), [(0.0, True), (3.0, True), (3.0, False), (80.0, False)])
def test_the_energy_lost_is_exactly_the_work_of_the_damper(damping, stops):
    h = 0.02
    run = simulate(compile(swing(damping, stops)), 3.0, h, settings=EM, estimate_error=False)
    length = run["length"]
    taken = np.concatenate([[0.0], np.cumsum(damping * np.diff(length) ** 2 / h)])
    np.testing.assert_allclose(run["energy"] + taken, run["energy"][0], atol=EXACT_J)
    assert np.ptp(length) > 0.05
    if stops and damping < 10.0:
        assert length.min() < 1.1 or length.max() > 1.6


def test_an_angle_row_does_no_work_over_several_turns():
    damping, h = 0.2, 0.01
    run = simulate(compile(hinge(damping)), 4.0, h, settings=EM)
    taken = np.concatenate([[0.0], np.cumsum(damping * np.diff(run["angle"]) ** 2 / h)])
    np.testing.assert_allclose(run["energy"] + taken, run["energy"][0], atol=EXACT_J)
    assert np.ptp(run["angle"]) > np.pi


def test_a_drive_gives_energy_only_while_it_moves():
    system = compile(driven())
    run = simulate(system, 4.0, 0.01, settings=EM)
    moved = run.t > MOVED_S + 0.005
    assert np.abs(run["angle"][moved] - 1.0).max() < 1e-10
    assert abs(run["energy"][moved][0] - run["energy"][0]) > 1.0
    np.testing.assert_allclose(run["energy"][moved], run["energy"][moved][0], atol=ROUND_OFF)
    other = simulate(system, 4.0, 0.001)
    assert abs(run["bob.x"][-1] - other["bob.x"][-1]) < 0.02


def test_a_step_that_does_not_converge_is_made_in_halves_and_keeps_the_energy(four_bar):
    few = Settings(method="energy_momentum", max_iterations=4)
    run = simulate(four_bar, END, 0.1, settings=few, estimate_error=False)
    assert run.report.halvings > 0
    assert run.report.failures == 0
    assert spread(run) < 10.0 * EXACT_J


def test_a_run_that_fails_unseen_leaves_the_last_good_state_complete(four_bar):
    """Steps that nobody looks at leave out what only a reader needs; it is there when a later one fails."""
    few = Settings(method="energy_momentum", max_iterations=4, max_halvings=0)
    unseen, seen = Simulation(four_bar, settings=few), Simulation(four_bar, settings=few)
    with pytest.raises(SimulationError, match="did not converge"):
        unseen.run(END, 0.1, every=100)
    with pytest.raises(SimulationError, match="did not converge"):
        seen.run(END, 0.1)
    assert unseen.time == seen.time > 0.3
    a, b = unseen.state, seen.state
    assert np.array_equal(a.q, b.q)
    np.testing.assert_allclose(a.qd, b.qd, atol=1e-8)
    for simulation in (unseen, seen):  # accelerations differ by their error, which is of the first order in the step
        assert off_rows(simulation) < 1e-4
    assert np.abs(a.qdd - b.qdd).max() < 0.2 * np.abs(b.qdd).max()


@pytest.mark.parametrize(("method", "h"), [("energy_momentum", 0.00025), ("energy_momentum_4", 0.002)])
def test_small_steps_cross_singular_positions_of_many_loops(method, h):
    """Forty rows lose their levers at once; the step that straddles the position has them with either sign."""
    run = simulate(
        compile(double_four_bar.build(40)),
        5.5,
        h,
        settings=Settings(method=method, max_halvings=0),
        every=round(0.1 / h),
    )
    assert spread(run) < STRADDLED_J
    assert np.ptp(run["B0.position.x"]) > 1.0


@pytest.mark.parametrize("scene", ["four_bar", "loop"])
def test_a_step_at_a_small_h_has_one_factorization_and_hardly_more_than_one_iteration(scene, request):
    report = simulate(request.getfixturevalue(scene), 2.0, 0.001, settings=EM).report
    assert report.factorizations < 1.01 * report.steps
    assert report.mean_iterations < 1.5


def test_a_guess_of_the_order_that_fits_saves_iterations_where_the_motion_turns_within_a_few_steps():
    """Four past steps mislead the chain of ten links at 0.05 s, where the iteration had not converged."""
    run = simulate(compile(spatial_chain.build()), END, 0.05, settings=EM, estimate_error=False)
    assert spread(run) < EXACT_J
    assert run.report.mean_iterations < 7.0
