"""Peaks of inputs between two steps, and repeats of runs whose first repeats are off alike."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

import mbs
from benchmarks.methods import random_mechanisms
from mbs.settings.input_signals import InputSignals
from mbs.simulation.missed_inputs import jumps_within_steps, missed_peak

H, SPAN = 0.02, 1.0
Table = tuple[np.ndarray, np.ndarray]


def pulse(begin: float, lasting: float, height: float = 100.0) -> Table:
    """A triangle."""
    return np.array([0.0, begin, begin + 0.5 * lasting, begin + lasting, 9.0]), np.array([0.0, 0.0, height, 0.0, 0.0])


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
    ("table", "lasting"),
    [
        pytest.param(pulse(0.302, 0.016), 0.016, id="within a step"),
        pytest.param(pulse(0.302, 0.03), 0.03, id="its height between two steps"),
        pytest.param(pulse(0.29, 0.02), math.inf, id="its height at a step"),
        pytest.param((np.array([0.0, 0.305, 0.305, 1.0]), np.array([0.0, 0.0, 5.0, 5.0])), math.inf, id="a jump"),
        pytest.param((np.array([0.0, 0.305, 0.306, 1.0]), np.array([0.0, 0.0, 5.0, 5.0])), math.inf, id="a steep ramp"),
        pytest.param(
            (np.array([0.0, 0.305, 0.305, 0.31, 0.31, 1.0]), np.array([0.0, 0.0, 5.0, 5.0, 0.0, 0.0])),
            0.005,
            id="a rectangle",
        ),
        pytest.param(
            (np.array([0.0, 0.304, 0.309, 0.314, 1.0]), np.array([0.0, 0.0, 0.05, 0.0, 1.0])), math.inf, id="noise"
        ),
        pytest.param(
            (np.array([0.0, 0.3, 0.3, 0.32, 0.32, 1.0]), np.array([0.0, 0.0, 5.0, 5.0, 0.0, 0.0])),
            math.inf,
            id="a step",
        ),
        pytest.param(
            (np.array([0.0, 0.3, 0.3, 0.305, 0.305, 1.0]), np.array([0.0, 0.0, 5.0, 5.0, 0.0, 0.0])),
            math.inf,
            id="a rectangle from the end of a step",
        ),
        pytest.param((np.array([0.0, 0.02, 0.02, 1.0]), np.array([0.0, 0.0, 5.0, 5.0])), math.inf, id="a jump in time"),
        pytest.param(pulse(1.302, 0.016), math.inf, id="after the run"),
    ],
)
def test_a_peak_that_no_end_of_a_step_shows(table: Table, lasting: float) -> None:
    assert missed_peak([table], 0.0, SPAN, H) == pytest.approx(lasting)


@pytest.mark.parametrize(
    ("begin", "lasting", "within"),
    [(0.305, 0.0, True), (0.305, 0.001, True), (0.3, 0.0, False), (0.305, 0.1, False), (1.305, 0.0, False)],
)
def test_a_jump_within_a_step(begin: float, lasting: float, within: bool) -> None:
    table = np.array([0.0, begin, begin + lasting, 9.0]), np.array([0.0, 0.0, 5.0, 5.0])
    assert jumps_within_steps([table], 0.0, SPAN, H) == within


@pytest.mark.parametrize(("lasting", "counted"), [(2.4, 2.0), (4.6, 4.0), (6.8, 6.0)])
def test_jumps_that_a_run_and_its_repeats_miss_alike_are_told(lasting: float, counted: float) -> None:
    """A push that begins 0.05 of a step after the end of one: steps, twice and half of them count as much of it."""
    begin, end = 5.05, 5.05 + lasting
    t, x = H * np.array([0.0, begin, begin, end, end, 500.0]), 50.0 * np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
    inputs = {"push": (t, x)}
    with pytest.warns(mbs.AccuracyWarning, match="off by about (1[1-7]) % of the largest range"):
        run = mbs.simulate(sledge(), SPAN, H, inputs, progress=False)
    half = mbs.simulate(sledge(), SPAN, 0.5 * H, inputs, every=2, progress=False, estimate_error=False)
    assert np.abs(run["x"] - half["x"]).max() < (0.01 if lasting < 4.0 else 0.2) * np.ptp(run["x"])
    middle = 5.25 + 0.5 * counted
    assert run["x"][-1] - 1.0 == pytest.approx(25.0 * counted * H * (SPAN - middle * H), rel=0.01)


def by_many(system: mbs.System, inputs: dict[str, Table]) -> mbs.Trajectory:
    found = mbs.simulate_many(system, [mbs.Variant(inputs=inputs)], SPAN, H, progress=False).trajectories[0]
    assert found is not None
    return found


@pytest.mark.parametrize(("whole", "lasting"), [(True, 0.01), (False, math.inf)])
def test_a_whole_number_holds_until_the_next(whole: bool, lasting: float) -> None:
    """A lever that is pulled for 10 ms; as a table of points it would rise from the start on."""
    lever = np.array([0.0, 0.305, 0.315]), np.array([0.0, 1.0, 0.0])
    declared = [{"name": n, "unit": "1", "min": None, "max": None, "whole": whole} for n in ("lever", "other")]
    signals = InputSignals({"lever": lever, "other": 3.0}, declared)
    assert missed_peak(signals.tables(), 0.0, SPAN, H) == pytest.approx(lasting)


RUNS: dict[str, Callable[[mbs.System, dict[str, Table]], mbs.Trajectory]] = {
    "simulate": lambda system, inputs: mbs.simulate(system, SPAN, H, inputs, progress=False),
    "by hand": lambda system, inputs: mbs.Simulation(system).run(SPAN, H, inputs=inputs, progress=False),
    "many": by_many,
}


@pytest.mark.parametrize("way", RUNS)
def test_a_pulse_that_steps_do_not_see_is_told(way: str) -> None:
    """The impulse moves the sledge by p/m (t_end - t) = 0.8 N s/2 kg 0.69 s; no step of 20 ms knows of it."""
    inputs = {"push": pulse(0.302, 0.016)}
    with pytest.warns(mbs.AccuracyWarning, match="off by at least 1.. % of the largest range"):
        run = RUNS[way](sledge(), inputs)
    assert np.ptp(run["x"]) == 0.0
    assert run.accuracy is not None
    assert run.accuracy.sensors["x"] == pytest.approx(0.5 * 100.0 * 0.016 / 2.0 * (SPAN - 0.31), rel=0.05)


def test_one_that_no_repeat_could_see_is_named() -> None:
    with pytest.warns(mbs.AccuracyWarning, match=r"a peak of 0.0005 s between two steps of 0.02 s"):
        mbs.simulate(sledge(), SPAN, H, {"push": pulse(0.305, 5e-4)}, progress=False)
    run = mbs.simulate(sledge(), SPAN, inputs={"push": pulse(0.305, 5e-4)}, tolerance=1e-3, progress=False)
    assert run["x"][-1] - 1.0 == pytest.approx(0.5 * 100.0 * 5e-4 / 2.0 * (SPAN - 0.30525), rel=0.01)


def test_a_coarser_run_that_missed_what_moves_does_not_agree() -> None:
    """A pulse that the run meets once, at its height, and a run with eight times the step not at all."""
    run = mbs.simulate(sledge(50.0), 4.0, 0.01, {"push": pulse(0.52, 0.02)}, progress=False)
    assert run.accuracy is not None
    assert run.accuracy.repeated_with == 0.005
    assert run.accuracy.error is not None


def test_a_run_by_hand_is_judged_as_by_simulate() -> None:
    """A four-bar with a pendulum, 5.9 % off, of which half the step shows 2.7 %."""
    rng = np.random.default_rng([3, 29])
    rng.random()
    _, drawing = random_mechanisms.drawing(rng)
    system = mbs.compile(random_mechanisms.model_of(drawing))
    h = drawing.span / 150
    runs: list[Callable[[], mbs.Trajectory]] = [
        lambda: mbs.simulate(system, drawing.span, h, every=3, progress=False),
        lambda: mbs.simulate(system, drawing.span, h, every=3, progress=False, estimate_error=True),
        lambda: mbs.Simulation(system).run(drawing.span, h, every=3, progress=False),
    ]
    for run in runs:
        with pytest.warns(mbs.AccuracyWarning, match=r"off by about 5\.[6-9] % .* steps of 0\.0011"):
            run()
