"""A refused step stops a host in place of looping it, and says what helps."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from ctypes import byref, c_bool, c_double
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy.fmi3 import FMU3Slave

HostMaker = Callable[..., Any]
OK, WARNING, DISCARD, ERROR = range(4)
DO_STEP_STATUS, TERMINATED = 0, 3
# The crank turns too fast for 10 ms from here on.
LAST, H = 53, 0.01
SECONDS = 60.0


@pytest.fixture
def slider(build: Callable[..., Path], kind: str) -> Path:
    return build("crank_slider", kind)


def at_the_edge(fmu: Path, host: HostMaker) -> Any:
    driven = host(fmu).start({"torque": 4.0, "step_size": H})
    for k in range(LAST):
        assert driven.step(k * H, H) == OK
    return driven


def wants_end(driven: Any) -> bool:
    return bool(driven.slave.getBooleanStatus(TERMINATED))


def test_asked_again_it_wishes_the_end_and_then_is_an_error(slider: Path, host: HostMaker) -> None:
    driven = at_the_edge(slider, host)
    before = driven.outputs()
    time = LAST * H
    assert driven.step(time, H) == DISCARD
    assert not wants_end(driven)
    assert "step_size" in driven.messages[-1]
    assert driven.set("torque", 4.0) == OK  # nothing new
    assert driven.step(time, H) == DISCARD
    assert wants_end(driven)
    assert driven.slave.getStatus(DO_STEP_STATUS) == DISCARD
    assert driven.step(time, H) == ERROR
    assert driven.slave.getStatus(DO_STEP_STATUS) == ERROR
    assert "step_size" in driven.messages[-1]
    assert driven.step(time, H) == ERROR
    assert driven.outputs() == before


@pytest.mark.parametrize("change", ["shorter step", "input", "state"])
def test_what_clears_it(slider: Path, host: HostMaker, change: str) -> None:
    driven = at_the_edge(slider, host)
    time = LAST * H
    state = driven.slave.getFMUstate()
    assert driven.step(time, H) == driven.step(time, H) == DISCARD
    assert wants_end(driven)
    if change == "shorter step":
        assert driven.step(time, 0.1 * H) == OK
        time += 0.1 * H
    elif change == "input":
        assert driven.set("torque", 3.0) == OK
    else:
        driven.slave.setFMUstate(state)
    assert not wants_end(driven)
    assert driven.step(time, H) in (OK, DISCARD)
    assert driven.slave.getStatus(DO_STEP_STATUS) in (OK, DISCARD)


def test_ten_steps_of_a_tenth_pass(slider: Path, host: HostMaker) -> None:
    driven = at_the_edge(slider, host)
    assert driven.step(LAST * H, H) == DISCARD
    for k in range(10):
        assert driven.step(LAST * H + 0.1 * k * H, 0.1 * H) == OK


def test_fmi_3_wishes_the_end_and_then_is_an_error(build: Callable[..., Path]) -> None:
    fmu = build("crank_slider", "fmi3")
    description = fmpy.read_model_description(str(fmu))
    references = {v.name: v.valueReference for v in description.modelVariables}
    messages: list[str] = []
    slave = FMU3Slave(
        guid=description.guid,
        unzipDirectory=fmpy.extract(str(fmu)),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="test",
    )
    slave.instantiate(logMessage=lambda *a: messages.append(a[-1].decode()))
    slave.setFloat64([references["torque"], references["step_size"]], [4.0, H])
    slave.enterInitializationMode(startTime=0.0)
    slave.exitInitializationMode()

    def step(time: float, length: float) -> tuple[int, bool, bool, float]:
        event, end, early, last = c_bool(), c_bool(), c_bool(), c_double()
        given = (c_double(time), c_double(length), c_bool(True), byref(event), byref(end), byref(early), byref(last))
        return int(slave.dll.fmi3DoStep(slave.component, *given)), end.value, early.value, last.value

    for k in range(LAST):
        assert step(k * H, H)[0] == OK
    time = LAST * H
    for expected, end in ((DISCARD, False), (DISCARD, True), (ERROR, True)):
        status, wish, early, last = step(time, H)
        assert (status, wish, early) == (expected, end, False)
        assert last == pytest.approx(time, abs=1e-12)
        assert "step_size" in messages[-1]
    assert step(time, 0.1 * H)[:2] == (OK, False)


@pytest.mark.parametrize("variant", ["native", "fmi3", "python"])
def test_fmpy_ends_soon_and_says_why(build: Callable[..., Path], variant: str, need: Callable[[str], None]) -> None:
    fmu = build("crank_slider", variant)
    code = (
        "import fmpy, sys\n"
        f"fmpy.simulate_fmu({str(fmu)!r}, stop_time=2.0, step_size={H}, output_interval={H}, "
        f"start_values={{'torque': 4.0, 'step_size': {H}}})\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=SECONDS)
    said = done.stdout + done.stderr
    assert "0.53 s" in said
    assert "step_size" in said
    assert len(said) < 10_000
