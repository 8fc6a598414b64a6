"""Inputs that jump or peak within steps, and repeats of runs whose first repeats are off alike."""

import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import mbs
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.settings.input_breaks import function_breaks, input_breaks, sample_function
from mbs.settings.input_signals import InputSignals
from tests.simulation.drawn import drawn

H = 0.02  # s
SPAN = 1.0  # s
Table = tuple[np.ndarray, np.ndarray]


def table(*points: tuple[float, float]) -> Table:
    t, x = np.array(points, float).T
    return t, x


def pulse(begin: float, lasting: float, height: float = 100.0) -> Table:
    """A triangle."""
    return table((0.0, 0.0), (begin, 0.0), (begin + 0.5 * lasting, height), (begin + lasting, 0.0), (9.0, 0.0))


def push(begin: float, lasting: float, force: float = 50.0) -> Table:
    """A rectangle."""
    end = begin + lasting
    return table((0.0, 0.0), (begin, 0.0), (begin, force), (end, force), (end, 0.0), (9.0, 0.0))


def sledge(stiffness: float = 0.0) -> mbs.System:
    """2 kg on a line, pushed by an input, on a spring or free."""
    m = mbs.Model("sledge", dimension=2, gravity=(0.0, 0.0))
    body = m.body("body", mass=2.0, com=(1.0, 0.0), inertia=0.1)
    m.prismatic("guide", body, m.ground, axis=(1.0, 0.0))
    if stiffness > 0.0:
        m.spring_damper("spring", (m.ground, (0.0, 0.0)), (body, (1.0, 0.0)), stiffness=stiffness)
    m.force("push", body, inputs=[m.input("push", unit="N"), None])
    m.sense_position("x", body, None, "x")
    return mbs.compile(m)


@pytest.mark.parametrize(
    ("given", "breaks"),
    [
        pytest.param(pulse(0.302, 0.016), [0.302, 0.31, 0.318], id="a peak within a step"),
        pytest.param(pulse(0.302, 0.03), [0.302, 0.317, 0.332], id="its height between two steps"),
        pytest.param(pulse(0.28, 0.04), [], id="from step to step"),
        pytest.param(push(0.305, 9.0), [0.305], id="a jump"),
        pytest.param(push(0.3, 0.02), [], id="jumps at ends of steps"),
        pytest.param(push(0.3, 0.005), [0.305], id="a push from the end of a step"),
        pytest.param(push(0.305, 0.01), [0.305, 0.315], id="a push within a step"),
        pytest.param(push(0.3 + 1e-9, 9.0), [], id="a jump at the end of a step but for its round-off"),
        pytest.param(push(1.305, 9.0), [], id="after the run"),
        pytest.param(table((0.0, 0.0), (0.305, 0.0), (0.306, 5.0), (1.0, 5.0)), [0.305, 0.306], id="a steep ramp"),
        pytest.param(table((0.0, 0.0), (0.305, 0.0), (0.405, 5.0), (1.0, 5.0)), [], id="a ramp"),
        pytest.param(
            table((0.0, 0.0), (0.304, 0.0), (0.309, 0.04), (0.314, 0.0), (1.0, 1.0)), [], id="noise"
        ),
        pytest.param(table((0.305, 5.0)), [], id="a constant"),
    ],
)  # fmt: skip
def test_steps_are_parted_where_a_table_does_not_go_straight(given: Table, breaks: list[float]) -> None:
    assert input_breaks([given], 0.0, SPAN, H) == pytest.approx(breaks)


def test_breaks_of_two_tables_at_one_time_are_one() -> None:
    both = [push(0.305, 0.1), push(np.nextafter(0.305, 1.0), 0.2)]
    assert input_breaks(both, 0.0, SPAN, H) == pytest.approx([0.305, 0.405, 0.505])


def test_a_whole_number_holds_until_the_next() -> None:
    """A lever that is pulled for 10 ms; as a table of points it would rise from the start on."""
    lever = table((0.0, 0.0), (0.305, 1.0), (0.315, 0.0))
    declared = [{"name": n, "unit": "1", "min": None, "max": None, "whole": n == "lever"} for n in ("lever", "other")]
    signals = InputSignals({"lever": lever, "other": 3.0}, declared)
    assert signals.breaks(0.0, SPAN, H) == pytest.approx([0.305, 0.315])


