"""Measures of a study against closed forms of known signals."""

import math
import pickle
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.driving.result import Result
from hosts.study.measures.study_measure import parse_measure

END = 2.0  # s
N = 2001


@pytest.fixture(scope="module")
def result() -> Result:
    """A sine with 2 full turns, a ramp, and a signal with a name that is no Python."""
    time = np.linspace(0.0, END, N)
    signals = {
        "chassis.ay": (3.0 * np.sin(2.0 * np.pi * time) - 1.0, "m/s2"),
        "chassis.x": (5.0 * time, "m"),
        "chassis.y": (0.25 * time**2, "m"),
        "wheel[1].Fz": (1000.0 + 500.0 * time, "N"),
        "Car/Ay sensor": (-2.0 * time, "m/s2"),
        "pulse": (np.where(time < 1.0, 7.0, -1.0), ""),
    }
    values = np.stack([x for x, _ in signals.values()], axis=1)
    return Result(list(signals), {n: u for n, (_, u) in signals.items()}, time, values, 0.1, END, 0, [])


SINE_RMS = math.sqrt(0.5 * 3.0**2 + 1.0)


@pytest.mark.parametrize(
    ("text", "expected", "unit"),
    [
        ("max(chassis.ay)", 2.0, "m/s2"),
        ("min(chassis.ay)", -4.0, "m/s2"),
        ("max(abs(chassis.ay))", 4.0, "m/s2"),
        ("max(-chassis.ay)", 4.0, "m/s2"),
        ("range(chassis.ay)", 6.0, "m/s2"),
        ("mean(chassis.ay)", -1.0, "m/s2"),
        ("rms(chassis.ay)", SINE_RMS, "m/s2"),
        ("std(chassis.ay)", 3.0 / math.sqrt(2.0), "m/s2"),
        ("time_of_max(chassis.ay)", 0.25, "s"),
        ("time_of_min(chassis.ay)", 0.75, "s"),
        ("time_of_max(chassis.ay, after=1.0)", 1.25, "s"),
        ("max(chassis.x, before=0.5)", 2.5, "m"),
        ("mean(chassis.x, after=1, before=2)", 7.5, "m"),
        ("initial(wheel[1].Fz)", 1000.0, "N"),
        ("final(wheel[1].Fz)", 2000.0, "N"),
        ("value(chassis.y, 1.0005)", 0.25 * 1.0005**2, "m"),
        ("percentile(chassis.x, 90)", 9.0, "m"),
        ("final('Car/Ay sensor')", -4.0, "m/s2"),
        ("max(pulse, after=1.001)", -1.0, "1"),
        ("max(time)", 2.0, "s"),
        ("max(chassis.x - chassis.y)", 9.0, "m"),
        ("max(abs(chassis.ay)) / 9.81", 4.0 / 9.81, "m/s2"),
        ("max(chassis.x) / min(chassis.ay)", -2.5, "m/(m/s2)"),
        ("max(chassis.x) / final(chassis.x)", 1.0, "1"),
        ("2 * final(chassis.x) + final(chassis.y)", 21.0, "m"),
        ("abs(min(chassis.ay))", 4.0, "m/s2"),
    ],
)
def test_closed_forms_and_units(result, text, expected, unit):
    measure = pickle.loads(pickle.dumps(parse_measure(text)))
    assert list(measure.columns(result.units, END).values()) == [unit]
    (actual,) = measure.evaluate(result)
    assert actual.value == pytest.approx(expected, rel=1e-6)
    assert (actual.unit, actual.note) == (unit, "")


