"""Runs to a tolerance: the error reached against exact motions, the record, choices, and what is said of them."""

import math
from contextlib import nullcontext

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import BPoly, PPoly

import mbs
from benchmarks.car.manoeuvres import inputs_of, load, start_of
from benchmarks.car.manoeuvres import system_of as car_of
from benchmarks.methods import chaotic_pendulums
from benchmarks.methods.honesty_scenes import CRANK_ANGLE, printed_model
from benchmarks.references import motions as references
from benchmarks.references.cases import CASES, exact_of, system_of
from mbs.results.accuracy import AccuracyWarning

ALLOWED = 10.0


def pushed_mass() -> mbs.System:
    """2 kg under a force."""
    m = mbs.Model("mass", dimension=2, gravity=(0.0, 0.0), length=1.0)
    mass = m.point_mass("mass", mass=2.0, position=(0.0, 0.0))
    force = m.input("force", min=-10.0, max=10.0, unit="N")
    m.force("push", mass, inputs=(force, None))
    m.sense_position("x", mass, None, "x")
    return mbs.compile(m)


def error_of(scene: str, run: mbs.Trajectory) -> float:
    """Largest error of the output point over the run, in parts of the model's length."""
    assert run.control is not None
    values = np.column_stack([run[s] for s in CASES[scene].sensors])
    return float(np.linalg.norm(values - exact_of(scene), axis=1).max()) / run.control.length


def run_of(scene: str, tolerance: float, method: str | None = None) -> mbs.Trajectory:
    case = CASES[scene]
    times = np.linspace(0.0, case.end, 51)
    return mbs.simulate(system_of(scene), case.end, tolerance=tolerance, method=method, times=times)


def test_the_printed_crank_slider_turns_as_far_as_it_should() -> None:
    tolerance = 1e-4
    run = mbs.simulate(printed_model(), 2.0, inputs={"torque": 4.0}, tolerance=tolerance)
    assert run.control is not None
    assert abs(run["crank.angle"][-1] - CRANK_ANGLE) < ALLOWED * tolerance  # the length counts per rad
    assert run.control.method == "runge_kutta_8"
    assert run.control.steps < 6000  # ALi3-P needs a million for the first of them


@pytest.mark.parametrize(
    ("scene", "method", "tolerance"),
    [
        ("double_four_bar", "ali3p", 1e-3),  # ten singular positions
        ("double_four_bar", "radau_5", 1e-4),
        ("double_four_bar", "energy_momentum", 1e-3),
        ("double_four_bar", "energy_momentum_4", 1e-4),
        ("double_four_bar", "semi_recursive_4", 1e-4),
        ("slider_crank", None, 1e-4),
        ("spatial_slider_crank", None, 1e-6),
        ("pendulum", "runge_kutta_8", 1e-8),
        ("cart_pole", None, 1e-6),  # spikes of 4429 rad/s
    ],
)
def test_the_error_is_within_ten_tolerances(scene: str, method: str | None, tolerance: float) -> None:
    run = run_of(scene, tolerance, method)
    assert run.control is not None
    assert error_of(scene, run) < ALLOWED * tolerance
    assert run.control.kept


def test_errors_of_two_runs_that_err_alike_are_their_distance() -> None:
    """A chaotic pendulum: its second and third run err by 12 and 14 tolerances, and are 1.5 tolerances apart."""
    system, truth, span = chaotic_pendulums.random_pendulum(np.random.default_rng([6, 22]))
    run = mbs.simulate(system, span, tolerance=1e-3, times=np.linspace(0.0, span, len(truth["mass0.x"])))
    assert run.control is not None
    assert max(np.abs(run[name] - exact).max() for name, exact in truth.items()) < 2e-3 * run.control.length


