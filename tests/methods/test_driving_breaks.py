"""Steps end where the rate or the acceleration of a prescribed motion jumps, and keep their order there."""

import itertools
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BPoly, CubicSpline, PPoly

import mbs

Array = NDArray[np.float64]
W = 12.0  # rad/s
SPAN = 1.2  # s
STEPS = (0.01, 0.005, 0.0025, 0.00125)  # s
JUMPS = {
    "rate, within a step": PPoly([[0.0, 0.8, -0.5], [0.0, 0.0, 0.32032]], [0.0, 0.3003, 0.7007, 2.0]),
    "rate, at the end of a step": PPoly([[0.0, 0.8, -0.5], [0.0, 0.0, 0.32]], [0.0, 0.3, 0.7, 2.0]),
    "acceleration": PPoly([[0.0, 4.0], [0.0, 0.0], [0.0, 0.0]], [0.0, 0.3003, 2.0]),
    "rate, behind the last piece": PPoly([[0.9], [0.0]], [0.0, 0.5004]),
}


def carried(motion: PPoly | tuple[Array, Array], name: str = "carried") -> mbs.System:
    """A mass of 1 kg on a spring whose other end is moved."""
    m = mbs.Model(name, dimension=2, gravity=(0.0, 0.0))
    base, mass = (m.point_mass(n, mass=1.0, position=(x, 0.0)) for n, x in (("base", 0.0), ("mass", 1.0)))
    for body, x in ((base, 0.0), (mass, 1.0)):
        m.point_on_line(f"line of {body.name}", (body, (x, 0.0)), (m.ground, (x, 0.0)), axis=(1.0, 0.0))
    m.drive("drive", base.point(None)[0], m.guide_time("way", motion, unit="m"))
    m.spring_damper("spring", base, mass, stiffness=W**2, free_length=1.0)
    m.sense_position("x", mass, component="x")
    return mbs.compile(m)


def exact(motion: PPoly, t: Array) -> Array:
    """Of the mass at the times t: x'' = W^2 (s - x), by pieces of s of degree two up to the next break."""
    results, x, v = np.zeros(len(t)), 0.0, 0.0
    ends = [*motion.x[motion.x < SPAN], 2.0 * SPAN]
    for k, (begin, end) in enumerate(itertools.pairwise(ends)):
        c = motion.c[:, k] if k < motion.c.shape[1] else np.array([float(motion(motion.x[-1]))])
        a2, a1, a0 = np.concatenate([np.zeros(3 - len(c)), c])
        z, zd = x - a0 + 2.0 * a2 / W**2, v - a1  # about the motion of a mass that only follows

        def at(s: Array, a=(a2, a1, a0), z=z, zd=zd) -> tuple[Array, Array]:
            swing = z * np.cos(W * s) + zd / W * np.sin(W * s)
            rate = -z * W * np.sin(W * s) + zd * np.cos(W * s)
            return swing + a[0] * s**2 + a[1] * s + a[2] - 2.0 * a[0] / W**2, rate + 2.0 * a[0] * s + a[1]

        here = (t >= begin) & (t < end)
        results[here] = at(t[here] - begin)[0]
        x, v = (float(value) for value in at(np.array(end - begin)))
    return 1.0 + results