def test_means_do_not_change_where_more_samples_lie(result):
    # The same ramp with 100 times as many samples in its second half; a plain mean would be 7.45.
    time = np.concatenate([np.linspace(0.0, 1.0, 11)[:-1], np.linspace(1.0, 2.0, 1001)])
    dense = Result(["x"], {"x": "m"}, time, 5.0 * time[:, None], 0.1, END, 0, [])
    assert parse_measure("mean(x)").evaluate(dense)[0].value == pytest.approx(5.0, rel=1e-9)
    assert np.mean(dense["x"]) == pytest.approx(7.45, abs=0.01)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("max(chassis.ay", r"cannot be read: .*never closed"),
        ("chassis.ay", r"a signal over time, not a number; reduce it, such as by max\(chassis.ay\)"),
        ("max(max(chassis.ay))", r"'max\(chassis.ay\)' is a number"),
        ("eval(chassis.ay)", "no function 'eval'"),
        ("__import__('os').system('ls')", "cannot be read: signals, numbers"),
        ("max((lambda: 1)())", "cannot be read: signals"),
        ("max(chassis.ay ** 2)", "cannot be read: signals"),
        ("max(chassis.ay).values", "cannot be read: signals"),
        ("max(True)", "'True' is not a number"),
        ("max(chassis.ay, 3)", "takes one signal; it was given 2"),
        ("max(chassis.ay, until=3)", "it has after and before"),
        ("final(chassis.ay, after=3)", "final has no after"),
        ("max(chassis.ay, after=2, before=1)", "begin after 2 s and to end before 1 s"),
        ("max(chassis.ay, after=chassis.x)", "not a time of the run"),
        ("percentile(chassis.ay, 101)", "not a number from 0 to 100"),
        ("value(chassis.ay, -1)", "not a time of the run"),
        ("3 + 4", "reads no signal"),
        ("-" * 5000 + "max(chassis.ay)", "cannot be read|nested too deep"),
    ],
)
def test_forms_that_are_refused(text, sentence):
    with pytest.raises(HostError, match=sentence):
        parse_measure(text)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("max(chasis.ay)", r"'chasis.ay', which is not an input or output; did you mean 'chassis.ay'"),
        ("max(Chassis.AY)", r"did you mean 'chassis.ay'\?"),
        ("max(chassis.x + chassis.ay)", r"'chassis.x' in m \+ 'chassis.ay' in m/s2; only equal units"),
        ("max(chassis.x, after=2.5)", "from 0 to 2 s has no sample for 'max\\(chassis.x, after=2.5\\)'"),
        ("value(chassis.x, 2.5)", "ends at 2 s, before the 2.5 s of 'value"),
    ],
)
def test_what_no_run_can_yield(result, text, sentence):
    with pytest.raises(HostError, match=sentence):
        parse_measure(text).columns(result.units, END)


def test_measures_that_a_run_does_not_yield_are_nan_with_a_reason(result):
    def note(text: str, run: Result) -> str:
        (found,) = parse_measure(text).evaluate(run)
        assert math.isnan(found.value)
        return found.note

    short = replace(result, time=result.time[:501], values=result.values[:501], simulated=0.5)
    assert "0.5 s, before the 1 s" in note("value(chassis.x, 1)", short)
    assert "no sample" in note("max(chassis.x, after=1)", short)
    refused = replace(short, failed_steps=1, messages=["FMU: it is odd."])
    assert note("max(chassis.x)", refused) == "The FMU refused the step at 0.5 s: FMU: it is odd."
    holed = replace(result, values=result.values.copy())
    holed.values[300, 0] = math.nan
    assert note("max(chassis.ay)", holed) == "'chassis.ay' is nan at 0.3 s."
    assert parse_measure("max(chassis.x)").evaluate(holed)[0].value == 10.0
    assert "divides by zero" in note("max(chassis.x) / initial(chassis.x)", result)
    assert "no signal 'nothing'" in note("max(nothing)", result)