def test_runs_that_are_far_apart_say_nothing_of_the_finer_one() -> None:
    """A double pendulum that turns over: the last two runs are a length apart; by what their steps err it is 0.2."""
    m, x, last = mbs.Model("double pendulum", dimension=2), np.zeros(2), None
    for i, angle in enumerate((2.6, 0.0)):
        d = np.array([np.cos(angle), np.sin(angle)])
        body = m.body(f"bar {i}", mass=1.0, com=x + 0.5 * d, inertia=0.09)
        m.revolute(f"joint {i}", m.ground if last is None else last, body, point=x)
        x, last = x + d, body
    for c in "xy":
        m.sense_position(f"tip.{c}", last, x, c)
    system, runs = mbs.compile(m), []
    for tolerance, caught in ((1e-2, pytest.warns(AccuracyWarning, match="estimated as")), (1e-7, nullcontext())):
        with caught:
            runs.append(
                mbs.simulate(
                    system, 10.5, tolerance=tolerance, method="runge_kutta_8", times=np.linspace(0.0, 10.5, 51)
                )
            )
    run, exact = runs
    assert run.control is not None
    off = max(np.abs(run[name] - exact[name]).max() for name in ("tip.x", "tip.y")) / run.control.length
    assert off > ALLOWED * 1e-2
    assert 0.5 * off < run.control.error < 5.0 * off


def test_the_stiff_governor_is_not_followed_in_its_fastest_motion() -> None:
    run = run_of("flyball", 1e-3, "radau_5")
    assert error_of("flyball", run) < ALLOWED * 1e-3
    assert run.control is not None
    assert run.control.steps < 2000  # an explicit rule that follows 27000 1/s needs more than 6000


def test_a_light_cart_costs_a_few_thousand_evaluations() -> None:
    run = run_of("cart_pole", 1e-3, "runge_kutta_8")
    assert run.report is not None
    assert run.control is not None
    assert run.report.iterations < 6000  # a million with equal steps
    assert run.control.largest > 1e5 * run.control.smallest


def test_a_body_that_turns_over_turns_over_in_time() -> None:
    inertia, start = np.array([1.0, 2.0, 3.0]), np.array([1e-3, 5.0, 0.0])  # Dzhanibekov: about the middle axis
    m = mbs.Model("Dzhanibekov", gravity=(0.0, 0.0, 0.0), length=1.0)
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=inertia)
    m.initial_velocity(body, linear=(0.0, 0.0, 0.0), angular=start)
    for c in "xyz":
        m.sense_position(f"tip.{c}", body, (0.0, 1.0, 0.0), c)
    run = mbs.simulate(mbs.compile(m), 10.0, tolerance=1e-5)
    tip = np.column_stack([run[f"tip.{c}"] for c in "xyz"])

    def rates(_: float, x: np.ndarray) -> np.ndarray:
        w, R = x[:3], x[3:].reshape(3, 3)
        skew = np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])
        return np.concatenate([-np.cross(w, inertia * w) / inertia, (R @ skew).ravel()])

    exact = solve_ivp(rates, (0.0, 10.0), [*start, *np.eye(3).ravel()], "DOP853", run.t, rtol=1e-12, atol=1e-13).y
    assert np.ptp(tip[:, 1]) > 1.9  # it does
    assert np.abs(tip - exact[3:].reshape(3, 3, -1)[:, 1].T).max() < ALLOWED * 1e-5


def test_a_kerb_is_run_down_with_the_loads_of_short_steps() -> None:
    manoeuvre = load("kerb_drop")
    system = car_of("kerb_drop")
    parameters, pose = start_of(manoeuvre, system)
    arguments = (inputs_of(manoeuvre, system), None, parameters)
    fine = mbs.simulate(system, 2.5, 5e-4, *arguments, every=20, pose=pose, progress=False)
    run = mbs.simulate(system, 2.5, 0.01, *arguments, pose=pose, progress=False, tolerance=1e-3)
    assert run.control is not None
    assert run.control.method == "ali3p"
    assert 0.02 < run.control.largest < 0.06  # before the kerb: a twentieth of the length at 5 m/s
    assert np.abs(run["chassis.z"] - fine["chassis.z"]).max() < 1e-3 * run.control.length
    load_ = "wheel_FL.Fz"
    assert np.abs(run[load_] - fine[load_]).max() < 5e-3 * np.ptp(fine[load_])


