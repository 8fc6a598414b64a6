"""The coarser runs that a run is compared with: which ones, and that they do not make a wrong run right."""

import math
import warnings
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly

import mbs
from benchmarks.methods import random_machines
from benchmarks.references.cases import system_of
from mbs.elements import ContactPoints, EndStops, PlaneRoad
from mbs.elements.road import KerbRoad
from mbs.kernel.header.limits import RESOLVED, WRONG_ERROR
from mbs.results.accuracy import Accuracy, missed_fraction, missed_over_peak
from mbs.results.comparison import Compared
from mbs.results.smooth_laws import unresolved_fraction
from mbs.simulation.coarser_run import coarser_step_factors, largest_difference, uses_one_iteration
from mbs.vehicle import load
from tests.simulation.drawn import drawn

SPAN = (0.0, 1.0)  # s


def test_long_steps_that_are_solved_to_the_end_would_hide_it() -> None:
    """A spatial slider-crank, a third off: steps eight times as long are halved, and then differ by 8 %."""
    system, span = drawn("spatial slider-crank", 5, 244)
    with pytest.warns(mbs.AccuracyWarning, match="off by about 3[0-9] %"):
        mbs.simulate(system, span, span / 300, every=6, progress=False)


@pytest.mark.parametrize("h", [0.1, 0.05])
def test_a_coarser_run_that_is_halved_to_the_same_steps_says_nothing(h: float) -> None:
    """A flyball governor by energy-momentum, 9 % off: steps twice as long are halved to those of the run."""
    with pytest.warns(mbs.AccuracyWarning, match=r"off by about 9(\.\d)? %"):
        run = mbs.simulate(
            system_of("flyball"), 10.0, h, method="energy_momentum", every=round(0.2 / h), progress=False
        )
    assert run.accuracy is not None
    assert run.accuracy.halvings_per_step > 0.5


def test_a_coarser_run_that_is_divided_to_the_same_parts_would_hide_the_error() -> None:
    """A car with stiff dampers drives down a step: forces are 7 to 10 % off; parts of equal length err alike."""
    road = KerbRoad(3.0, 0.2, -0.2, "before", 0.61)
    values = {"rear.damper.damping": 4422.0, "rear.spring.stiffness": 26936.0, "front.spring.stiffness": 17490.0}
    system, pose = mbs.compile(load("commonroad_320i").model(road)), mbs.Pose(speed=8.9, yaw=0.62)
    with pytest.warns(mbs.AccuracyWarning, match=r"off by about ([789]|10)(\.\d)? %.*\.F[xyz]"):
        mbs.simulate(system, 1.2, 0.01, parameters=values, pose=pose, every=2, progress=False)


def test_an_estimate_of_high_order_is_at_least_what_the_energy_shows() -> None:
    """Past singular positions a run is 0.53 % off, and one with eight times the step differs by no more: by order eight
    that was an error of 3e-10.
    """
    run = mbs.simulate(system_of("double_four_bar"), 10.0, 0.005, method="runge_kutta_8", every=40, progress=False)
    assert run.accuracy is not None
    assert run.accuracy.compared_step > 0.005
    assert 5.3e-3 / 3.0 < run.accuracy.error < 3.0 * 5.3e-3
    assert run.accuracy.sensors["B0.position.x"] == pytest.approx(run.accuracy.error * 2.0, rel=0.1)


def test_the_difference_is_that_of_the_steps_that_were_made() -> None:
    """Of five steps between two samples twice the step makes two."""
    known = Accuracy(None, None, 0.0, compared_step=0.25, order=2.0, units={"m": 0.0066})
    assert largest_difference(known, "ali3p", 2.5) == pytest.approx(0.0066 * (2.5**2 - 1.0))