@pytest.mark.parametrize(("lasting", "beside"), [(0.3, False), (4.6, True)])
@pytest.mark.parametrize("method", ["ali3p", "ali3p_generalised_alpha", "energy_momentum", "semi_recursive", "radau_5"])
def test_a_push_that_begins_and_ends_within_steps(lasting: float, method: str, beside: bool) -> None:
    """x = F/2m (t - t1)^2, less the same behind the end; a function of time beside the table changes nothing."""
    m = mbs.Model("free", dimension=2, gravity=(0.0, 0.0))
    body = m.body("body", mass=2.0, com=(1.0, 0.0), inertia=0.1)
    m.prismatic("guide", body, m.ground, axis=(1.0, 0.0))
    m.force("push", body, inputs=[m.input("push", unit="N"), m.input("across", unit="N")])
    m.sense_position("x", body, None, "x")
    begin, end = 5.05 * H, (5.05 + lasting) * H
    across = {"across": lambda t: 3.0 * t} if beside else {}
    inputs = {"push": push(begin, end - begin), **across}
    run = mbs.simulate(mbs.compile(m), SPAN, H, inputs, method=method, progress=False, estimate_error=False)
    behind = [np.maximum(0.0, run.t - at) for at in (begin, end)]
    assert run["x"] - 1.0 == pytest.approx(12.5 * (behind[0] ** 2 - behind[1] ** 2), abs=1e-9)
    assert run.report is not None
    assert run.report.divisions == 2


def by_many(system: mbs.System, inputs: dict[str, Any]) -> mbs.Trajectory:
    result = mbs.simulate_many(system, [mbs.Variant(inputs=inputs)], SPAN, H, progress=False).trajectories[0]
    assert result is not None
    return result


RUNS: dict[str, Callable[[mbs.System, dict[str, Any]], mbs.Trajectory]] = {
    "simulate": lambda system, inputs: mbs.simulate(system, SPAN, H, inputs, progress=False),
    "by hand": lambda system, inputs: mbs.Simulation(system).run(SPAN, H, inputs=inputs, progress=False),
    "many": by_many,
}


FUNCTIONS: dict[str, Callable[[float, float], tuple[Callable[[float], float], float]]] = {
    "rectangle": lambda begin, end: (lambda t: float(begin <= t < end), 1.0),
    "triangle": lambda begin, end: (lambda t: max(0.0, 1.0 - abs(2.0 * (t - begin) / (end - begin) - 1.0)), 0.5),
    "half a sine": lambda begin, end: (
        lambda t: np.sin(np.pi * min(1.0, max(0.0, (t - begin) / (end - begin)))),
        2.0 / np.pi,
    ),
}
"""A pulse of a function with its height, 1, and its mean."""


@pytest.mark.parametrize("kind", FUNCTIONS)
@pytest.mark.parametrize("way", ["simulate", "many", "tolerance"])
def test_a_pulse_of_a_function_within_a_step_moves_its_body(kind: str, way: str) -> None:
    """Of a tenth to the whole of a step, also one that begins where a step ends: the impulse moves the sledge."""
    system = sledge()
    for begin, lasting in ((0.3, 0.1), (0.303, 0.37), (0.301, 0.9)):
        end = begin + lasting * H
        shape, mean = FUNCTIONS[kind](begin, end)
        height = 1.6 / (mean * lasting * H)
        inputs = {"push": lambda t, shape=shape, height=height: height * shape(t)}
        if way == "tolerance":
            run = mbs.simulate(system, SPAN, inputs=inputs, tolerance=1e-4, progress=False)
        else:
            run = RUNS[way](system, inputs)
        moved = 1.6 / 2.0 * (SPAN - 0.5 * (begin + end))
        assert run["x"][-1] - 1.0 == pytest.approx(moved, rel=1e-5 if "rectangle" in kind else 2e-2)