@pytest.mark.parametrize(
    ("jump", "method"),
    [
        *((jump, "ali3p") for jump in JUMPS),
        (next(iter(JUMPS)), "energy_momentum"),
        (next(iter(JUMPS)), "ali3p_generalised_alpha"),
    ],
)
def test_order_two_is_kept_through_a_jump(jump, method):
    system, errors = carried(JUMPS[jump]), []
    for h in STEPS:
        run = mbs.simulate(
            system, SPAN, h, method=method, every=round(STEPS[0] / h), estimate_error=False, progress=False
        )
        errors.append(np.abs(run["x"] - exact(JUMPS[jump], run.t)).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.min() > 1.8


@pytest.mark.parametrize("method", ["radau_5", "runge_kutta_8"])
def test_methods_of_higher_order_do_not_see_the_jump(method):
    motion = JUMPS["rate, within a step"]
    run = mbs.simulate(carried(motion), SPAN, 0.02, method=method, estimate_error=False, progress=False)
    assert np.abs(run["x"] - exact(motion, run.t)).max() < 1e-5


def test_a_jump_within_a_step_parts_it_and_one_at_its_end_does_not():
    parts = []
    for jump in JUMPS:
        report = mbs.simulate(carried(JUMPS[jump]), SPAN, 0.01, estimate_error=False, progress=False).report
        assert report is not None
        parts.append(report.divisions)
    assert parts == [2, 0, 1, 1]


def quintics(begin: float, length: float, height: float) -> PPoly:
    """A pulse of two pieces."""
    ends = np.array([0.0, begin, begin + 0.5 * length, begin + length, 2.0])
    pulse = BPoly.from_derivatives(ends, [[value, 0.0, 0.0] for value in (0.0, 0.0, height, 0.0, 0.0)])
    return PPoly.from_bernstein_basis(pulse)


def one_piece(degree: int) -> Callable[[float, float, float], PPoly]:
    """A pulse (4 x (1 - x))^(degree / 2), whose values and, of degree 4, rates are 0 at both ends."""

    def pulse(begin: float, length: float, height: float) -> PPoly:
        shape = np.polynomial.Polynomial([0.0, 4.0, -4.0]) ** (degree // 2)
        c = np.zeros((degree + 1, 3))
        c[:, 1] = height * (shape.coef / length ** np.arange(degree + 1))[::-1]
        return PPoly(c, [0.0, begin, begin + length, 2.0])

    return pulse


@pytest.mark.parametrize(
    ("method", "off"), [("ali3p", 0.2), ("energy_momentum", 0.07), ("radau_5", 0.1), ("runge_kutta_8", 0.1)]
)
@pytest.mark.parametrize("h", [0.01, 0.005, 0.0025])
@pytest.mark.parametrize(("pulse", "mean"), [(quintics, 0.5), (one_piece(2), 2.0 / 3.0), (one_piece(4), 8.0 / 15.0)])
def test_a_pulse_within_a_step_is_met(method, off, h, pulse, mean):
    """The mass gets its impulse, W^2 times the integral of the way, and swings by it over W."""
    length, height = 0.002, 0.2
    system = carried(pulse(0.3032, length, height))
    run = mbs.simulate(system, SPAN, h, method=method, every=round(0.01 / h), estimate_error=False, progress=False)
    assert run.report is not None
    assert run.report.divisions >= 2
    assert np.abs(run["x"] - 1.0).max() == pytest.approx(mean * W * height * length, rel=off)


@pytest.mark.parametrize("limit", [0, 5, 20])
def test_parts_of_a_step_over_a_pulse_share_its_limit_of_iterations(limit):
    """The first and the last piece of the pulse are no jumps."""
    run = mbs.Simulation(carried(quintics(0.3032, 0.002, 0.2)), settings=mbs.Settings(step_iterations=limit))
    iterations = [0]
    for _ in range(60):
        run.step(0.01)
        iterations.append(run.report.iterations)
    assert (np.diff(iterations).max() <= limit) == (limit > 0)
    assert (run.report.divisions > 0) == (limit != 5)


def test_under_a_tolerance_a_step_and_its_halves_share_no_part():
    """The motion begins after a rest, in which steps have grown."""
    ends = np.array([0.0, 0.5, 0.9, 2.0])
    motion = BPoly.from_derivatives(ends, [[value, 0.0, 0.0] for value in (0.0, 0.0, 0.2, 0.2)])
    system = carried(PPoly.from_bernstein_basis(motion))
    true = mbs.simulate(system, SPAN, tolerance=1e-9, method="runge_kutta_8", progress=False)
    run = mbs.simulate(system, SPAN, tolerance=1e-3, method="ali3p", times=true.t, progress=False)
    assert run.control is not None
    assert np.abs(run["x"] - true["x"]).max() < 10.0 * run.control.error
    assert run.report is not None
    assert run.report.divisions == 0


def test_a_motion_of_pieces_that_rest_at_their_ends_divides_no_step():
    """Their accelerations are 0 at both ends and in the middle."""
    ends = np.linspace(0.0, 2.0, 12)
    motion = BPoly.from_derivatives(ends, [[0.1 * (k % 2), 0.0, 0.0] for k in range(12)])
    run = mbs.simulate(carried(PPoly.from_bernstein_basis(motion)), SPAN, 0.01, estimate_error=False, progress=False)
    assert run.report is not None
    assert run.report.divisions == 0


def test_a_spline_through_samples_is_no_jump_at_each():
    """Its acceleration is continuous, also through noise; with straight lines between the samples each is a jump."""
    t = np.linspace(0.0, 2.0, 401)
    samples = 0.1 * np.sin(3.0 * t) ** 2 + 1e-4 * np.random.default_rng(1).normal(size=len(t))
    straight = PPoly(np.array([np.diff(samples) / np.diff(t), samples[:-1]]), t)
    for motion, jumps in ((CubicSpline(t, samples, bc_type="clamped"), False), (straight, True)):
        run = mbs.simulate(carried(motion), 1.0, 0.01, estimate_error=False, progress=False)
        assert run.report is not None
        assert (run.report.divisions > 30) == jumps
        assert (run.report.divisions > 0) == jumps


def test_lanes_and_steps_by_hand_end_there_too():
    system, (n, h) = carried(JUMPS["rate, within a step"]), (120, 0.01)
    run = mbs.simulate(system, n * h, h, estimate_error=False, progress=False)
    many = mbs.simulate_many(system, [mbs.Variant(), mbs.Variant()], n * h, h, estimate_error=False, progress=False)
    by_hand = mbs.Simulation(system)
    by_hand.step(h, n)
    assert [part["x"][-1] for part in many.trajectories if part is not None] == [run["x"][-1]] * 2
    assert by_hand.sensors["x"] == run["x"][-1]
