"""Energy that steps make or lose without a force: the balance against the energy itself, and steps refused for it."""

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.methods.honesty_scenes import printed_model
from benchmarks.references import motions as references
from benchmarks.references.cases import CASES, system_of
from mbs import AccuracyWarning, Model, Settings, Simulation, SimulationError, compile, simulate
from mbs.kernel.binding import Status
from mbs.scenes import cart_pole

BALANCE = 0.02  # of the change of energy: the balance takes the next step to be like the present one
SHARE = 0.05  # of extent and energy: what the stability maps call fine
FALL = cart_pole.BOB * cart_pole.GRAVITY * cart_pole.LENGTH  # J
USUAL = {"squeezer": 1e-4}  # s, where not 0.01


@pytest.mark.parametrize("scene", ["pendulum", "double_four_bar", "bricard"])
def test_the_energy_balance_of_a_conservative_scene_is_its_loss_of_energy(scene):
    t = simulate(system_of(scene), 2.0, 0.005, progress=False)
    lost = t["energy.total"][-1] - t["energy.total"][0]
    assert abs(lost) > 1e-9
    assert t.report.energy_error == pytest.approx(lost, rel=BALANCE)


def test_a_motor_and_a_spring_are_no_error():
    """Work of forces and drives is not in the balance: it falls with the step like the error of the method."""
    errors = [abs(simulate(system_of("squeezer"), 0.04, h, progress=False).report.energy_error) for h in (1e-4, 5e-5)]
    assert errors[0] > 3.0 * errors[1]


@pytest.mark.parametrize(
    "scene", [name for name in CASES if name not in ("cart_pole", "pendulum_1000s", "four_bar_200")]
)
def test_no_other_scene_is_halved_at_its_usual_step(scene):
    h = USUAL.get(scene, 0.01)
    run = simulate(system_of(scene), 200 * h, h, progress=False, estimate_error=False)
    assert run.report.halvings == 0


@pytest.mark.parametrize(("method", "h"), [("ali3p", 1e-4), ("ali3p_generalised_alpha", 1e-5), ("runge_kutta_8", 1e-5)])
def test_the_spike_of_the_light_cart_is_refused_where_the_step_does_not_resolve_it(method, h):
    simulation = Simulation(system_of("cart_pole"), settings=Settings(method=method, max_halvings=4))
    with pytest.raises(SimulationError, match="the energy balance is violated") as refused:
        simulation.run(0.6, h, progress=False)
    assert refused.value.status == Status.UNRESOLVED
    assert "Worst" not in str(refused.value)
    assert refused.value.time == simulation.time == pytest.approx(0.4515, abs=1e-4)
    bob = np.array([simulation.sensors[f"bob.position.{c}"] for c in "xy"])
    exact = references.light_cart(np.array([0.0, simulation.time]))[-1]
    np.testing.assert_allclose(bob, exact, atol=1e-4)  # good up to there
    assert abs(simulation.report.energy_error) < 0.02 * FALL  # nothing of the refused step


@pytest.mark.parametrize(
    ("method", "h"), [("ali3p", 1e-3), ("ali3p", 1e-4), ("ali3p_generalised_alpha", 3e-4), ("runge_kutta_8", 1e-3)]
)
def test_halves_of_the_step_resolve_the_spike_of_the_light_cart(method, h):
    t = simulate(
        system_of("cart_pole"), 0.6, h, settings=Settings(method=method, max_halvings=16), every=10, progress=False
    )
    exact = references.light_cart(t.t)
    error = np.hypot(t["bob.position.x"] - exact[:, 0], t["bob.position.y"] - exact[:, 1])
    assert error.max() < SHARE * cart_pole.LENGTH
    assert np.abs(t["energy.total"] - t["energy.total"][0]).max() < SHARE * FALL
    assert 5 <= t.report.halvings < 60


def test_nothing_is_projected_so_nothing_is_watched():
    t = simulate(system_of("double_four_bar"), 0.5, 0.01, method="ali3p_no_projection", progress=False)
    assert t.report.energy_error == 0.0


def test_an_infinite_motion_is_reported_with_a_message():
    def jolt(t):
        return 0.0 if t < 0.1 else 1e300

    m = Model("thrown", dimension=2)
    ball = m.point_mass("ball", mass=1e-10, position=(0.0, 0.0))
    m.force("push", ball, inputs=[m.input("push", unit="N"), None])
    with pytest.raises(SimulationError, match="became infinite") as refused:
        simulate(compile(m), 1.0, 0.02, {"push": jolt}, progress=False)
    assert refused.value.status == Status.NOT_FINITE
    message = str(refused.value).lower().replace("infinite", "")
    assert "nan" not in message
    assert "inf" not in message