@pytest.mark.parametrize("way", ["simulate", "tolerance"])
def test_a_jump_of_a_function_counts_from_its_time_on(way: str) -> None:
    """At the end of a step or within one, and whichever value the function has at that very time."""
    for begin in (0.3, 0.305):
        for at in (0.0, 1.0):
            push = {"push": lambda t, begin=begin, at=at: 50.0 if t > begin else 50.0 * at * (t == begin)}
            more = {"h": H} if way == "simulate" else {"tolerance": 1e-5}
            run = mbs.simulate(sledge(), SPAN, inputs=push, progress=False, **more)
            assert run["x"][-1] - 1.0 == pytest.approx(12.5 * (SPAN - begin) ** 2, rel=1e-5)


def test_a_function_is_asked_ahead_once_for_all_runs_to_a_tolerance() -> None:
    requested = []

    def push(t: float) -> float:
        requested.append(t)
        return 50.0 * (t > 0.305)

    run = mbs.simulate(sledge(800.0), SPAN, inputs={"push": push}, tolerance=1e-3, progress=False)
    assert run.control is not None
    assert run.control.runs > 2
    assert requested.count(SPAN / 16_000.0) == 1


def test_a_function_that_fails_is_looked_at_until_then() -> None:
    """The step that asks it there says so, as if nobody had asked ahead; noise is no breaks without end."""

    def failing(t: float) -> float:
        if t > 0.5:
            raise ZeroDivisionError
        return float(t > 0.305)

    t, x = sample_function(failing, 0.0, SPAN, H)
    assert t[-1] <= 0.5
    assert input_breaks([(t, x)], 0.0, SPAN, H) == pytest.approx([0.305])
    simulation = mbs.Simulation(sledge())
    with pytest.raises(ZeroDivisionError):
        simulation.run(SPAN, H, inputs={"push": failing}, progress=False, estimate_error=False)
    assert simulation.time == pytest.approx(0.5)
    noise = np.random.default_rng(1)
    assert len(sample_function(lambda t: noise.normal(), 0.0, SPAN, H)[0]) <= 2 * 16 * 50 + 1
    assert len(sample_function(lambda t: 1.0 / 0.0, 0.0, SPAN, H)[0]) == 1


def test_round_off_of_a_constant_parts_no_step() -> None:
    def constant(t: float) -> float:
        return float(np.sin(np.float32(t)) ** 2 + np.cos(np.float32(t)) ** 2)

    for function in (constant, lambda t: 0.1 * (t + 1.0) / (t + 1.0)):
        t, x = sample_function(function, 0.0, SPAN, H)
        assert np.ptp(x) > 0.0
        assert len(t) == 16 * 50 + 1
        assert len(input_breaks([(t, x)], 0.0, SPAN, H)) == 0
    pulse = sample_function(lambda t: 1.0 + 1e-5 * (0.305 <= t < 0.31), 0.0, SPAN, H)
    assert set(input_breaks([pulse], 0.0, SPAN, H).round(6)) == {0.305, 0.31}


def test_a_jump_late_in_a_long_run_lies_between_two_neighbouring_times() -> None:
    """There is no number between them, however short the step."""
    for start, h in ((1e4, 1e-6), (1e7, 1e-3)):
        for share in np.linspace(0.1, 0.9, 9):
            when = start + (7.0 + share) * h
            _, jumps = function_breaks(lambda t, when=when: float(t > when), start, start + 20.0 * h, h)
            ((before, behind),) = jumps
            assert before <= when < behind
            assert behind - before <= 2.0 * np.spacing(start)
    assert len(sample_function(lambda t: 1e308 if t > 0.5 else -1e308, 0.0, SPAN, H)[0]) == 1


def test_a_smooth_function_parts_no_step() -> None:
    for rate in (0.0, 3.0, 0.14 / H, 0.3 / H):
        assert len(function_breaks(lambda t, w=rate: np.sin(2.0 * np.pi * w * t), 0.0, SPAN, H)[0]) == 0


@pytest.mark.slow
def test_a_pulse_in_a_long_run_is_met_with_little_memory() -> None:
    """Samples are kept for a part of the run; a jump at the border of two parts is found once."""
    requested, h = [0], 1e-3

    def pulse(t: float) -> float:
        requested[0] += 1
        return float(9.0003 <= t < 9.0004) + float(t > 4096 * h) + 2.0 * float(t >= 8192 * h)

    tracemalloc.start()
    times, jumps = function_breaks(pulse, 0.0, 10.0, h)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert times == pytest.approx([9.0003, 9.0004], abs=1e-9)
    assert [before for before, _ in jumps] == pytest.approx([4.096, 8.192, 9.0003, 9.0004], abs=1e-8)
    assert requested[0] < 17.5 * 10_000
    assert most < 64 * 16 * 10_000  # of all samples at once 13 numbers each are kept


