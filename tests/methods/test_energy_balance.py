"""The energy balance of a run: energy, work, kinetic energy, predictor differences, and what a refusal leaves."""

from ctypes import byref
from dataclasses import asdict

import pytest
from scipy.interpolate import PPoly

from benchmarks.methods.honesty_scenes import printed_model
from benchmarks.references.cases import system_of
from mbs import AccuracyWarning, Model, Settings, Simulation, SimulationError, compile, simulate
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.kernel.header.steps import Balance
from mbs.kernel.header.structures import ReportFields
from mbs.scenes import cart_pole
from mbs.settings.settings import METHODS
from tests.fmu.scenes import driven_crank
from tests.simulation.scenes import pendulum, pendulum_model

H = 1e-4
UNCHECKED = {"progress": False, "estimate_error": False}


@pytest.mark.parametrize("method", ["ali3p", "runge_kutta_8"])
def test_work_is_that_of_the_motor(method):
    run = simulate(printed_model(), 0.5, H, {"torque": 4.0}, method=method, **UNCHECKED)
    assert run.report.work == pytest.approx(4.0 * run["crank.angle"][-1], rel=0.01)
    assert run.report.energy == pytest.approx(run.report.work, rel=0.02)  # it started from rest, with its mass level


@pytest.mark.parametrize("method", ["ali3p", "runge_kutta_8"])
def test_the_largest_kinetic_energy_is_that_of_the_sensor(method):
    run = simulate(system_of("double_four_bar"), 2.0, 0.005, method=method, **UNCHECKED)
    assert run.report.kinetic_peak == pytest.approx(run["energy.kinetic"].max(), rel=1e-4)
    assert run.report.energy == pytest.approx(run["energy.total"][-1], rel=1e-6)
    assert run.report.work < 0.02 * run.report.kinetic_peak  # nothing but gravity works


def test_dampers_work():
    run = simulate(pendulum(damped=True), 5.0, 0.002, **UNCHECKED)
    lost = run["energy"][0] - run["energy"][-1]
    assert lost > 1.0
    assert run.report.work == pytest.approx(lost, rel=0.02)


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum", "radau_5", "runge_kutta_8", "semi_recursive"])
def test_predictors_miss_by_half_as_much_at_half_the_step(method):
    system = system_of("spatial_chain")
    paths = [simulate(system, 1.0, h, method=method, **UNCHECKED).report for h in (0.002, 0.001)]
    shares = [r.predictor_path / r.speed_peak for r in paths]
    assert shares[0] / shares[1] == pytest.approx(2.0, rel=0.05)
    assert paths[0].velocity_path == pytest.approx(paths[1].velocity_path, rel=0.05)


def test_a_body_that_turns_turns_by_its_angle():
    """Free and even: its velocity has turned by as many radians as it has."""
    m = Model("wheel", dimension=2, gravity=(0.0, 0.0))
    wheel = m.body("wheel", mass=1.0, com=(0.0, 0.0), inertia=0.1)
    m.initial_velocity(wheel, linear=(0.0, 0.0), angular=3.0)
    report = simulate(compile(m), 5.0, 1e-3, **UNCHECKED).report
    assert report.velocity_path / report.speed_peak == pytest.approx(15.0, rel=1e-3)


def test_the_balance_in_python_is_that_of_the_kernel():
    simulation = Simulation(system_of("pendulum"))
    simulation.step(0.05, 100)
    numbers = ReportFields(**asdict(simulation.report))
    balance = simulation.instance._library.ali3_energy_balance(byref(numbers))
    assert balance == pytest.approx(simulation.report.energy_balance, rel=1e-15)
    assert simulation.report.energy_balance > 1e-3


def test_what_the_tolerance_leaves_open_is_no_violation_of_the_balance():
    """Beside a pendulum, of which 1.6 J are lost in long steps, 1000 t hang, whose weight does 9.8 J over 1e-6 m."""
    results = []
    for weight in (1e-3, 1e6):
        m = pendulum_model()
        beside = m.body("weight", mass=weight, com=(9.0, -1.0), inertia=weight)
        m.revolute("hook", m.ground, beside, point=(9.0, 0.0))
        report = simulate(compile(m), 2.0, 0.2, settings=Settings(tolerance_r=1e-6), **UNCHECKED).report
        assert abs(report.energy_error) > 1.5
        assert report.energy_balance > 2.0 * WRONG_ERROR
        results.append((report.balance, report.energy_floor > abs(report.energy_error)))
    assert results == [(Balance.WRONG, False), (Balance.KEPT, True)]


def test_an_open_balance_decides_by_methods_whose_constraint_forces_tell_and_where_nothing_is_driven():
    simulation = Simulation(system_of("pendulum"))
    assert simulation.report.balance == Balance.KEPT
    with pytest.warns(AccuracyWarning, match="J of work"):
        simulation.step(0.2, 10)
    balances = {}
    for method in METHODS:
        simulation.change_settings(Settings(method=method))
        balances[method] = simulation.report.balance
    decide = {"ali3p", "ali3p_generalised_alpha"}
    assert balances == {method: Balance.WRONG if method in decide else Balance.OPEN for method in METHODS}
    driven = simulate(compile(driven_crank()), 2.0, 1.0 / 90.0, **UNCHECKED)
    assert driven.report.energy_balance > 2.0 * WRONG_ERROR
    assert driven.report.balance == Balance.OPEN


def test_a_refused_step_leaves_the_energy_balance_as_it_was():
    simulation = Simulation(system_of("cart_pole"), settings=Settings(max_halvings=3))
    simulation.step(1e-3, 440)
    with pytest.raises(SimulationError):
        simulation.step(1e-3, 100)
    report = simulation.report
    assert report.energy == pytest.approx(0.0, abs=0.02 * cart_pole.BOB * cart_pole.GRAVITY)
    again = Simulation(system_of("cart_pole"), settings=Settings(max_halvings=3))
    again.step(1e-3, report.steps)
    for name in ("energy", "energy_error", "work", "kinetic_peak", "speed_peak", "velocity_path", "predictor_path"):
        assert getattr(report, name) == getattr(again.report, name), name


def test_a_refused_step_gives_back_that_it_was_divided():
    """The end of a bar of 1 m is driven beyond its reach within a step, in which the rate jumps."""
    m = Model("out of reach", dimension=2, gravity=(0.0, 0.0))
    bar = m.body("bar", mass=1.0, com=(0.25, 0.375**0.5), inertia=0.1)
    tip = m.point_mass("tip", mass=0.1, position=(0.5, 0.75**0.5))
    m.revolute("pin", m.ground, bar, point=(0.0, 0.0))
    m.spherical("joint", bar, tip, point=(0.5, 0.75**0.5))
    m.drive("drive", tip.point(None)[0], m.guide_time("way", PPoly([[0.0, 200.0], [0.5, 0.5]], [0.0, 0.105, 1.0])))
    simulation = Simulation(compile(m))
    simulation.step(0.01, 10)
    with pytest.raises(SimulationError):
        simulation.step(0.01)
    assert simulation.report.failures > 0
    assert (simulation.report.steps, simulation.report.divisions) == (10, 0)