def crank_slider(h):
    simulation = Simulation(printed_model(), inputs={"torque": 4.0}, settings=Settings(max_halvings=8))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # it is wrong on purpose
        simulation.step(h, round(1.0 / h))
    return simulation


@pytest.mark.parametrize("h", [0.02, 0.005])
def test_a_long_step_passes_where_short_ones_pass(h):
    """Ten of 1 ms passed where one of 10 ms was refused at 0.53 s for ever."""
    assert crank_slider(h).time == pytest.approx(1.0)


def test_the_energy_balance_holds_through_changed_steps():
    """What the energy gained beside the work of the motor: forces left without balance work in the step that comes.

    The motion is chaotic: of 60 steps from 5 to 12 ms a few are off by more than 3 %.
    """
    off = []
    for h in (0.012, 0.01, 0.008, 0.006, 0.001):
        simulation = crank_slider(h)
        report = simulation.report
        assert report.halvings > (0 if h == 0.001 else 100)
        gained = report.energy - 4.0 * simulation.sensors["crank.angle"]
        off.append(abs(report.energy_error - gained) / (report.kinetic_peak + report.work))
    assert np.median(off) < 0.02


def rotor() -> Model:
    """A wheel whose angle follows an input through the filter of a guide: its energy is prescribed."""
    m = Model("rotor", dimension=2, gravity=(0.0, 0.0))
    wheel = m.body("wheel", mass=1.0, com=(0.0, 0.0), inertia=0.5)
    m.revolute("axle", m.ground, wheel, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, wheel)
    m.drive("motor", angle, m.guide_input("follow", input=m.input("target"), frequency=5.0, unit="rad"))
    return m


def test_what_a_guide_gives_is_no_error():
    """The input of a driven wheel steps and swings: what stays open falls with the cube of the step.

    Where the work of drives counts with the multipliers after the projection of the acceleration it falls with the
    square: 0.35 and 0.09 J in place of 0.01 and 0.002 J.
    """
    requested = {"target": lambda t: (1.0 if t > 0.5 else 0.0) + 0.5 * np.sin(9.0 * t)}
    reports = [
        simulate(compile(rotor()), 2.0, h, requested, progress=False, estimate_error=False).report for h in (4e-3, 2e-3)
    ]
    assert reports[0].kinetic_peak > 20.0
    assert abs(reports[0].energy_error) < 1e-3 * reports[0].kinetic_peak
    assert abs(reports[0].energy_error) > 5.0 * abs(reports[1].energy_error)


def watched_rotor():
    m = rotor()
    m.sense_energy("energy")
    m.sense_energy("guides", "with guides")
    return compile(m)


SQUARE = ((0.0, 0.1, 0.1, 0.3, 0.3, 0.5, 0.5, 0.8), (0.0, 0.0, 0.5, 0.5, -0.5, -0.5, 0.5, 0.5))


