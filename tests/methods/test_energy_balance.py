"""The energy balance of a run: energy, work, kinetic energy, predictor differences, and what a refusal leaves."""

from ctypes import byref
from dataclasses import asdict, replace

import numpy as np
import pytest

from benchmarks.methods.honesty_scenes import printed_model
from benchmarks.references.cases import system_of
from mbs import Model, Settings, Simulation, SimulationError, compile, simulate
from mbs.kernel.header.structures import ReportFields
from mbs.scenes import cart_pole
from mbs.settings.settings import METHODS
from tests.simulation.scenes import pendulum

H = 1e-4
UNCHECKED = {"progress": False, "estimate_error": False}


@pytest.mark.parametrize("method", ["ali3p", "ali3p_generalised_alpha", "runge_kutta_8"])
def test_work_is_what_the_motor_gave(method):
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


@pytest.mark.parametrize("method", [m for m in METHODS if m not in ("energy_momentum_4", "ali3p_no_projection")])
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
    """A car at rest moved with 8e-9 J, of which an error of 1e-9 J is 12 %: 600 kg times g times 1e-10 m are 6e-7 J."""
    simulation = Simulation(system_of("pendulum"), settings=Settings(tolerance_r=1e-9))
    gravity = np.abs(simulation.system.arrays["gravity_force"]).sum()
    simulation.step(0.05, 5)
    assert simulation.report.energy_floor == pytest.approx(1e-9 * gravity, rel=1e-12)
    for error, floor, wrong in ((1e-9, 0.0, True), (-1e-9, 6e-7, False), (1e-6, 6e-7, True), (-1e-6, 6e-7, True)):
        numbers = {"steps": 500, "energy_error": error, "kinetic_peak": 8e-9, "energy_floor": floor}
        report = replace(simulation.report, work=0.0, **numbers)
        assert report.balance_wrong == wrong
        assert report.energy_balance == pytest.approx(abs(error) / max(8e-9, floor), rel=1e-15)
        balance = simulation.instance._library.ali3_energy_balance(byref(ReportFields(**numbers)))
        assert balance == pytest.approx(report.energy_balance, rel=1e-15)
        kernel = simulation.instance._library.ali3_balance_wrong(byref(ReportFields(**numbers)))
        assert kernel == wrong


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
