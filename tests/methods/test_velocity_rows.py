"""Skates and rolling wheels against closed forms, by every method."""

import numpy as np
import pytest

from mbs import Settings, Simulation, compile, simulate
from tests.methods.rolling_models import (
    ARM,
    AXIAL,
    DIAMETRAL,
    GRAVITY,
    MASS,
    RADIUS,
    ROLLING,
    ROLY_DEPTH,
    ROLY_INERTIA,
    ROLY_MASS,
    ROLY_RADIUS,
    SLEIGH_INERTIA,
    SLEIGH_MASS,
    TURN,
    disc,
    roly_poly,
    sleigh,
)

TIGHT = {"eps_rel": 1e-9, "tolerance_r": 1e-13, "tolerance_phi": 1e-13}
SECOND_ORDER = ("ali3p", "ali3p_no_projection", "ali3p_generalised_alpha", "energy_momentum")
EXACT = 1e-11
ENERGY = 1e-10  # J
LEAN = np.radians(20.0)
KICK = 1e-5  # rad/s


def sleigh_motion(t):
    """Speed along the edge, rate of turn and yaw: with k^2 = (I + m a^2)/m, v' = a w^2 and k^2 w' = -a v w."""
    k = np.sqrt(SLEIGH_INERTIA / SLEIGH_MASS + ARM**2)
    x = ARM * TURN * t / k
    return k * TURN * np.tanh(x), TURN / np.cosh(x), 2.0 * k / ARM * np.arctan(np.tanh(0.5 * x))


def sleigh_errors(system, method, h, end=4.0):
    run = simulate(system, end, h, settings=Settings(method=method, **TIGHT), every=round(0.5 / h))
    speed, turn, yaw = sleigh_motion(run.t)
    assert speed[-1] > 0.5 > turn[-1] > 0.0
    velocity = max(np.abs(run["edge.vx"] - speed).max(), np.abs(run["turn"] - turn).max())
    return run, np.abs(run["yaw"] - yaw).max(), velocity


def steady_spin(precession):
    """Moments about the centre: A W^2 s n_z - (C + m R^2) w W s = m g R n_z, s and n_z cosine and sine of the lean."""
    s, n_z = np.cos(LEAN), np.sin(LEAN)
    inertia = (AXIAL + MASS * RADIUS**2) * precession * s
    return (DIAMETRAL * precession**2 * s * n_z - MASS * GRAVITY * RADIUS * n_z) / inertia


def wobble(spin):
    """Square of the frequency of a disc that rolls straight on: [C (C + m R^2) w^2 / A - m g R] / (A + m R^2)."""
    turning = AXIAL * (AXIAL + MASS * RADIUS**2) * spin**2 / DIAMETRAL
    return (turning - MASS * GRAVITY * RADIUS) / (DIAMETRAL + MASS * RADIUS**2)


@pytest.fixture(scope="module")
def skate():
    return compile(sleigh())


@pytest.mark.parametrize(
    ("method", "order", "finest"),
    [*((m, 2.0, 4e-5) for m in SECOND_ORDER), ("energy_momentum_4", 4.0, 4e-10)],
)
def test_a_sleigh_moves_as_the_closed_form_at_the_order_of_the_method(skate, method, order, finest):
    steps = np.array([0.1, 0.05, 0.025, 0.0125])
    errors = [sleigh_errors(skate, method, h)[1] for h in steps]
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(order, abs=0.15)
    assert errors[-1] < finest
    assert sleigh_errors(skate, method, 0.0125)[2] < (1e-7 if order > 2.0 else 1e-4)


def test_a_sleigh_moves_as_the_closed_form_to_round_off_at_order_eight(skate):
    assert max(sleigh_errors(skate, "runge_kutta_8", 0.05)[1:]) < EXACT


@pytest.mark.parametrize("method", ["energy_momentum", "energy_momentum_4"])
@pytest.mark.parametrize("h", [0.1, 0.01])
def test_the_force_of_a_skate_does_no_work_in_the_middle_of_a_step(skate, method, h):
    run = sleigh_errors(skate, method, h)[0]
    assert np.ptp(run["energy"]) < (ENERGY if method == "energy_momentum" else 1e-9)
    assert np.abs(run["edge.vy"]).max() < 1e-6 * h