@pytest.mark.parametrize(("method", "order"), [("ali3p", 2), ("radau_5", 5), ("runge_kutta_8", 8)])
def test_the_record_between_steps_keeps_the_order(method: str, order: int) -> None:
    """Errors between the steps are no larger than at tolerances' pace, also of the force in the rod."""
    times = np.linspace(0.0, 2.0, 601)
    exact = references.pendulum(times)
    tension = 3.0 * 9.81 * -exact[:, 1]
    errors, forces = [], []
    tolerances = [1e-3, 1e-5] if order == 2 else [1e-4, 1e-8]
    for tolerance in tolerances:
        run = mbs.simulate(system_of("pendulum"), 2.0, tolerance=tolerance, times=times, method=method)
        assert run.control is not None
        values = np.column_stack([run["bob.position.x"], run["bob.position.y"]])
        errors.append(np.linalg.norm(values - exact, axis=1).max())
        forces.append(np.abs(run["rod.tension"] - tension).max() / (3.0 * 9.81))
        assert run.control.steps < 601 or order == 2  # so that most of the record lies between steps
    for tolerance, error, force in zip(tolerances, errors, forces, strict=True):
        assert error < ALLOWED * tolerance
        assert force < 3.0 * ALLOWED * tolerance


def test_steps_end_at_the_points_of_a_table() -> None:
    """A force that jumps: exact by pieces, so an order-two record of a step over the jump would show."""
    table = ([0.0, 0.7123, 0.7123, 2.0], [4.0, 4.0, -2.0, -2.0])
    run = mbs.simulate(pushed_mass(), 2.0, inputs={"force": table}, tolerance=1e-9, method="runge_kutta_8")
    t, s = run.t, 0.7123
    late = np.clip(t - s, 0.0, None)
    exact = np.where(t < s, t**2, s**2 + 2.0 * s * late - 0.5 * late**2)
    assert np.abs(run["x"] - exact).max() < 1e-11
    assert run.control is not None
    assert run.control.rejected == 0


def test_refresh_takes_over_an_input_that_jumps() -> None:
    s = mbs.Simulation(pushed_mass())
    assert np.abs(s.state.qdd).max() < 1e-12
    s.set_input("force", 4.0)
    s.instance.refresh()
    assert np.abs(s.state.qdd).max() == pytest.approx(2.0)
    assert np.abs(s.state.qd).max() == 0.0


def test_times_of_the_record() -> None:
    system = system_of("pendulum")
    run = mbs.simulate(system, 1.0, tolerance=1e-3, times=[0.1, 0.25, 0.9])
    assert run.t.tolist() == [0.0, 0.1, 0.25, 0.9]
    assert len(mbs.simulate(system, 1.0, 0.1, tolerance=1e-3).t) == 11
    assert len(mbs.simulate(system, 1.0, 0.1, tolerance=1e-3, every=2).t) == 6
    assert len(mbs.simulate(system, 1.0, tolerance=1e-3).t) == 201


def test_a_step_is_chosen_if_none_is_given() -> None:
    run = mbs.simulate(system_of("pendulum"), 2.0)
    control = run.control
    assert control is not None
    assert control.h is not None
    assert len(run.t) == round(2.0 / control.h) + 1
    exact = references.pendulum(run.t)
    error = np.linalg.norm(np.column_stack([run["bob.position.x"], run["bob.position.y"]]) - exact, axis=1).max()
    assert 0.3 < control.error / error < 3.0
    assert error < 3.0 * control.tolerance
    assert f"fixed steps of {control.h:.4g} s" in str(run)


def test_the_choice_of_the_method_is_reported() -> None:
    coarse = run_of("spatial_chain", 1e-3).control
    assert coarse is not None
    assert coarse.method == "semi_recursive_4"  # of low order
    run = run_of("spatial_chain", 5e-4)
    assert run.control is not None
    assert run.control.method == "semi_recursive"
    assert "a tree of joints" in run.control.reason
    assert run.control.runs >= 3
    assert "semi_recursive (chosen" in str(run)
    named = run_of("pendulum", 1e-3, "radau_5")
    assert named.control is not None
    assert named.control.reason == ""
    result = mbs.simulate(system_of("pendulum"), 1.0, settings=mbs.Settings(method="radau_5"), tolerance=1e-3)
    assert result.control is not None
    assert result.control.method == "radau_5"
    equal = mbs.simulate(system_of("pendulum"), 1.0, 0.01, method="auto")
    assert equal.control is not None
    assert equal.control.h == 0.01