@pytest.mark.parametrize(
    ("method", "bound"),
    [("ali3p", 5e-4), ("ali3p_no_projection", 0.01), ("ali3p_generalised_alpha", 0.02), ("energy_momentum", 0.01)],
)
def test_the_work_of_a_guide_under_a_square_wave_is_the_energy_of_its_wheel(method, bound):
    """At all times, as shares of the largest; multipliers that are straight in a step give 7e-3 and 4e-2 by ALi3-P."""
    run = simulate(watched_rotor(), 0.8, 2e-3, {"target": SQUARE}, method=method, progress=False, estimate_error=False)
    assert np.ptp(run["energy"]) > 10.0
    assert np.abs(run["energy"] - run["energy"][0] - run["guides"]).max() < bound * np.ptp(run["energy"])


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum"])
def test_the_work_of_a_guide_is_the_same_whether_steps_are_read_or_not(method):
    """Energy-momentum steps have multipliers of their ends only where they are read: else 1.13 J are 1.63 J."""
    works = []
    for parts in (1, 100):
        simulation = Simulation(watched_rotor(), settings=Settings(method=method))
        simulation.set_input("target", 0.5)
        for _ in range(100 // parts):
            simulation.instance.run(1e-3, parts)
        works.append(simulation.sensors["guides"])
    assert works[0] > 1.0
    assert works[1] == works[0]


def pendulum(amplitude, step, mass=1.0):
    """A planar body of J = 1.1 kg m2 that swings; the run of 4000 steps and the mean of (rate times acceleration)^2."""
    m = Model("pendulum", dimension=2, gravity=(0.0, -9.81))
    rod = m.body("rod", mass=mass, com=(np.sin(amplitude), -np.cos(amplitude)), inertia=0.1)
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    stiff = 9.81 / 1.1
    exact = solve_ivp(
        lambda t, y: (y[1], -stiff * np.sin(y[0])), (0.0, 100.0), (amplitude, 0.0), rtol=1e-9, max_step=0.02
    )
    t, (angle, rate) = exact.t, exact.y
    mean = np.trapezoid((stiff * np.sin(angle) * rate) ** 2, t) / t[-1]
    return simulate(compile(m), 4000 * step, step, progress=False, estimate_error=False), mean


def test_the_energy_loss_of_a_pendulum_is_that_of_the_theory():
    step = 0.0167
    run, mean = pendulum(0.5, step)
    assert run.report.energy_growth / 4000 == pytest.approx(-3.0 / 8.0 * 1.1 * mean * step**4, rel=0.01)


def test_the_energy_loss_of_a_free_body_is_that_of_the_theory():
    """-1/32 of the rate of the multipliers squared, of a body of three axes: U'' G = U Lam, Lam = (W^2 + W') G."""
    inertia, spin, step = np.array([0.05, 0.08, 0.1]), 5.0 * np.array([0.6, 0.64, 0.48]), 0.01
    m = Model("body", gravity=(0.0, 0.0, 0.0))
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=inertia)
    m.initial_velocity(body, (0.0, 0.0, 0.0), spin)
    run = simulate(compile(m), 40.0, step, progress=False, estimate_error=False)
    G = np.diag(0.5 * inertia.sum() - inertia)

    def turn(w):
        return np.cross(inertia * w, w) / inertia

    def cross(w):
        return np.cross(np.eye(3), w)

    exact = solve_ivp(lambda t, w: turn(w), (0.0, 40.0), spin, rtol=1e-10, t_eval=np.linspace(0.0, 40.0, 4001))
    lam = np.array([(cross(-w) @ cross(-w) + cross(-turn(w))) @ G for w in exact.y.T])
    rates = np.gradient(lam, exact.t, axis=0)
    mean = np.mean(np.einsum("tij,j,tji->t", rates, 1.0 / np.diag(G), rates))
    assert run.report.energy_growth / 4000 == pytest.approx(-mean * step**4 / 32.0, rel=0.02)


def sprung(damping=0.0, pushed=False):
    m = Model("sprung", gravity=(0.0, 0.0, 0.0))
    bob = m.point_mass("bob", mass=1.0, position=(1.2, 0.0, 0.0))
    m.spring_damper("spring", (m.ground, (0.0, 0.0, 0.0)), bob, stiffness=1.0, damping=damping, free_length=1.0)
    m.initial_velocity(bob, (0.0, 0.3, 0.1))
    if pushed:
        m.force("push", bob, bob.com, inputs=[m.input("push"), None, None])
    return compile(m)


def test_a_swing_of_the_energy_is_distinguished_from_a_drift():
    swings = simulate(sprung(), 400.0, 0.2, progress=False, estimate_error=False)
    assert swings.report.free_states == 2001
    assert swings.report.energy_growth == 0.0
    drifts = simulate(sprung(), 400.0, 0.5, method="radau_5", progress=False, estimate_error=False)
    assert drifts.report.energy_growth < 0.0
    lost, _ = pendulum(0.5, 0.0335)
    assert len(lost.notices) == 1
    assert "falls by 0.9" in lost.notices[0] or "falls by 0.8" in lost.notices[0]
    assert "and goes on so; method='energy_momentum' keeps it better" in lost.notices[0]


@pytest.mark.parametrize("system", [sprung(0.01), sprung(pushed=True)])
def test_what_may_gain_or_lose_energy_is_not_watched(system):
    run = simulate(system, 20.0, 0.2, progress=False, estimate_error=False)
    assert run.report.free_states == 0
    assert run.report.energy_change == 0.0
    assert run.notices == ()


def test_the_trend_continues_in_a_restored_state():
    whole, parts = (Simulation(sprung()) for _ in range(2))
    whole.run(20.0, 0.2, progress=False)
    parts.run(10.0, 0.2, progress=False)
    other = Simulation(sprung())
    other.restore(parts.save())
    other.run(20.0, 0.2, progress=False)
    assert other.report.free_states == whole.report.free_states == 101
    assert other.report.free_product == whole.report.free_product