@pytest.mark.parametrize("method", ROLLING)
def test_an_edge_that_is_set_down_stops_the_velocity_across_it(method):
    drift = 0.4
    simulation = Simulation(compile(sleigh(0.0, switch=False, drift=drift)), settings=Settings(method=method))
    free = simulation.run(1.0, 0.01)
    np.testing.assert_allclose(free["edge.vy"], drift, atol=1e-9)
    jump = simulation.set_switch("edge", True)
    # the impact acts at the edge: what of the mass moves with it is 1/(1/m + a^2/I)
    struck = 1.0 / (1.0 / SLEIGH_MASS + ARM**2 / SLEIGH_INERTIA)
    assert jump == pytest.approx(-0.5 * struck * drift**2, rel=1e-9)
    assert abs(simulation.sensors["edge.vy"]) < EXACT
    on_edge = simulation.run(2.0, 0.01)
    assert np.abs(on_edge["edge.vy"]).max() < (1e-3 if method == "ali3p_no_projection" else EXACT)
    assert on_edge["edge.vx"][-1] > on_edge["edge.vx"][0] + 0.01
    assert simulation.set_switch("edge", False) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("reduced", [False, True], ids=["body", "spin"])
def test_a_leaned_disc_rolls_on_a_circle(reduced):
    precession = -1.5  # rad/s: it leans to the right and turns to the right
    spin = steady_spin(precession)
    system = compile(disc(LEAN, precession, spin, reduced=reduced))
    assert system.report["degrees_of_freedom"] == 3 + reduced  # the axle is free to turn about itself
    run = simulate(system, 5.0, 0.02, method="runge_kutta_8")
    radius = RADIUS * spin / precession  # the centre moves to the right of x, around (0, radius)
    assert radius < -0.5
    np.testing.assert_allclose(run["axle.z"], np.sin(LEAN), atol=EXACT)
    np.testing.assert_allclose(run["centre.x"], -radius * np.sin(-precession * run.t), atol=EXACT)
    np.testing.assert_allclose(run["centre.y"], radius * (1.0 - np.cos(precession * run.t)), atol=EXACT)
    np.testing.assert_allclose(run["centre.z"], RADIUS * np.cos(LEAN), atol=EXACT)
    assert np.ptp(run["energy"]) < ENERGY


@pytest.mark.parametrize("reduced", [False, True], ids=["body", "spin"])
@pytest.mark.parametrize("spin", [1.5, 4.0])
def test_a_disc_that_rolls_straight_on_wobbles_above_its_critical_speed_and_falls_below(reduced, spin):
    square = wobble(spin)
    rate = np.sqrt(abs(square))
    run = simulate(compile(disc(0.0, 0.0, spin, KICK, reduced)), 2.0, 0.01, method="runge_kutta_8")
    expected = KICK / rate * (np.sin(rate * run.t) if square > 0.0 else np.sinh(rate * run.t))
    assert (square > 0.0) == (spin > 2.0)
    assert np.abs(run["axle.z"] - expected).max() < 1e-5 * np.abs(expected).max()


def test_both_forms_of_a_wheel_move_alike_when_it_tumbles():
    whole, reduced = (compile(disc(0.3, -0.5, 5.0, 1.0, form)) for form in (False, True))
    runs = [simulate(s, 3.0, 0.01, method="runge_kutta_8") for s in (whole, reduced)]
    for name in ("centre.x", "centre.y", "centre.z", "axle.z"):
        np.testing.assert_allclose(runs[0][name], runs[1][name], atol=1e-9)
    assert np.ptp(runs[0]["axle.z"]) > 0.2


@pytest.mark.parametrize("method", ROLLING)
def test_conditions_stated_twice_do_no_harm(method):
    system = compile(roly_poly(KICK))
    assert system.nc - system.report["rank"] == 1
    run = simulate(system, 5.0, 0.01, method=method)
    rate = np.sqrt(ROLY_MASS * GRAVITY * ROLY_DEPTH / (ROLY_INERTIA + ROLY_MASS * (ROLY_RADIUS - ROLY_DEPTH) ** 2))
    exact = method in ("energy_momentum_4", "runge_kutta_8")
    assert np.abs(run["pitch"] - KICK / rate * np.sin(rate * run.t)).max() < KICK / rate * (1e-7 if exact else 1e-3)


def test_a_static_equilibrium_lies_where_the_body_rolls_to():
    simulation = Simulation(compile(roly_poly(0.0, 2.0)))
    simulation.static_equilibrium()
    assert simulation.sensors["height"] == pytest.approx(ROLY_RADIUS - ROLY_DEPTH, abs=1e-9)
