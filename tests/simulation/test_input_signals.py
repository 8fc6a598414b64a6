"""Inputs over time: constants, functions, tables with jumps, ranges."""

import numpy as np
import pytest

from mbs import Model, Simulation, compile, simulate
from mbs.settings.input_signals import InputSignals

DECLARED = [
    {"name": "steering", "unit": "1", "min": -1.0, "max": 1.0},
    {"name": "force", "unit": "N", "min": None, "max": None},
]
H = 0.1
TOLERANCE = 1e-6 * H
ROUND_OFF = 1e-15


def at(signal, t, **options):
    return InputSignals({"force": signal}, DECLARED).at(np.atleast_1d(np.asarray(t, float)), TOLERANCE, **options)[:, 0]


def test_a_table_is_linear_inside_and_held_outside():
    table = ([1.0, 2.0, 4.0], [10.0, 20.0, 0.0])
    np.testing.assert_allclose(
        at(table, [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0]), [10, 10, 15, 20, 10, 0, 0], atol=ROUND_OFF
    )


def test_a_step_that_ends_at_a_jump_sees_the_value_before_it():
    jump = ([0.0, 0.3, 0.3, 1.0], [0.0, 0.0, 7.0, 7.0])
    times = H * np.arange(1, 6)
    assert times[2] != 0.3  # three steps of 0.1 miss 0.3 by round-off
    assert at(jump, times).tolist() == [0.0, 0.0, 0.0, 7.0, 7.0]
    assert at(jump, times, after_jump=True).tolist() == [0.0, 0.0, 7.0, 7.0, 7.0]


def test_columns_follow_the_signals_given():
    signals = InputSignals({"force": 2.0, "steering": -0.5}, DECLARED)
    assert signals.columns() == [1, 0]
    assert signals.at(np.array([0.0]), TOLERANCE).tolist() == [[2.0, -0.5]]


@pytest.mark.parametrize(
    ("signals", "sentence"),
    [
        ({"pedal": 0.0}, "no input 'pedal'; the System has: steering, force"),
        ({"force": ([0.0, 1.0], [0.0])}, r"times of shape \(2,\) and values of shape \(1,\)"),
        ({"force": ([0.0, 1.0],)}, "1 parts; it must be a pair"),
        ({"force": ([1.0, 0.0], [0.0, 0.0])}, "must not decrease"),
        ({"force": ([0.0, 0.5, 0.5, 0.5], [0.0, 1.0, 2.0, 3.0])}, r"more than two values at t = 0\.5 s"),
        ({"force": ([0.0, 1.0], [0.0, np.inf])}, "table of input 'force' has inf at t = 1 s; it must be finite"),
    ],
)
def test_a_wrong_signal_is_refused_by_name(signals, sentence):
    with pytest.raises(ValueError, match=sentence):
        InputSignals(signals, DECLARED)


def test_an_open_range_still_refuses_infinity():
    with pytest.raises(ValueError, match="'force' is inf N at t = 0 s; it must be finite"):
        at(float("inf"), 0.0)


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        (1.5, "'steering' is 1.5 at t = 2 s; it must lie between -1 and 1"),
        (-2.0, "'steering' is -2 at t = 2 s; it must lie between -1 and 1"),
        (float("nan"), "'steering' is nan at t = 2 s; it must be finite"),
    ],
)
def test_a_value_outside_the_range_is_refused_with_its_time(value, sentence):
    signals = InputSignals({"steering": lambda t: value if t > 1.0 else 0.0}, DECLARED)
    with pytest.raises(ValueError, match=sentence):
        signals.at(np.array([1.0, 2.0]), TOLERANCE)


class TestWholeInputs:
    """Positions of a lever."""

    declared = ({"name": "lever", "unit": "1", "min": -1.0, "max": 1.0, "whole": True},)

    def signals(self, signal):
        return InputSignals({"lever": signal}, list(self.declared))

    def test_a_table_keeps_each_value_until_the_next(self):
        signals = self.signals(([0.0, 1.0, 2.0], [1.0, 0.0, -1.0]))
        t = np.array([-1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0])
        assert signals.at(t, TOLERANCE).ravel().tolist() == [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, -1.0]
        assert signals.at(t, TOLERANCE, after_jump=True).ravel().tolist() == [1.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0]

    @pytest.mark.parametrize("signal", [0.5, ([0.0, 2.0], [0.0, 0.5]), lambda t: 0.5])
    def test_what_is_not_whole_is_refused(self, signal):
        with pytest.raises(ValueError, match=r"'lever' is 0.5 at t = 2 s; it must be a whole number"):
            self.signals(signal).at(np.array([2.0]), TOLERANCE)

    @pytest.mark.parametrize(
        ("given", "sentence"),
        [
            ({"start": 0.5}, "start of input 'lever' is 0.5; a whole-number input needs whole numbers"),
            ({"max": 2.5}, "max of input 'lever' is 2.5"),
            ({"max": 1e10}, "max of input 'lever' is 1e"),
            ({"unit": "m"}, "is a whole number in 'm'; whole numbers have the unit '1'"),
            ({"whole": 1}, "whole of input 'lever'"),
        ],
    )
    def test_a_model_refuses_values_that_are_no_integers(self, given, sentence):
        m = Model("levers")
        with pytest.raises(ValueError, match=sentence):
            m.input("lever", **({"whole": True} | given))
        assert m.inputs == []

    def test_a_run_and_a_step_refuse_half_positions(self):
        m = Model("levers", dimension=2)
        bob = m.point_mass("bob", mass=1.0, position=(0.0, 0.0))
        lever = m.input("lever", whole=True, min=-1.0, max=1.0)
        m.force("push", bob, inputs=[lever, None])
        m.sense_position("x", bob, component="x")
        system = compile(m)
        with pytest.raises(ValueError, match=r"'lever' is 0.5 at t = .*must be a whole number"):
            simulate(system, 1.0, 0.01, inputs={"lever": lambda t: 0.5 if t > 0.5 else 0.0})
        with pytest.raises(ValueError, match="must be a whole number"):
            Simulation(system).set_input("lever", 0.25)
        table = simulate(system, 2.0, 0.01, inputs={"lever": ([0.0, 1.0], [0.0, 1.0])})
        assert table["x"][100] == 0.0  # the table is a stair
        assert table["x"][-1] == pytest.approx(0.5, rel=0.02)