FUNCTIONS = """
import math
import neighbour

def peak(result):
    return neighbour.TWICE * max(result["chassis.x"])
peak.units = "m"

def both(result, parameters):
    return {"work": parameters["mass"] * result["chassis.x"][-1], "last": result["chassis.y"][-1]}
both.units = {"work": "kg.m", "last": "m"}

def broken(result):
    return 1.0 / 0.0

def nothing(result):
    return None

def undeclared(result):
    return {"a": 1.0}

def other(result):
    return {"b": 1.0}
other.units = {"a": "m"}

def imports_late(result):
    import neighbour_of_calls

    return neighbour_of_calls.THRICE

def infinite(result):
    return math.inf

def wants(a, b, c):
    return 0.0

def wrong_units(result):
    return 0.0
wrong_units.units = 3

NUMBER = 3
"""


@pytest.fixture
def functions(tmp_path: Path) -> Path:
    (tmp_path / "neighbour.py").write_text("TWICE = 2\n")
    (tmp_path / "neighbour_of_calls.py").write_text("THRICE = 3\n")
    (tmp_path / "mine.py").write_text(FUNCTIONS)
    return tmp_path


def test_a_users_functions(functions, result):
    peak = parse_measure("mine.py:peak", folder=functions)
    assert peak.columns(result.units) == {"peak": "m"}
    assert [m.value for m in peak.evaluate(result)] == [20.0]
    late = parse_measure("mine.py:imports_late", folder=functions)
    assert [m.value for m in late.evaluate(result)] == [3.0], "a function may import what is beside its file"
    both = parse_measure("mine.py:both", "mine", functions)
    assert both.columns(result.units) == {"mine.work": "kg.m", "mine.last": "m"}
    (functions / "mine.py").unlink()  # it carries its source
    actual = pickle.loads(pickle.dumps(both)).evaluate(result, {"mass": 3.0})
    assert {m.name: m.value for m in actual} == {"mine.work": 30.0, "mine.last": 1.0}


@pytest.mark.parametrize(
    ("function", "sentence"),
    [
        ("broken", r"mine.py:broken, line 14: ZeroDivisionError"),
        ("nothing", "gave None, not a finite number"),
        ("infinite", "gave inf, not a finite number"),
        ("undeclared", r"undeclared.units = \{'a': \"1\"\}"),
        ("other", "gave b; other.units declares a"),
    ],
)
def test_a_function_that_fails_is_nan_with_a_reason(functions, result, function, sentence):
    (found,) = parse_measure(f"mine.py:{function}", folder=functions).evaluate(result)
    assert math.isnan(found.value)
    assert re.search(sentence, found.note), found.note


@pytest.mark.parametrize(
    ("source", "function", "sentence"),
    [
        (FUNCTIONS, "peek", "no function 'peek'; did you mean 'peak'"),
        (FUNCTIONS, "NUMBER", "is int, not a function"),
        (FUNCTIONS, "wants", r"takes \(a, b, c\); it must take"),
        (FUNCTIONS, "wrong_units", "wrong_units.units is 3"),
        (FUNCTIONS, "", "names no function"),
        ("def peak(:\n", "peak", "line 1: SyntaxError"),
        ("import nothing_of_this_name\n", "peak", "ModuleNotFoundError"),
        ("raise SystemExit(3)\n", "peak", "SystemExit"),
    ],
)
def test_files_that_are_refused(functions, source, function, sentence):
    (functions / "mine.py").write_text(source)
    with pytest.raises(HostError, match=sentence):
        parse_measure(f"mine.py:{function}", folder=functions)


def test_no_file(tmp_path):
    with pytest.raises(HostError, match=r"in which the function f is to be, cannot be read: there is no such file"):
        parse_measure("none.py:f", folder=tmp_path)


def test_digests_tell_changes(functions):
    before = parse_measure("mine.py:peak", folder=functions).digest
    (functions / "mine.py").write_text(FUNCTIONS.replace("TWICE *", "TWICE +"))
    assert parse_measure("mine.py:peak", folder=functions).digest != before
    assert parse_measure("max( x )").digest == parse_measure("max(x)").digest != parse_measure("min(x)").digest
