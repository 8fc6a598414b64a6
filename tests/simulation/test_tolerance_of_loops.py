"""Runs to a tolerance of closed loops near positions at which branches of their motion meet."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly

import mbs
from benchmarks.methods import random_mechanisms
from benchmarks.references.cases import system_of
from mbs.settings.input_signals import InputSignals
from mbs.simulation import controlled_run
from mbs.simulation.controlled_run import ControlledRun, Task
from tests.fmu.scenes import driven_crank, piston_of


def near_equal_arms() -> mbs.System:
    """A slider-crank driven at 6.4 rad/s whose rod is longer than the crank by a five-hundredth: upright, the slider
    turns back within 0.06 rad. A step that turns it by more goes on to the other side, and so do its halves.
    """
    crank, rod, angle = 0.8, 0.8016, 0.4
    pin = np.array([np.cos(angle), np.sin(angle)]) * crank
    end = np.array([pin[0] + np.sqrt(rod**2 - pin[1] ** 2), 0.0])
    m = mbs.Model("near equal arms", dimension=2)
    bodies = [
        m.body("crank", mass=0.7, com=0.5 * pin, inertia=0.05),
        m.body("rod", mass=4.0, com=0.5 * (pin + end), inertia=0.3),
    ]
    slider = m.point_mass("slider", mass=5.0, position=end)
    m.revolute("O", m.ground, bodies[0], point=(0.0, 0.0))
    m.revolute("A", *bodies, point=pin)
    m.spherical("B", bodies[1], slider, point=end)
    m.point_on_line("line", (slider, end), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    turned = m.relative_angle("angle", m.ground, bodies[0])
    m.drive("drive", turned, m.guide_time("guide", PPoly([[6.4], [0.0]], [0.0, 4.0]), unit="rad"))
    m.spring_damper("spring", (m.ground, (0.0, 1.0)), (slider, end), stiffness=100.0)
    m.sense_position("x", slider, end, "x")
    return mbs.compile(m)


@pytest.mark.parametrize(("method", "tolerance"), [("ali3p", 1e-2), ("runge_kutta_8", 1e-2)])
def test_steps_do_not_jump_where_branches_are_near(method: str, tolerance: float) -> None:
    system = near_equal_arms()
    run = mbs.simulate(system, 1.3, tolerance=tolerance, method=method, progress=False)
    angle = 0.4 + 6.4 * run.t
    exact = 0.8 * np.cos(angle) + np.sqrt(0.8016**2 - (0.8 * np.sin(angle)) ** 2)
    assert np.abs(run["x"] - exact).max() < 10.0 * tolerance * run.control.length


def test_arms_that_are_folded_do_not_hide_the_joint_that_passes() -> None:
    """A driven slider-crank, its rod longer by 0.0025: folded, the sine between its arms is nothing and changes sign by
    interpolation, while a step of a radian and both its halves take the rod to the other side.
    """
    mechanism = random_mechanisms.random_mechanism(np.random.default_rng([3, 12]), 2)[1]
    pin, _, end = mechanism.tips
    crank, rod, turned = np.linalg.norm(pin), np.linalg.norm(end - pin), mechanism.drive
    assert 0.0 < rod / crank - 1.0 < 3e-3
    assert turned is not None
    system, times = mbs.compile(random_mechanisms.model_of(mechanism)), np.linspace(0.0, mechanism.span, 51)
    run = mbs.simulate(system, mechanism.span, tolerance=1e-2, times=times, progress=False)
    assert run.control is not None
    angle = np.arctan2(pin[1], pin[0]) + turned(run.t)
    exact = crank * np.cos(angle) + np.sqrt(rod**2 - (crank * np.sin(angle)) ** 2)
    assert np.abs(run["tip2.x"] - exact).max() < 10.0 * 1e-2 * run.control.length


def test_a_place_where_branches_are_near_is_reached_in_few_steps() -> None:
    """Ten of them: 11 580 factorizations where the step creeps up to each, 6084 where it goes there at once."""
    settings = mbs.Settings(method="runge_kutta_8")
    task = Task(0.0, 10.0, np.array([10.0]), InputSignals({}, []))
    simulation = mbs.Simulation(system_of("double_four_bar"), settings=settings)
    ControlledRun(simulation, task, settings, 1e-6).finish(lambda share: None)
    assert simulation.report.factorizations < 8000


def parallelogram(turned: float, rate: float) -> tuple[mbs.System, Callable[[mbs.Trajectory], float]]:
    """One that turns through its flat positions, and how far a run of 51 samples is off the pendulum that it is, m."""
    ends, width = 0.3 * np.array([np.cos(turned), np.sin(turned)]), np.array([1.0, 0.0])
    across = 0.3 * rate * np.array([-np.sin(turned), np.cos(turned)])
    m = mbs.Model("parallelogram", dimension=2, gravity=(0.0, -9.81))
    rod = m.body("rod", mass=1.0, com=0.5 * width + ends, inertia=0.5)
    for i in range(2):
        crank = m.body(f"crank {i}", mass=1.0, com=i * width + 0.5 * ends, inertia=0.0075)
        m.revolute(f"foot {i}", m.ground, crank, point=i * width)
        m.revolute(f"head {i}", crank, rod, point=i * width + ends)
        m.initial_velocity(crank, linear=0.5 * across, angular=rate)
    m.initial_velocity(rod, linear=across)
    for axis in "xy":
        m.sense_position(axis, rod, None, axis)
    inertia, weight = 2.0 * (0.0075 + 0.15**2) + 0.09, 9.81 * (0.3 + 0.3)
    angle = solve_ivp(
        lambda _, y: [y[1], -weight * np.cos(y[0]) / inertia], (0.0, 2.0), [turned, rate], method="DOP853",
        t_eval=np.linspace(0.0, 2.0, 51), rtol=1e-11, atol=1e-12,
    ).y[0]  # fmt: skip

    def off(run: mbs.Trajectory) -> float:
        return float(np.hypot(run["x"] - 0.5 - 0.3 * np.cos(angle), run["y"] - 0.3 * np.sin(angle)).max())

    return mbs.compile(m), off


@pytest.mark.parametrize(("turned", "rate"), [(0.4, 8.5), (0.6, -8.8)])
def test_rows_are_closed_so_well_that_flat_positions_give_no_kick(turned: float, rate: float) -> None:
    """By a tree that is cut; with rows that are open by 1e-7 of the tolerance 0.15 and 2853 tolerances off."""
    system, off = parallelogram(turned, rate)
    times = np.linspace(0.0, 2.0, 51)
    run = mbs.simulate(system, 2.0, tolerance=1e-4, times=times, method="semi_recursive", progress=False)
    assert run.control is not None
    assert off(run) < 0.05 * 1e-4 * run.control.length


def test_a_method_that_does_not_keep_a_tolerance_hands_on_to_another(monkeypatch: pytest.MonkeyPatch) -> None:
    tolerance = 1e-5
    monkeypatch.setattr(controlled_run, "ROUND_OFF", 1e-12)  # to which a loop that is cut is closed
    system, off = parallelogram(0.6, -8.8)
    with pytest.warns(mbs.AccuracyWarning, match="name another method than 'semi_recursive'"):
        mbs.simulate(system, 2.0, tolerance=tolerance, method="semi_recursive", progress=False)
    run = mbs.simulate(system, 2.0, tolerance=tolerance, times=np.linspace(0.0, 2.0, 51), progress=False)
    assert run.control is not None
    assert run.control.method == "radau_5"
    assert "semi_recursive cannot hold it" in run.control.reason
    assert off(run) < tolerance * run.control.length


@pytest.mark.parametrize(("speed", "longer"), [(20.0, 0.05), (50.0, 0.01)])
def test_a_loop_that_is_driven_fast_does_not_pass_to_another_branch(speed: float, longer: float) -> None:
    """Its drive leaves no error that would limit steps: they are at most half a radian of it."""
    run = mbs.simulate(
        mbs.compile(driven_crank(speed, longer)), 2.0, tolerance=1e-2, times=np.linspace(0.0, 2.0, 101), progress=False
    )
    assert run.control is not None
    assert np.abs(run["piston.x"] - piston_of(speed, longer, run.t)).max() < 0.1 * run.control.length
    assert run.control.largest < 1.01 * 0.5 / speed