def test_lanes_and_limited_steps_have_the_parts_of_a_run_alone() -> None:
    """Bit for bit; each part of a step has as many iterations as a step may have."""
    system = sledge(800.0)
    tables = [push(0.305 + 0.004 * k, 0.093) for k in range(3)]
    many = mbs.simulate_many(
        system, [mbs.Variant(inputs={"push": t}) for t in tables], SPAN, H, progress=False, estimate_error=False
    )
    for table, found, alone in zip(tables, many.trajectories, many.alone, strict=True):
        inputs = {"push": table}
        run = mbs.simulate(system, SPAN, H, inputs, progress=False, estimate_error=False)
        one = mbs.Settings(step_iterations=1)
        limited = mbs.simulate(system, SPAN, H, inputs, progress=False, estimate_error=False, settings=one)
        assert found is not None
        assert np.array_equal(found["x"], run["x"])
        assert alone <= 2 + 1  # the parted ones, and the first, which has no past
        assert limited["x"] == pytest.approx(run["x"], abs=1e-12)
        assert limited.report is not None
        assert limited.report.iterations == 52


@pytest.mark.parametrize("way", RUNS)
def test_a_pulse_between_two_steps_moves_its_body(way: str) -> None:
    """The impulse p moves the sledge by p/m (t_end - t): of a 2000th of a step of 20 ms."""
    lasting = 1e-5
    height = 1.6 / lasting
    run = RUNS[way](sledge(), {"push": pulse(0.302, lasting, height)})
    assert run["x"][-1] - 1.0 == pytest.approx(0.5 * 1.6 / 2.0 * (SPAN - 0.302 - 0.5 * lasting), rel=1e-4)


def test_a_coarser_run_that_missed_a_pulse_does_not_agree() -> None:
    """A pulse of a function between two times at which runs with eight and four times the step ask ahead."""
    run = mbs.simulate(
        sledge(50.0), 4.0, 0.01, {"push": lambda t: 700.0 if 0.5305 < t < 0.5319 else 0.0}, progress=False
    )
    assert run.accuracy is not None
    assert run.accuracy.compared_step == 0.02
    assert run.accuracy.error is not None


def test_a_run_by_hand_is_judged_as_by_simulate() -> None:
    """A four-bar with a pendulum, 5.9 % off, of which half the step shows 2.7 %."""
    system, span = drawn("four-bar", 3, 29)
    h = span / 150
    runs: list[Callable[[], mbs.Trajectory]] = [
        lambda: mbs.simulate(system, span, h, every=3, progress=False),
        lambda: mbs.simulate(system, span, h, every=3, progress=False, estimate_error=True),
        lambda: mbs.Simulation(system).run(span, h, every=3, progress=False),
    ]
    for run in runs:
        with pytest.warns(mbs.AccuracyWarning, match=r"off by about 5\.[4-9] % .* steps of 0\.00115"):
            run()


def test_a_step_that_is_refused_behind_a_break_leaves_the_state_where_it_was() -> None:
    instance = Instance(LoadedSystem(sledge(800.0).to_bytes()))

    def given(t: float, after: bool, u: np.ndarray) -> None:
        if t > 0.2055:
            raise ZeroDivisionError
        u[0] = 50.0

    instance.set_input_function(given)
    instance.set_input_breaks(np.array([0.205]))
    instance.initialise(0.0)
    for _ in range(10):
        instance.step(0.02)
    before = np.copy(instance.get_state()[0])
    with pytest.raises(ZeroDivisionError):
        instance.step(0.02)
    np.testing.assert_array_equal(instance.get_state()[0], before)


def test_a_step_of_thousands_of_rows_of_noise_is_parted() -> None:
    """Each row is farther from straight lines than all before, so that lines end at one after the other."""
    t = np.linspace(0.0, 1.0, 5001)[:-1]
    breaks = input_breaks([(t, t * (-1.0) ** np.arange(len(t)))], 0.0, 1.0, 1.0)
    assert 4000 < len(breaks) < len(t)
    assert set(breaks) <= set(t)
