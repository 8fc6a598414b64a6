"""Rows of a run at an interval longer than the step: its end, unresolved changes, and FMUs without outputs."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvres import manoeuvre_names
from hosts.driving.missed_inputs import missed_inputs
from hosts.driving.result import Result
from hosts.fmu.fmu import StepRefusedError
from hosts.recordings.load_manoeuvre import load_manoeuvre
from hosts.run.run_summary import energy_balance, summary
from tests.hosts.made_fmu import MadeFmu

H = 0.01


class Integrator(MadeFmu):
    """y, the integral of u, exact for inputs that go straight."""

    def __init__(self, slopes: bool, refused: int = 1000, outputs: Sequence[str] = ("y",)) -> None:
        super().__init__({"input": ["u"], "output": outputs, "parameter": []}, "m", slopes)
        self._left = refused

    def step(self, time: float, step: float) -> None:
        if self._left == 0:
            raise StepRefusedError("enough")
        self._left -= 1
        self.output += step * (self.given["u"] + 0.5 * step * self.slopes["u"])
        self.given["u"], self.slopes["u"] = self.given["u"] + step * self.slopes["u"], 0.0


def driven(
    time: Sequence[float], u: Sequence[float], every: int, slopes: bool = True, last: bool = True, **more: Any
) -> Result:
    manoeuvre = Manoeuvre("m", np.array(time), {"u": np.array(u)}, time[-1])
    return run(Integrator(slopes, **more), manoeuvre, H, every=every, last=last)  # type: ignore[arg-type]


@pytest.mark.parametrize("slopes", [True, False])
@pytest.mark.parametrize("refused", [1000, 13])
def test_the_last_step_has_a_row(slopes, refused):
    """Where the stop time is not a multiple of the interval too, but not behind a step that was refused."""
    requested: dict[str, Any] = {"time": (0.0, 0.17), "u": (1.0, 3.0), "slopes": slopes, "refused": refused}
    few, each = driven(every=5, **requested), driven(every=1, **requested)
    end = min(17, refused)
    rows = [0, 5, 10, 15, 17] if end == 17 else [0, 5, 10]
    assert few.time.tolist() == [H * k for k in rows]
    assert few.values.tolist() == each.values[rows].tolist()
    assert few.failed_steps == (refused < 17)
    rough = driven(every=5, last=False, **requested)
    for run_of in (few, each, rough):
        assert run_of.refusal == (f"the FMU refused the step at {H * refused:g} s" if refused < 17 else "")


@pytest.mark.parametrize(
    ("slopes", "time", "u", "lost"),
    [
        (True, (0.0, 0.1, 0.1, 0.2), (0.0, 1.0, 3.0, 3.0), []),
        (True, (0.0, 0.08, 0.2), (0.0, 1.0, 1.0), ["u"]),
        (True, (0.0, 0.08, 0.08, 0.2), (1.0, 1.0, 2.0, 2.0), ["u"]),
        (False, (0.0, 0.2), (0.0, 1.0), ["u"]),
        (False, (0.0, 0.2), (1.0, 1.0), []),
        (False, (0.0, 0.08, 0.08, 0.09, 0.09, 0.2), (1.0, 1.0, 2.0, 2.0, 1.0, 1.0), ["u"]),
    ],
)
def test_what_rows_do_not_tell_of_inputs(slopes, time, u, lost):
    assert driven(time, u, 5, slopes).lost == lost
    assert driven(time, u, 1, slopes).lost == []


def test_a_summary_of_rows_at_an_interval_says_so():
    few, each = (driven((0.0, 0.17), (1.0, 3.0), every) for every in (5, 1))
    assert ("rows every 0.05 s", "largest values and means are of these rows") in summary(few, H)
    assert not any(what.startswith("rows every") for what, _ in summary(each, H))


@pytest.mark.parametrize(
    ("slopes", "time", "u", "what", "message"),
    [
        (True, (0.0, 0.1, 0.1, 0.2), (0.0, 0.0, 1.0, 1.0), None, ""),
        (True, (0.0, 0.104, 0.104, 0.12, 0.12, 0.2), (0.0, 0.0, 1.0, 1.0, 2.0, 2.0), "jumps",
         "1 of u, the first at 0.104 s: each becomes a line over its step of 10 ms, and u is off by up to 0.6, 30 % of "
         "its range, at 0.104 s; --step 0.002 has it to within 1 %"),
        (False, (0.0, 0.105, 0.105, 0.113, 0.113, 0.2), (0.0, 0.0, 1.0, 1.0, 2.0, 2.0), "jumps",
         "2 of u, the first at 0.105 s: each comes with the next step of 10 ms, and u is off by up to 1, 50 % of its "
         "range, at 0.105 s; --step 0.001 has it to within 1 %"),
        (True, (0.0, 0.1 / 3.0, 0.1 / 3.0, 0.07071, 0.07071, 0.2), (0.0, 0.0, 1.0, 1.0, 0.0, 0.0), "jumps",
         "2 of u, the first at 0.0333333333 s: each becomes a line over its step of 10 ms, and u is off by up to "
         "0.929, 92.9 % of its range, at 0.07071 s; take times that are multiples of 0.01 s"),
        (True, (0.0, 0.104, 0.104, 0.2), (0.0, 1.0, 1.0, 1.0), "corners",
         "1 of u, the first at 0.104 s: each becomes a line over its step of 10 ms, and u is off by up to 0.0231, "
         "2.31 % of its range, at 0.104 s; --step 0.005 has it to within 1 %"),
        (True, (0.0, 0.1, 0.101, 0.105, 0.105, 0.2), (0.0, 0.0, 1.0, 1.0, 5.0, 5.0), "corners and jumps",
         "2 of u, the first at 0.101 s: each becomes a line over its step of 10 ms, and u is off by up to 2.5, 50 % of "
         "its range, at 0.105 s; --step 0.001 has it to within 1 %"),
        (True, (0.0, 0.104, 0.2), (0.0, 1.0, 1.8), None, ""),
    ],
)  # fmt: skip
def test_what_is_inside_a_step_is_reported(slopes, time, u, what, message):
    rows = {k: v for k, v in summary(driven(time, u, 1, slopes), H) if k.endswith("inside a communication step")}
    assert rows == ({f"{what} inside a communication step": message} if what else {})
    if "--step" in message:  # what helps does help: the integral is then that of the table, and nothing is told
        step = float(message.split("--step ")[1].split(" ")[0])
        manoeuvre = Manoeuvre("m", np.array(time), {"u": np.array(u)}, time[-1])
        coarse, fine = (run(Integrator(slopes), manoeuvre, h) for h in (H, step))  # type: ignore[arg-type]
        area = float(np.trapezoid(u, time))
        assert abs(fine["y"][-1] - area) < 0.6 * abs(coarse["y"][-1] - area)
        assert not fine.missed


def test_manoeuvres_of_the_package_have_nothing_inside_steps_of_2_ms():
    for name in manoeuvre_names():
        requested = load_manoeuvre(name)
        for straight in (list(requested.inputs), []):
            assert missed_inputs(requested, 0.002, straight, ()) is None, name


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("before", [False, True])
def test_many_values_of_a_table_are_those_one_by_one(held, before):
    table = Manoeuvre("m", np.array([0.1, 0.2, 0.2, 0.5]), {"u": np.array([1.0, 2.0, 4.0, -3.0])}, 1.0)
    times = np.array([0.0, 0.1, 0.13, 0.2, 0.2 + 1e-12, 0.31, 0.5, 0.9])
    one_by_one = [table.at(t, ("u",) if held else (), before)["u"] for t in times.tolist()]
    assert table.column("u", times, held, before) == pytest.approx(one_by_one, abs=1e-9)


@pytest.mark.parametrize("held", [frozenset(), frozenset({"u"})])
def test_every_change_of_an_input_that_the_table_holds_is_a_jump(held):
    requested = Manoeuvre("m", np.array([0.0, 0.05, 0.104]), {"u": np.array([0.0, 1.0, 2.0])}, 0.2, held=held)
    rows = dict(summary(run(Integrator(True), requested, H), H))  # type: ignore[arg-type]
    assert ("jumps inside a communication step" in rows) == bool(held)


@pytest.mark.parametrize(("stop", "end"), [(1.0, 0.8), (0.8, None)])
def test_a_run_that_ends_at_another_time_is_reported(stop, end):
    requested = Manoeuvre("m", np.array([0.0]), {"u": np.array([1.0])}, stop)
    result = run(Integrator(True), requested, 0.4)  # type: ignore[arg-type]
    row = dict(summary(result, 0.4)).get("end of the run")
    assert (row is None) == (end is None)
    if row is not None:
        assert row.startswith(f"at {end} s, a whole number of steps of 0.4 s, instead of {stop:g} s; --step ")
        shorter = float(row.split("--step ")[1].split(" ")[0])
        assert run(Integrator(True), requested, shorter).time[-1] == pytest.approx(stop, abs=1e-8)  # type: ignore[arg-type]


def test_time_in_the_air_ends_with_the_run():
    """0.17 s in rows of 0.05 s."""
    few = driven((0.0, 0.17), (0.0, 0.0), 5)
    air = replace(few, names=["u", "wheel_FL.Fz"])
    assert ("wheels in the air", "FL 170  ms") in summary(air, H)


def test_there_need_be_no_outputs():
    for names in ((), ("stress.a",)):
        result = driven((0.0, 0.17), (1.0, 1.0), 5, outputs=names)
        assert result.values[-1].tolist() == [1.0, pytest.approx(0.17)][: 1 + len(names)]


@pytest.mark.parametrize(("error", "reported"), [(-3.0, "3.0%"), (0.5, "")])
def test_an_error_of_the_steps_beside_the_work_of_a_steering_is_reported(error, reported):
    works = ("drive", "brakes", "tyres", "dampers", "drag", "ground", "steering")
    names = [f"energy.{n}" for n in ("kinetic", "gravity", "elastic", *works)] + ["solver.energy_error"]
    values = np.zeros((3, len(names)))
    values[1, names.index("energy.steering")] = -100.0
    values[2, -1] = error
    run = Result(names, {}, np.arange(3.0), values, 1.0, 2.0, 0, [])
    said = dict(energy_balance(run))["- work of steering"]
    assert (reported in said) if reported else said == "+0.0000 kJ"
    assert ("shorter steps" in said) == bool(reported)
