"""The error estimate of a run: warnings with numbers, refined runs of suspects only, and none at rest."""

import re

import numpy as np
import pytest

import mbs
from benchmarks.methods.honesty_scenes import printed_model
from benchmarks.references.cases import CASES, exact_of, system_of
from mbs import AccuracyWarning, Model, Pose, Settings, Simulation, SimulationError, compile, simulate
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.accuracy import step_divisor
from mbs.results.comparison import compared_sensors
from mbs.scenes import prototype_car
from mbs.simulation import fixed_steps

TORQUE = {"torque": 4.0}
QUIET = {"progress": False}


@pytest.fixture
def starts(monkeypatch):
    """Keyword arguments of every Simulation that is made."""
    results = []
    original = Simulation.__init__

    def note(self, system, **more):
        results.append(more)
        original(self, system, **more)

    monkeypatch.setattr(Simulation, "__init__", note)
    return results


def oscillator():
    """A mass on a spring from a parameter, pushed by an input, free to start anywhere."""
    m = Model("oscillator", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
    spring = m.spring_damper(
        "spring", (m.ground, (0.0, 0.0)), (mass, None), stiffness=100.0, damping=0.0, free_length=0.9
    )
    m.parameter("stiffness", 100.0, 1.0, 1e4, "N/m", targets=[(spring, "stiffness", 1.0)])
    m.point_on_line("rail", (mass, None), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    push = m.input("push", min=-50.0, max=50.0, unit="N")
    m.force("push", mass, inputs=[push, None])
    m.sense_position("x", mass, None, "x")
    return compile(m)


class TestThePrintedModel:
    def test_it_warns_with_numbers_and_a_remedy(self):
        with pytest.warns(AccuracyWarning, match=r"J of work, .* % of the .* J in the motion") as caught:
            run = simulate(printed_model(), 2.0, 1e-3, TORQUE, **QUIET)
        assert len(caught) == 1
        text = str(caught[0].message)
        assert caught[0].filename == __file__
        assert text == run.accuracy.message
        assert "tolerance=1e-3" in text
        assert run.accuracy.energy_balance > WRONG_ERROR
        assert "energy balance open by" in repr(run)
        assert "halvings a step" in str(run)

    def test_false_checks_nothing(self, starts):
        run = simulate(printed_model(), 2.0, 1e-3, TORQUE, estimate_error=False, **QUIET)
        assert len(starts) == 1
        assert run.accuracy.message == ""
        assert run.accuracy.energy_balance > WRONG_ERROR  # what is free is there all the same

    def test_the_step_named_by_a_warning_has_the_stated_error(self):
        system, case = system_of("pendulum"), CASES["pendulum"]
        with pytest.warns(AccuracyWarning, match="were tried: they are off by about") as caught:
            simulate(system, case.end, 0.05, **QUIET)
        named = r"Steps of (\S+) s were tried: they are off by about (\S+) %"
        step, off = map(float, re.search(named, str(caught[0].message)).groups())
        every = round(case.end / 50 / step)
        fine = simulate(system, case.end, case.end / 50 / every, every=every, **QUIET)
        exact = exact_of("pendulum").T
        error = max(np.abs(fine[s] - x).max() / np.ptp(exact) for s, x in zip(case.sensors, exact, strict=True))
        assert error == pytest.approx(0.01 * off, rel=0.2)


class TestRepeats:
    def test_a_smooth_run_is_made_once(self, starts):
        run = simulate(system_of("pendulum"), 1.0, 0.001, **QUIET)
        assert len(starts) == 1
        assert run.accuracy.compared_step is None
        assert run.accuracy.error is None
        assert run.accuracy.message == ""

    @pytest.mark.parametrize(("every", "longer"), [(1, 8.0), (19, 9.5)])
    def test_a_right_run_is_compared_with_one_of_about_eight_times_the_step(self, starts, every, longer):
        run = simulate(system_of("pendulum"), 10.0, 0.005, every=every, **QUIET)
        assert len(starts) == 2
        assert run.accuracy.compared_step == pytest.approx(0.005 * longer, rel=1e-12)
        assert run.accuracy.check_cost == pytest.approx(1.0 / longer, rel=1e-12)
        assert "checked by runs of 0.1" in repr(run)
        whole = simulate(system_of("pendulum"), 10.0, 0.005, estimate_error=True, **QUIET)
        # So long steps err by less than order two says: the estimate is 0.69 of that by half the step.
        assert run.accuracy.error == pytest.approx(whole.accuracy.error, rel=0.5)

    @pytest.mark.parametrize(("scene", "h"), [("pendulum", 0.02), ("double_four_bar", 0.01)])
    def test_the_estimate_is_within_a_factor_of_two_of_the_error(self, scene, h):
        case = CASES[scene]
        every = round(case.end / 50 / h)
        run = simulate(system_of(scene), case.end, h, every=every, estimate_error=True, **QUIET)
        error = max(np.abs(run[s] - x).max() for s, x in zip(case.sensors, exact_of(scene).T, strict=True))
        assert 0.5 < max(run.accuracy.sensors[s] for s in case.sensors) / error < 2.0
        assert run.accuracy.message == ""

    def test_what_is_halved_inside_is_repeated_with_less_than_its_parts(self):
        """The governor at 0.2 s halves to the steps that 0.05 s makes: a plain half would differ by nothing."""
        assert step_divisor(100, 0) == 2
        assert step_divisor(100, 100) == 4
        assert step_divisor(100, 1500) == 32
        with pytest.warns(AccuracyWarning) as caught:
            run = simulate(system_of("flyball"), 10.0, 0.2, estimate_error=True, **QUIET)
        assert run.accuracy.halvings_per_step > 0.1
        assert run.accuracy.compared_step < 0.1
        assert run.accuracy.error > 0.05
        assert len(caught) == 1

    @pytest.mark.parametrize(
        "more",
        [
            {"parameters": {"stiffness": 400.0}},
            {"inputs": {"push": lambda t: 20.0 * np.sin(7.0 * t)}},
            {"inputs": {"push": ([0.0, 1.0, 1.0, 4.0], [0.0, 0.0, 30.0, -30.0])}},
            {"inputs": {"push": lambda t: 20.0 * np.sin(7.0 * t)}, "t0": 1.0},
            {"settings": Settings(tolerance_r=1e-12), "method": "ali3p_generalised_alpha"},
            {"every": 7},
        ],
    )
    def test_it_is_the_same_run_but_for_the_step(self, more, starts):
        """What a repeat did not get would show as an error a hundred times as large."""
        system = oscillator()
        run = simulate(system, 3.0, 0.001, estimate_error=True, **{"every": 1} | more, **QUIET)
        assert run.accuracy.error < 5e-3
        assert len(starts) == 2
        assert starts[0] == starts[1]

    @pytest.mark.parametrize("every", [30, 5000])
    def test_few_samples_do_not_hide_or_make_an_error(self, every):
        """The range is that of the motion, not that of two samples which may be where it began."""
        system, case = system_of("pendulum"), CASES["pendulum"]
        run = simulate(system, case.end, 0.01, every=every, estimate_error=True, **QUIET)
        plain = simulate(system, case.end, 0.01, every=every, estimate_error=False, **QUIET)
        assert run.t.tolist() == plain.t.tolist()
        assert all(run[name].tolist() == plain[name].tolist() for name in plain)
        assert 0.002 < run.accuracy.error < 0.01
        with pytest.warns(AccuracyWarning, match=r"'bob.position.[xy]'"):
            simulate(system, case.end, 0.05, every=every, **QUIET)

    def test_a_run_at_rest_has_nothing_to_judge(self):
        m = Model("hanging", dimension=2)
        bar = m.body("bar", mass=1.0, com=(0.0, -1.0), inertia=0.1)
        m.revolute("hinge", m.ground, bar, point=(0.0, 0.0))
        m.sense_position("x", bar, None, "x")
        m.sense_position("y", bar, None, "y")
        for method in ("ali3p", "energy_momentum", "runge_kutta_8", "radau_5"):
            run = simulate(compile(m), 5.0, 0.05, method=method, estimate_error=True, **QUIET)
            assert run.accuracy.units == {}
            assert run.notices == ()
            assert run.accuracy.message == ""
            assert simulate(compile(m), 5.0, 0.05, method=method, **QUIET).accuracy.check_cost == 0.0

    @pytest.mark.parametrize("estimate_error", [None, True])
    def test_a_vibration_that_counts_as_rest_is_said_to_be_unchecked(self, estimate_error):
        """A spindle at 1.5 m that vibrates by 20 um at 50 Hz: in steps of 2 ms it was off by all of it without a word.

        Each remedy of the notice leads to the warning.
        """
        rate, height = 100.0 * np.pi, 2e-5

        def run(displacement=False, length=None):
            m = Model("spindle", dimension=2, gravity=(0.0, 0.0), length=length)
            head = m.point_mass("head", mass=10.0, position=(1.5, 0.0))
            m.point_on_line("slide", (head, None), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
            column = (m.ground, (0.0, 0.0)), (head, None)
            m.spring_damper("column", *column, stiffness=10.0 * rate**2, free_length=1.5)
            m.initial_velocity(head, (height * rate, 0.0))
            if displacement:
                m.sense_coordinate("x", head.point()[0] - 1.5, unit="m")
            else:
                m.sense_position("x", head, None, "x")
            return simulate(compile(m), 1.0, 0.002, estimate_error=estimate_error, **QUIET)

        (notice,) = run().notices
        assert "not checked: sensor 'x' moves farthest, by 4e-05 m at values up to 1.5 m" in notice
        for remedy in ({"displacement": True}, {"length": 1e-3}):
            with pytest.warns(AccuracyWarning, match="The result is off by"):
                assert run(**remedy).notices == ()

    def test_a_repeat_that_is_refused_is_warned_of(self, monkeypatch):
        march = fixed_steps.march

        def refuse(simulation, t_end, h, *more):
            if h < 0.01:
                raise SimulationError("it fell apart", 0.5, 7)
            return march(simulation, t_end, h, *more)

        monkeypatch.setattr(fixed_steps, "march", refuse)
        with pytest.warns(AccuracyWarning, match="refined run with steps of 0.005 s was refused.*fell apart"):
            simulate(system_of("pendulum"), 1.0, 0.01, estimate_error=True, **QUIET)

    def test_the_bar_covers_the_repeat(self):
        shares: list[float] = []
        simulate(system_of("pendulum"), 2.0, 0.01, estimate_error=True, progress=shares.append)
        assert shares == sorted(shares)
        assert shares[-1] == 1.0
        assert any(0.3 < s < 0.34 for s in shares)


def test_a_run_that_blew_up_is_reported_in_a_number_that_can_be_read():
    m = Model("stiff", dimension=2)
    mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
    m.spring_damper("spring", (m.ground, (0.0, 0.0)), (mass, None), stiffness=1e6, damping=0.0, free_length=0.999)
    m.sense_position("x", mass, None, "x")
    with pytest.warns(AccuracyWarning, match=r"off by at least [\d.]+e\+\d+ % of"):
        simulate(compile(m), 1.0, 0.01, method="runge_kutta_8", **QUIET)


def test_a_run_of_one_step_is_not_refused_by_its_own_twin():
    """A twin of twice the step would be longer than the run; shorter ones judge it instead."""
    car = compile(prototype_car.build())
    one = simulate(car, 0.01, 0.01, **QUIET)
    assert len(one.t) == 2
    assert one.accuracy.compared_step == 0.005
    with pytest.warns(AccuracyWarning, match="ends at 0.01 s"):
        assert simulate(car, 0.015, 0.01, **QUIET).t[-1] == 0.01
    with pytest.raises(ValueError, match=r"The step h is 0\.01 s, longer than the run of 0\.005 s"):
        simulate(car, 0.005, 0.01, **QUIET)


def test_what_jumps_is_not_judged():
    names = compared_sensors(compile(prototype_car.build()))
    judged = {name for name, what in names.items() if what.always}
    assert {names[n].unit for n in judged} == {"m", "rad", "N"}
    assert {"chassis.x", "chassis.yaw", "chassis.pitch", "wheel_FL.Fz", "wheel_FL.travel"} <= judged
    assert names["chassis.yaw"].wrapped
    assert not {"gear", "energy.total", "chassis.ax", "wheel_FL.omega", "solver.violation"} & judged


def test_a_motion_in_thirds_is_judged_by_the_range_of_all_of_them():
    """A pendulum on a cart that is pulled: within each third it goes about half as far as in all, and is 3 % off."""
    m = Model("cart", dimension=2)
    cart = m.body("cart", mass=20.0, com=(0.0, 0.0), inertia=1.0)
    m.prismatic("rail", cart, m.ground, axis=(1.0, 0.0))
    m.force("pull", cart, inputs=(m.input("pull", unit="N"), None))
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.02)
    m.revolute("hinge", cart, rod, point=(0.0, 0.0))
    names = [f"{body.name}.{c}" for body in (cart, rod) for c in "xy"]
    for name, body in zip(names, (cart, cart, rod, rod), strict=True):
        m.sense_position(name, body, component=name[-1])
    system, inputs, h = compile(m), {"pull": 12.0}, 0.06
    simulation = Simulation(system, inputs=inputs)
    parts = [simulation.run(k * h, h, progress=False) for k in (24, 48, 72)]  # warnings are errors here
    whole = simulate(system, 72 * h, h, inputs=inputs, **QUIET)
    fine = simulate(system, 72 * h, h / 32, inputs=inputs, every=32, estimate_error=False, **QUIET)
    largest = max(np.ptp(fine[name]) for name in names)
    assert max(np.abs(whole[name] - fine[name]).max() for name in names) < 0.05 * largest
    assert max(np.ptp(part[name]) for part in parts for name in names) < 0.8 * largest


def test_steps_by_hand_warn_once_from_the_balance():
    simulation = Simulation(printed_model(), inputs=TORQUE)
    with pytest.warns(AccuracyWarning, match="J of work") as caught:
        simulation.step(5e-4, 4000)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    simulation.step(5e-4, 10)  # warnings are errors here


@pytest.mark.parametrize("value", ["yes", 0.0, -1, 1e7, float("nan")])
def test_estimate_error_is_true_false_or_a_budget(value):
    with pytest.raises(ValueError, match="estimate_error = .*; it must be True, False or None .* a number above 0"):
        simulate(system_of("pendulum"), 1.0, 0.01, estimate_error=value)


def test_wheel_loads_of_a_car_that_is_too_fast_for_its_step_are_reported():
    """Down a kerb of 12 cm at 30 m/s: 5.5 % off at 20 ms against steps of 0.2 ms, right at 2 ms."""
    system = compile(prototype_car.build())

    def run(h: float, t_end: float) -> mbs.Trajectory:
        return simulate(system, t_end, h, parameters=edge, pose=Pose(speed=30.0))

    edge = {"road.kerb_x": 4.0, "road.kerb_height": 0.12}
    with pytest.warns(AccuracyWarning, match=r"off by about [56]\.?\d? % .*wheel_"):
        result = run(0.02, 1.3)
    assert result.accuracy.error == pytest.approx(0.055, rel=0.15)
    assert run(0.002, 1.3).accuracy.message == ""
    level = simulate(system, 1.3, 0.01, pose=Pose(speed=20.0), parameters={"road.kerb_x": 200.0})
    assert level.accuracy.check_cost == 0.0
