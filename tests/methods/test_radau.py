"""Radau IIA on index three: orders, stiff decay, redundant rows, the work of dampers, what it does not take."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbs import Model, Settings, Simulation, compile, simulate
from mbs.scenes import bricard, flyball
from tests.methods.models import end, hinge, sliding_mass

NAME = "radau_5"
TIGHT = Settings(method=NAME, tolerance_r=1e-13, tolerance_phi=1e-13)
STAGES = 3


def order(system, names, t_end, steps, settings=TIGHT):
    """Fitted order at the end, and the least error; the reference is the method itself with a much smaller step."""
    reference = end(system, names, t_end, 0.1 * steps[-1], TIGHT)
    errors = [np.linalg.norm(end(system, names, t_end, h, settings) - reference) for h in steps]
    return np.polyfit(np.log(steps), np.log(errors), 1)[0], errors[-1]


def crank_with_a_motor():
    m = Model("crank", dimension=2)
    crank = m.body("crank", mass=2.0, com=(0.5, 0.0), inertia=0.16)
    m.revolute("hinge", m.ground, crank, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, crank)
    m.torque_on("motor", angle, input=m.input("torque", unit="N m"))
    m.sense_coordinate("angle", angle)
    return compile(m)


def test_a_step_of_a_damped_oscillator_is_that_of_its_stability_function():
    """R(Z) = (1 - 3 Z/5 + 3 Z^2/20 - Z^3/60)^-1 (1 + 2 Z/5 + Z^2/20), Z = h A (Hairer, Wanner, IV.5)."""
    stiffness, damping, h = 4.0, 1.5, 0.5
    simulation = Simulation(sliding_mass(stiffness, damping, 0.3, -0.4), settings=TIGHT)
    Z, value, one = h * np.array([[0.0, 1.0], [-stiffness, -damping]]), np.array([0.3, -0.4]), np.eye(2)
    R = np.linalg.solve(one - 0.6 * Z + 0.15 * Z @ Z - Z @ Z @ Z / 60.0, one + 0.4 * Z + Z @ Z / 20.0)
    for _ in range(4):
        simulation.step(h)
        value = R @ value
        assert [simulation.sensors[name] for name in ("x", "v")] == pytest.approx(value, abs=1e-12)


def test_velocities_without_projection_are_of_order_three():
    """Hairer, Lubich, Roche 1989: of index three, positions 2s - 1, velocities s."""
    system, steps = compile(flyball.build()), (0.02, 0.0125, 0.01, 0.008)
    loose = Settings(method=NAME, tolerance_r=1e-13, tolerance_phi=1e-13, project=False)
    result, _ = order(system, ["shaft.rate"], 0.4, steps, loose)
    assert 2.7 < result < 3.3


def test_the_work_of_a_damper_is_the_energy_lost():
    """On the angle theta of a hinge: E0 - E1 is the integral of c theta'^2 along the motion of an ODE solver."""
    damping, system = 0.3, compile(hinge(0.3))
    inertia, arm, weight, stiffness = 0.1 + 2.0 * 0.4**2, 0.4, 2.0 * 9.81, 1.5

    def rates(_, x):
        angular = (weight * arm * np.cos(x[0]) - stiffness * x[0] - damping * x[1]) / inertia
        return [x[1], angular, damping * x[1] ** 2]

    exact = solve_ivp(rates, (0.0, 2.0), [0.0, 9.0, 0.0], method="Radau", rtol=1e-10, atol=1e-12).y[:, -1]
    run = simulate(system, 2.0, 0.02, settings=TIGHT)
    assert run["angle"][-1] == pytest.approx(exact[0], abs=2e-6)
    assert run["energy"][0] - run["energy"][-1] == pytest.approx(exact[2], abs=1e-5)
    assert exact[2] > 10.0


def test_a_stiff_damper_stops_within_a_step_without_swinging():
    rate = 1e6
    run = simulate(sliding_mass(0.0, rate, 0.0, 1.0), 0.1, 0.01, settings=TIGHT, estimate_error=False)
    speed = np.abs(run["v"])
    assert speed[1] < 10.0 / (rate * 0.01)
    assert speed[2] < 10.0 / (rate * 0.01) ** 2
    assert run["x"][-1] == pytest.approx(1.0 / rate, rel=1e-2)


def test_a_redundant_row_costs_no_more_than_others():
    run = simulate(compile(bricard.build()), 10.0, 0.05, method=NAME)
    assert np.abs(run["energy.total"] - run["energy.total"][0]).max() < 1e-5
    assert run.report.iterations % STAGES == 0
    assert run.report.iterations < 5 * STAGES * run.report.steps
    assert run.report.factorizations < 2.1 * run.report.steps  # all stages together, and the mass for the projections
    assert run.report.velocity_violation < 1e-10


def test_inputs_go_straight_between_the_ends_of_a_step():
    inputs, system = {"torque": (np.array([0.0, 0.5, 1.0]), np.array([0.0, 8.0, -4.0]))}, crank_with_a_motor()
    run = simulate(system, 1.0, 0.02, inputs, TIGHT)
    expected = simulate(system, 1.0, 0.02, inputs, method="runge_kutta_8")
    np.testing.assert_allclose(run["angle"], expected["angle"], atol=1e-7)