@pytest.mark.parametrize(
    ("scene", "method", "t_end", "h"),
    [
        pytest.param("double_four_bar", "semi_recursive", 10.0, 0.005, id="longer steps are right"),
        pytest.param("slider_crank", "runge_kutta_8", 5.0, 0.005, id="longer steps are wrong alike, energy grows"),
    ],
)
def test_a_high_order_run_past_singular_positions_is_reported(scene: str, method: str, t_end: float, h: float) -> None:
    """A step near one gains energy by chance: 20 and 7 % off, where steps of ten times the length differ little."""
    with pytest.warns(mbs.AccuracyWarning, match="off by|not to be trusted"):
        mbs.simulate(system_of(scene), t_end, h, method=method, every=20, progress=False)


def ball(stiffness: float, gap: float, loads: bool = False, wall: float = 1.0, motion: bool = True) -> mbs.System:
    """1 kg that flies with 1 m/s against a stop without loss. `wall`: where its other end is, m; far away any impact
    fits; `loads`, `motion`: what is sensed.
    """
    m = mbs.Model("ball", dimension=2, gravity=(0.0, 0.0))
    b = m.point_mass("ball", mass=1.0, position=(0.0, 0.0))
    m.point_on_line("line", (b, (0.0, 0.0)), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    m.initial_velocity(b, linear=(1.0, 0.0))
    stop = EndStops(bump_length=wall - gap, bump_stiffness=stiffness)
    spring = m.spring_damper("wall", b, (m.ground, (wall, 0.0)), stiffness=0.0, free_length=wall, stops=stop)
    if motion:
        m.sense_position("x", b, component="x")
    if loads:
        m.sense_element("force", spring, "force")
    return mbs.compile(m)


def place(stiffness: float, gap: float, t: np.ndarray) -> np.ndarray:
    """Of the ball: half a period of its vibration on the stop, and back."""
    w = np.sqrt(stiffness)
    within = np.clip(t - gap, 0.0, np.pi / w)
    return np.asarray(np.minimum(t, gap) + np.sin(w * within) / w - np.maximum(t - gap - np.pi / w, 0.0))


@pytest.mark.parametrize(("stiffness", "h"), [(1e3, 0.0125), (4e3, 0.00625), (8e3, 0.01)])
def test_the_missed_fraction_is_half_a_step_times_the_frequency_of_an_impact(stiffness: float, h: float) -> None:
    run = mbs.simulate(ball(stiffness, 0.5), 1.25, h, estimate_error=False, progress=False)
    assert run.report is not None
    assert missed_fraction(run.report, "ali3p") == pytest.approx(0.5 * h * np.sqrt(stiffness), rel=0.1)


def test_a_coarser_run_that_does_not_resolve_an_impact_is_not_used() -> None:
    """Half a step in a contact: the ball is 31 % off, and by chance alike with twice the step."""
    rate, gap, h, steps = 577.55155, 0.684585, 0.01, 196
    system, settings = ball(rate**2, gap), mbs.Settings(step_iterations=8)
    with pytest.warns(mbs.AccuracyWarning, match="off by about 3[0-9] %"):
        mbs.simulate(system, steps * h, h, settings=settings, progress=False)


@pytest.mark.parametrize(
    ("rate", "h", "gap", "steps", "error"),
    [(739.47287, 0.01, 0.69299187, 194, 0.064), (3664.95899, 0.005, 0.22970663, 134, 0.125)],
    ids=["half", "a quarter"],
)
def test_runs_that_do_not_resolve_an_impact_agree_by_chance(rate, h, gap, steps, error) -> None:
    """With a run that is wrong by so much finer ones agree within 1 %; what resolves it tells."""
    with pytest.warns(mbs.AccuracyWarning, match="off by about"):
        run = mbs.simulate(ball(rate**2, gap), steps * h, h, progress=False)
    truth = place(rate**2, gap, run.t)
    assert np.abs(run["x"] - truth).max() / np.ptp(truth) == pytest.approx(error, rel=0.05)


def test_half_a_step_is_off_alike_behind_abrupt_forces() -> None:
    """A box that falls on its edges: its load is 12.9 % off, with half the step 10.5, and both differ by 2.8."""
    m, mass, half = mbs.Model("box", gravity=(0.0, 0.0, -9.81)), 6.33, np.array([0.1559, 0.3407, 0.3198])
    m.floating, com = True, np.array([0.0, 0.0, 1.2477])
    road = m.road(PlaneRoad(friction=0.2313))
    box = m.body("box", mass=mass, com=com, inertia=mass / 3.0 * (half @ half - half**2))
    corners = com + half * list(product((-1.0, 1.0), repeat=3))
    contact = ContactPoints.for_mass(mass, depth=0.01274, onset=0.00425, loss=0.43826)
    m.contact_points("feet", box, corners, road=road, contact=contact)
    m.initial_velocity(box, linear=(0.0582, 0.2498, -0.7341), angular=(0.1363, 0.2519, 0.0597))
    m.sense_position("z", box, None, "z")
    m.sense_element("load", "feet", "normal_force")
    with pytest.warns(mbs.AccuracyWarning, match="off by about 1[23] % .*sensor 'load'"):
        mbs.simulate(mbs.compile(m), 1.45, 0.01, progress=False)


def test_a_sample_that_one_in_two_leaves_out_is_compared() -> None:
    """A contact that one sample sees; of 39 steps from one to the next 20 longer ones are made, not 39 in two."""
    stiffness, gap, h, every = 4e4, 0.5, 0.001, 39
    run = mbs.simulate(ball(stiffness, gap, loads=True), 52 * every * h, h, every=every, progress=False)
    force = stiffness * np.maximum(place(stiffness, gap, run.t) - gap, 0.0)
    assert np.flatnonzero(force).tolist() == [13]
    assert run.accuracy is not None
    assert run.accuracy.compared_step == pytest.approx(every / 20 * h, rel=1e-12)
    assert "N" in run.accuracy.units


def test_which_coarser_runs_are_made() -> None:
    """Those with which steps still resolve the motion; none where the run is coarse itself."""
    run = mbs.simulate(ball(1e3, 0.5), 1.25, 0.005, estimate_error=False, progress=False)
    assert run.report is not None
    assert coarser_step_factors("ali3p", RESOLVED, replace(run.report, predictor_path=0.0)) == [8, 2]
    assert coarser_step_factors("ali3p", RESOLVED, run.report) == [2]
    abrupt = replace(run.report, predictor_path=run.report.velocity_path)
    assert coarser_step_factors("ali3p", RESOLVED, abrupt) == []
    for times, expected_factors in ((9.0, [8, 2]), (7.0, [2]), (1.0, [])):
        scaled = replace(run.report, predictor_squares=1.0 / times**2, velocity_squares=1.0)
        assert coarser_step_factors("radau_5", 2.0 * RESOLVED, scaled) == expected_factors


def test_one_iteration_is_for_what_it_shows() -> None:
    """Neither forces, nor what sticks, nor what a guide prescribes to round-off."""
    moves, settings = {"x": Compared("m", place=True)}, mbs.Settings()
    assert uses_one_iteration(settings, moves, has_states=False)
    assert not uses_one_iteration(settings, moves, has_states=True)
    assert not uses_one_iteration(settings, {**moves, "force": Compared("N", load=True)}, has_states=False)
    assert not uses_one_iteration(settings, {**moves, "rate": Compared("m/s", always=False)}, has_states=False)
    assert not uses_one_iteration(mbs.Settings(method="energy_momentum"), moves, has_states=False)


@pytest.mark.parametrize(
    ("system", "share"),
    [
        pytest.param(lambda: system_of("spatial_chain"), 2.0 * RESOLVED, id="open tree"),
        pytest.param(lambda: system_of("double_four_bar"), 2.0 * RESOLVED, id="loops"),
        pytest.param(lambda: ball(1e3, 0.5), RESOLVED, id="stop"),
    ],
)
def test_steps_of_high_order_may_be_longer_where_nothing_abrupt_can_happen(system, share) -> None:
    assert unresolved_fraction(system(), "radau_5", SPAN) == share
    assert unresolved_fraction(system(), "ali3p", SPAN) == RESOLVED
    assert unresolved_fraction(system(), "radau_5", SPAN, {"torque": lambda t: float(t > 0.5)}) == RESOLVED


@pytest.mark.parametrize("method", ["radau_5", "runge_kutta_8"])
def test_impacts_in_long_steps_of_high_order_are_right_or_reported(method: str) -> None:
    """By chance, in closed form: h w of 1.8 to 4, so that an impact lasts one step or two.

    Steps that end where the stop is met and left are right; whole ones are reported or refused.
    """
    whole, divided = mbs.Settings(method=method, max_halvings=0), mbs.Settings(method=method)
    wrong = silent = false = 0
    for number in range(24):
        rng = np.random.default_rng([2, number])
        h, steps = 0.01, int(rng.integers(15, 101))
        w, gap = float(rng.uniform(1.8, 4.0)) / h, float(rng.uniform(0.1, 0.8)) * steps * h
        system, errors, warned = ball(w * w, gap, wall=1e3), [], []
        for settings in (whole, divided):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                try:
                    run = mbs.simulate(system, steps * h, h, settings=settings, progress=False)
                except mbs.SimulationError:
                    errors.append(math.inf)
                    warned.append(True)
                    continue
            truth = place(w * w, gap, run.t)
            errors.append(np.abs(run["x"] - truth).max() / np.ptp(truth))
            warned.append(bool(caught))
        wrong, silent = wrong + (0.05 < errors[0] < math.inf), silent + (errors[0] > 0.051 and not warned[0])
        false += (errors[0] < 0.045 and warned[0]) + (errors[1] < 0.045 and warned[1])
        assert errors[1] < 0.05
    assert wrong > 3
    assert silent == 0
    assert false <= 1


def test_a_dead_centre_keeps_its_share_among_smooth_steps() -> None:
    """A spatial slider-crank jumps there, 44 % off, and twice its step jumps alike, 0.03 % apart."""
    system, span = drawn("spatial slider-crank", 3, 27)
    with pytest.warns(mbs.AccuracyWarning, match="off by"):
        mbs.simulate(system, span, span / 200, every=4, method="radau_5", progress=False)


def test_a_chain_in_long_steps_of_high_order_is_checked_by_a_quarter_at_most() -> None:
    """By eighths it was too, at 14 times its cost, as long steps miss most of v + h a."""
    system, exact = system_of("spatial_chain"), None
    for h in (0.0125, 0.1):
        run = mbs.simulate(system, 2.0, h, method="semi_recursive", every=round(0.1 / h), progress=False)
        assert run.accuracy is not None
        assert run.accuracy.check_cost <= 4.0
        exact = run if exact is None else exact
    names = [f"tip.position.{c}" for c in "xyz"]
    off = max(float(np.abs(run[n] - exact[n]).max()) for n in names)
    assert run.accuracy.sensors
    assert off == pytest.approx(max(run.accuracy.sensors[n] for n in names), rel=0.2)


@pytest.mark.parametrize(
    ("number", "method", "error"),
    [
        pytest.param(35, "radau_5", r"7\.[4-7]", id="six-bar, half the step is 9.4 % off and differs by 1.8"),
        pytest.param(25, "runge_kutta_8", "1[0-3]", id="slider-crank, an eighth of the step tells 4.1 %"),
    ],
)
def test_half_a_step_of_high_order_decides_nothing_near_the_limit(number, method, error) -> None:
    """Shorter steps see quicker changes near a dead centre, so that two may be off alike."""
    system, span = drawn("", 63, number)
    with pytest.warns(mbs.AccuracyWarning, match=rf"off by about {error} %"):
        mbs.simulate(system, span, span / 50, method=method, progress=False)


def test_coarser_runs_that_do_not_come_nearer_clear_no_contact() -> None:
    """A mass in a play of 3 mm, 5.3 % off: runs with eight, four and twice the step are off alike, 5 to 7 % from it."""
    kind, machine = random_machines.random_machine(np.random.default_rng([102, 0]))
    assert kind == "play"
    system = mbs.compile(random_machines.model_of(machine))
    with pytest.warns(mbs.AccuracyWarning, match=r"off by about 5\.[5-8] %"):
        mbs.simulate(system, machine.span, machine.span / 1800, every=36, progress=False)


def test_a_guide_that_ends_within_the_run_ends_a_step() -> None:
    """It is one polynomial, and stands still behind it: 14 % off before a step ended there."""
    m = mbs.Model("cart", dimension=2)
    cart = m.body("cart", mass=1.0, com=(0.0, 0.0), inertia=0.1)
    rod = m.body("rod", mass=1.0, com=(0.0, -0.3), inertia=0.03)
    m.prismatic("slide", m.ground, cart, axis=(1.0, 0.0), point=(0.0, 0.0))
    m.revolute("pin", cart, rod, point=(0.0, 0.0))
    pushed = m.guide_time("pushed", PPoly(np.array([[1.5], [0.0]]), [0.0, 0.701]), unit="m")
    m.drive("drive", cart.point((0.0, 0.0))[0], pushed)
    m.sense_position("x", rod, (0.0, -0.6), component="x")
    system = mbs.compile(m)
    assert unresolved_fraction(system, "runge_kutta_8", (0.0, 0.7)) == 2.0 * RESOLVED
    run, fine = (
        mbs.simulate(system, 3.0, h, method="runge_kutta_8", every=round(0.2 / h), progress=False) for h in (0.2, 0.02)
    )
    assert run.report is not None
    assert run.report.divisions == 1
    assert np.abs(run["x"] - fine["x"]).max() < 1e-3 * np.ptp(fine["x"])


def cam(lift: PPoly, stiffness: float, damping: float) -> mbs.System:
    """A follower of 1 kg on a spring and a damper behind a plate that is lifted."""
    m = mbs.Model("cam", dimension=2, gravity=(0.0, 0.0))
    plate, follower = (m.point_mass(n, mass=1.0, position=(x, 0.0)) for n, x in (("plate", 0.0), ("follower", 1.0)))
    for body, x in ((plate, 0.0), (follower, 1.0)):
        m.point_on_line(f"line of {body.name}", (body, (x, 0.0)), (m.ground, (x, 0.0)), axis=(1.0, 0.0))
    m.drive("cam", plate.point(None)[0], m.guide_time("lift", lift, unit="m"))
    m.spring_damper("spring", plate, follower, stiffness=stiffness, damping=damping, free_length=1.0)
    m.sense_position("x", follower, component="x")
    return mbs.compile(m)


def test_a_guide_whose_rate_jumps_needs_no_repeat() -> None:
    """Steps end where it jumps; before no step resolved it, so that a 16th was made, at 30 times the cost."""
    piece, rate, stiffness, damping = 0.08, 0.5, 5600.0, 11.0
    slopes = np.array([0.0, rate, 0.0, -rate, 0.0])
    lift = PPoly(np.array([slopes, piece * rate * np.array([0, 0, 1, 1, 0])]), piece * np.array([0, 1, 2, 3, 4, 10]))
    span = 5.0 * piece
    run = mbs.simulate(cam(lift, stiffness, damping), span, 0.002, method="ali3p", progress=False)
    assert run.accuracy is not None
    assert run.accuracy.check_cost == 0.5
    assert not run.accuracy.message
    exact = solve_ivp(
        lambda t, y: [y[1], stiffness * (lift(t) - y[0]) + damping * (lift(t, 1) - y[1])],
        (0.0, span), np.zeros(2), t_eval=run.t, rtol=1e-9, atol=1e-12, max_step=1e-3,
    ).y[0]  # fmt: skip
    assert np.abs(run["x"] - 1.0 - exact).max() < 0.05 * np.ptp(exact)


def test_a_contact_that_is_not_located_is_no_smooth_motion() -> None:
    """A pin kicks a light wheel beside its heavy driver: its steps miss 4.5 % of the velocities, and it is 7 % off."""
    m = mbs.Model("wheels", dimension=2, gravity=(0.0, 0.0))
    driver = m.body("driver", mass=2.0, com=(0.0, 0.0), inertia=2.0)
    wheel = m.body("wheel", mass=1.0, com=(0.45, 0.0), inertia=0.003)
    for body, x in ((driver, 0.0), (wheel, 0.45)):
        m.revolute(f"bearing of {body.name}", m.ground, body, point=(x, 0.0))
    m.initial_velocity(driver, linear=(0.0, 0.0), angular=8.0)
    stops = EndStops(bump_length=0.05, bump_stiffness=1e4, bump_loss=0.3)
    ends = (driver, (0.17 * np.cos(2.0), 0.17 * np.sin(2.0))), (wheel, (0.15, 0.02))
    m.spring_damper("pin", *ends, stiffness=0.0, free_length=0.3, stops=stops)
    m.sense_position("x", wheel, (0.75, 0.0), component="x")
    system = mbs.compile(m)
    with pytest.warns(mbs.AccuracyWarning, match="off by about 7 %"):
        run = mbs.simulate(system, 2.0, 5e-4, every=80, progress=False)
    assert run.report is not None
    assert run.report.divisions == 0
    assert missed_over_peak(run.report) < WRONG_ERROR


def pendulum_of_rods(angles: list[float]) -> mbs.System:
    """Particles of 1 kg on massless rods of 1 m at `angles` from below, rad; the sensor is x of the last."""
    points = np.cumsum(np.column_stack([np.sin(angles), -np.cos(angles)]), axis=0)
    m = mbs.Model("pendulum of rods", dimension=2)
    last: tuple[Any, Any] = (m.ground, (0.0, 0.0))
    for k, point in enumerate(points):
        particle = m.point_mass(f"particle {k}", mass=1.0, position=point)
        m.distance(f"rod {k}", last, (particle, point))
        last = particle, point
    m.sense_position("x", last[0], None, "x")
    return mbs.compile(m)


def test_small_steps_of_a_chaotic_motion_are_compared() -> None:
    """Nearly each step is exact, but errors of a double pendulum grow to 30 % of the range in 10 s."""
    system = pendulum_of_rods([1.7, 2.9])
    exact = mbs.simulate(system, 10.0, 2e-4, method="runge_kutta_8", estimate_error=False, progress=False)
    with pytest.warns(mbs.AccuracyWarning, match="off by"):
        run = mbs.simulate(system, 10.0, 2e-4, method="ali3p", progress=False)
    assert run.report is not None
    assert missed_over_peak(run.report) < WRONG_ERROR
    assert np.abs(run["x"] - exact["x"]).max() > WRONG_ERROR * np.ptp(exact["x"])
    short = mbs.simulate(system, 0.5, 2e-4, method="ali3p", progress=False)
    assert short.accuracy is not None
    assert short.accuracy.check_cost == 0.0


def test_a_coarser_run_near_a_chaotic_motion_by_chance_does_not_confirm_it() -> None:
    """In 8 times the step a pendulum of three rods stays within 21 % of the run by chance; both are wrong."""
    system = pendulum_of_rods([-1.0, 2.8, -2.5])
    exact = mbs.simulate(system, 4.0, 2e-4, method="runge_kutta_8", estimate_error=False, progress=False)
    with pytest.warns(mbs.AccuracyWarning, match="off by"):
        run = mbs.simulate(system, 4.0, 2e-3, method="ali3p", progress=False)
    assert np.abs(run["x"] - exact["x"][::10]).max() > WRONG_ERROR * np.ptp(exact["x"])