def test_the_same_call_gives_the_same_bits() -> None:
    first, second = (run_of("double_four_bar", 1e-3) for _ in range(2))
    for name in first:
        assert first[name].tobytes() == second[name].tobytes()


@pytest.mark.parametrize("tolerance", [0, 0.0, -1e-3, math.nan, math.inf, "1e-3", True, 1e-30, 2.0])
def test_an_invalid_tolerance_is_refused_in_one_sentence(tolerance: object) -> None:
    with pytest.raises(ValueError, match=r"^The tolerance is .*; .*must be a number between 1e-11 and 0.5") as error:
        mbs.simulate(system_of("pendulum"), 1.0, tolerance=tolerance)  # type: ignore[arg-type]
    assert repr(tolerance) in str(error.value)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"times": [0.2, 0.1]}, "ascend"),
        ({"times": [0.2, 3.0]}, "between 0 and 1 s"),
        ({"times": [0.1], "h": 0.1}, "Both times and h"),
        ({"t_end": -1.0}, "The end t_end"),
        ({"every": 0}, "every = 0"),
        ({"method": "fast"}, "fast"),
    ],
)
def test_bad_records_are_refused(given: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        mbs.simulate(**({"system": system_of("pendulum"), "t_end": 1.0, "tolerance": 1e-3} | given))  # type: ignore[arg-type]


def test_times_without_a_tolerance_are_refused() -> None:
    with pytest.raises(ValueError, match="times need a tolerance"):
        mbs.simulate(system_of("pendulum"), 1.0, 0.1, times=[0.5])


def test_an_error_beyond_four_tolerances_is_warned_of_with_a_number() -> None:
    """A double pendulum swung high for 40 s: round-off grows by more than the tolerance leaves."""
    m = mbs.Model("double pendulum", dimension=2)
    first = m.point_mass("first", mass=1.0, position=(1.0, 0.1))
    second = m.point_mass("second", mass=1.0, position=(2.0, 0.1))
    m.distance("upper", (m.ground, (0.0, 0.0)), first)
    m.distance("lower", first, second)
    m.sense_position("x", second, None, "x")
    with pytest.warns(AccuracyWarning, match=r"is estimated as .* of the model's length, more than 4 times .* 1e-10"):
        run = mbs.simulate(mbs.compile(m), 60.0, tolerance=1e-10, method="runge_kutta_8")
    assert run.control is not None
    assert not run.control.kept


def test_the_length_is_stated_or_of_the_drawing() -> None:
    def system(**options: float) -> mbs.System:
        m = mbs.Model("pendulum", dimension=2, **options)  # type: ignore[arg-type]
        bob = m.point_mass("bob", mass=1.0, position=(3.0, 4.0))
        m.distance("rod", (m.ground, (0.0, 0.0)), bob)
        return mbs.compile(m)

    assert system().report["length"] == pytest.approx(5.0)
    assert system(length=2.0).report["length"] == 2.0
    assert "2   (stated" in str(system(length=2.0))
    with pytest.raises(mbs.ModelError, match="length of model 'pendulum'"):
        system(length=0.0)
    coarse, fine = (mbs.simulate(system(length=L), 5.0, tolerance=1e-3, method="ali3p") for L in (5.0, 0.05))
    assert coarse.control is not None
    assert fine.control is not None
    assert fine.control.steps > 5 * coarse.control.steps  # the same parts of a hundredth: ten times the steps


@pytest.mark.parametrize("tolerance", [0.5, 0.03])
@pytest.mark.parametrize("method", [None, "ali3p"])
def test_a_loose_tolerance_still_has_two_runs_to_compare(tolerance: float, method: str | None) -> None:
    """The first run is never as fine as the second, however much error is allowed."""
    run = mbs.simulate(printed_model(), 0.5, inputs={"torque": 4.0}, tolerance=tolerance, method=method)
    true = 47.2426  # rad; the motion reduced to its one freedom
    assert run.control is not None
    assert run.control.tolerance == tolerance
    assert run.control.error <= tolerance
    assert abs(run["crank.angle"][-1] - true) <= ALLOWED * tolerance


def test_a_refused_run_names_the_tolerance_that_was_asked_for() -> None:
    with pytest.raises(mbs.SimulationError, match=r"0\.02 \(in an intermediate run towards 0\.001\)"):
        mbs.simulate(printed_model(), 0.5, inputs={"torque": 4.0}, tolerance=1e-3, method="ali3p_no_projection")


def test_what_every_step_gives_right_needs_no_small_one() -> None:
    """Free fall is exact under the trapezoidal rule: differences of runs are round-off and show no order."""
    m = mbs.Model("stone", dimension=3)
    stone = m.point_mass("stone", mass=1.0, position=(0.0, 0.0, 1.0))
    m.sense_position("z", stone, None, "z")
    run = mbs.simulate(mbs.compile(m), 1.0)
    assert run.control is not None
    assert run.control.steps <= 200
    assert run["z"][-1] == pytest.approx(1.0 - 0.5 * 9.81, abs=1e-9)


@pytest.mark.parametrize("method", ["radau_5", "semi_recursive_4"])
def test_runs_of_the_longest_steps_only_still_tell_an_error(method: str) -> None:
    """The tolerance is so loose that steps are bounded by the length of the run: two such runs are the same."""
    m = mbs.Model("pendulum", dimension=2)
    rod = m.body("rod", mass=1.3, com=(0.7, 0.0), inertia=0.05)
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    m.sense_position("y", rod, (0.7, 0.0), "y")
    rate = 1.3 * 9.81 * 0.7 / (0.05 + 1.3 * 0.7**2)
    true = solve_ivp(lambda t, y: [y[1], -rate * math.cos(y[0])], (0, 0.5), [0, 0], method="DOP853", rtol=1e-12)
    run = mbs.simulate(mbs.compile(m), 0.5, tolerance=0.1, method=method)
    assert run.control is not None
    error = abs(run["y"][-1] - 0.7 * math.sin(true.y[0, -1])) / run.control.length
    assert 0.0 < error <= 10.0 * run.control.error


@pytest.mark.parametrize(
    ("method", "reason"), [("radau_5", "no element states"), ("semi_recursive", "needs a System of")]
)
def test_a_method_that_does_not_take_the_system_is_not_blamed_on_the_tolerance(method: str, reason: str) -> None:
    with pytest.raises(mbs.SimulationError, match=reason) as caught:
        mbs.simulate(car_of("kerb_drop"), 1.0, tolerance=1e-2, method=method)
    assert "tolerance" not in str(caught.value)


def test_pieces_of_a_guide_that_limit_the_steps_do_not_make_both_runs_equal() -> None:
    """Steps end at each of 1200 pieces, which a method of order eight passes at any tolerance: both runs were equal,
    and their error was given as 0. A comparison with halved steps gives the least estimate, a tenth of the tolerance.
    """
    rate, t_end = 30.0, 4.0
    t = np.linspace(0.0, t_end, 1201)
    height = np.stack([0.05 * np.cos(rate * t) - 0.05, -0.05 * rate * np.sin(rate * t)], axis=1)
    m = mbs.Model("moved pivot", dimension=2)
    base = m.body("base", mass=1.0, com=(0.0, 0.0), inertia=1.0)
    rod = m.body("rod", mass=1.0, com=(0.01, 0.5), inertia=0.1)
    m.prismatic("slot", m.ground, base, axis=(0.0, 1.0))
    m.revolute("pin", base, rod, point=(0.0, 0.0))
    motion = m.guide_time("motion", PPoly.from_bernstein_basis(BPoly.from_derivatives(t, height)), unit="m")
    m.drive("drive", base.point((0.0, 0.0))[1], motion)
    m.sense_position("x", rod, None, "x")
    control = mbs.simulate(mbs.compile(m), t_end, tolerance=1e-3, method="runge_kutta_8", progress=False).control
    assert control.largest < 0.6 * t[1]
    assert control.error == pytest.approx(1e-4)
