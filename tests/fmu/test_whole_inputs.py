"""Inputs that are whole numbers: integers of FMI, discrete, without derivatives, the same in every host."""

from collections.abc import Callable
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

import mbs
from hosts.run.command import main
from tests.fmu.calls import ERROR, OK, HostMaker
from tests.fmu.scenes import gearstick
from tests.in_process import run

H = 0.01
JUMPS = (np.array([0.0, 0.3, 0.6, 1.0]), np.array([1.0, -1.0, 0.0, 0.0]))
TABLE = '"time","lever","torque"\n0,1,2\n0.3,-1,2\n0.6,0,2\n1,0,2\n'


@pytest.fixture
def stick(build: Callable[..., Path], kind: str) -> Path:
    return build("gearstick", kind)


def reference() -> mbs.Trajectory:
    """The same drive without an FMU: a table of a whole input is a stair."""
    settings = {"lever": JUMPS, "torque": 2.0}
    return mbs.simulate(mbs.compile(gearstick()), 1.0, H, inputs=settings)


def test_it_is_a_discrete_integer_with_its_range(build: Callable[..., Path], kind: str) -> None:
    """And outputs depend on it."""
    fmu = build("gearstick", kind)
    assert validate_fmu(str(fmu)) == []
    description = fmpy.read_model_description(str(fmu))
    variables = {v.name: v for v in description.modelVariables}
    lever, used = variables["lever"], variables["lever_used"]
    assert lever.type == used.type == ("Int32" if kind.startswith("fmi3") else "Integer")
    assert lever.variability == used.variability == "discrete"
    assert (lever.min, lever.max, lever.start) == ("-1", "1", "1")
    assert variables["torque"].variability == "continuous"
    known = {u.variable.name: {v.name for v in u.dependencies} for u in description.initialUnknowns if u.dependencies}
    assert known["rod.ay"] == {"torque", "lever", "spring.stiffness"}
    assert known["lever_used"] == {"lever"}


def test_values_that_are_not_whole_are_refused_with_a_sentence(stick: Path, host: HostMaker) -> None:
    driven = host(stick).start()
    lever = [driven.references["lever"]]
    assert driven.slave.getInteger(lever) == [1]
    assert driven.call("setInteger", lever, [-1]) == OK
    assert driven.call("setReal", lever, [0.5]) == ERROR
    assert "'lever' was set to 0.5; it must be a whole number, it keeps -1." in driven.messages[-1]
    assert driven.call("setReal", lever, [1.0]) == OK
    assert driven.slave.getInteger(lever) == [1]
    assert driven.call("setInteger", lever, [7]) == OK  # with a warning
    assert "held at 1" in driven.messages[-1]
    assert driven.call("setInteger", [driven.references["torque"]], [1]) == ERROR
    assert driven.slave.getInteger(lever) == [1]


def test_it_has_no_derivatives_and_the_others_keep_theirs(stick: Path, host: HostMaker) -> None:
    driven = host(stick).start({"torque": 2.0})
    driven.run(5, H)
    lever, torque, x = ([driven.references[n]] for n in ("lever", "torque", "rod.x"))
    assert driven.call("getDirectionalDerivative", x, lever, [1.0]) == ERROR
    assert "no derivatives by 'lever'; it is a whole number" in driven.messages[-1]
    assert driven.slave.getDirectionalDerivative(x, torque, [1.0])[0] != 0.0
    if not driven.three:  # the standard has none
        assert driven.call("setRealInputDerivatives", lever, [1], [1.0]) == ERROR
        assert "'lever' was set; it is a whole number and has none" in driven.messages[-1]
        assert driven.call("setRealInputDerivatives", torque, [1], [1.0]) == OK


def test_a_state_brings_the_lever_back(stick: Path, host: HostMaker) -> None:
    driven = host(stick).start({"torque": 2.0})
    lever = [driven.references["lever"]]
    driven.slave.setInteger(lever, [-1])
    driven.run(10, H)
    saved = driven.saved()
    first = driven.run(20, H, 10 * H)
    driven.slave.setInteger(lever, [1])
    assert driven.restore(saved) == OK
    assert driven.slave.getInteger(lever) == [-1]
    assert driven.run(20, H, 10 * H) == first


@pytest.mark.parametrize("kind", ["fmi3", "python"])
def test_fmpy_and_the_engine_agree_bit_for_bit(build: Callable[..., Path], kind: str) -> None:
    expected = reference()
    times = np.arange(101) * H
    lever = np.select([times < 0.3 - 1e-9, times < 0.6 - 1e-9], [1, -1], 0)
    signals = np.array(
        [(t, k, 2.0) for t, k in zip(times, lever, strict=True)],
        dtype=[("time", float), ("lever", np.int32), ("torque", float)],
    )
    result = fmpy.simulate_fmu(
        str(build("gearstick", kind)),
        stop_time=1.0,
        output_interval=H,
        input=signals,
        output=["rod.x", "lever_used"],
        start_values={"step_size": H, "torque": 2.0},
    )
    assert np.array_equal(result["rod.x"], expected["rod.x"])
    assert result["lever_used"].dtype.kind == "i"
    assert result["lever_used"][-1] == 0


@pytest.mark.slow
def test_a_table_of_our_host_gives_the_same_bits(build: Callable[..., Path], tmp_path: Path) -> None:
    stick = build("gearstick")
    (tmp_path / "shift.csv").write_text(f"# start: step_size={H}\n{TABLE}")
    done = run(main, stick, "--manoeuvre", tmp_path / "shift.csv", "--step", str(H), "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    (file,) = (tmp_path / "out").rglob("*.csv")
    assert np.array_equal(read_csv(str(file))["rod.x"], reference()["rod.x"])

    (tmp_path / "half.csv").write_text('"time","lever"\n0,0\n1,0.5\n')
    done = run(main, stick, "--manoeuvre", tmp_path / "half.csv", "--out", tmp_path / "out")
    assert done.returncode != 0
    assert "'lever' is a whole number" in done.stderr
