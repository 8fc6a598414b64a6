"""A refused step stops a host instead of looping it, with a remedy in the message."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.fmu.calls import DISCARD, ERROR, OK, HostMaker

# The mechanism is pulled beyond its reach within LONG, not within H.
BEGIN = 0.05  # s
H = 0.01  # s
LONG = 0.2  # s
PULL = 5.0
SECONDS = 60.0


def at_the_edge(fmu: Path, host: HostMaker) -> Any:
    driven = host(fmu).start()
    driven.run(5, H)
    assert driven.set("pull", PULL) == OK
    return driven


def test_asked_again_it_wishes_the_end_and_then_is_an_error(reach: Path, host: HostMaker) -> None:
    driven = at_the_edge(reach, host)
    before = driven.outputs()
    time = BEGIN
    assert driven.step(time, LONG) == DISCARD
    assert not driven.wishes_end()
    assert "step_size" in driven.messages[-1]
    assert driven.set("pull", PULL) == OK  # nothing new
    assert driven.step(time, LONG) == DISCARD
    assert driven.wishes_end()
    assert driven.step_status() == DISCARD
    assert driven.step(time, LONG) == ERROR
    assert driven.step_status() == ERROR
    assert "step_size" in driven.messages[-1]
    assert driven.step(time, LONG) == ERROR
    assert driven.outputs() == before
    assert driven.last_time() == pytest.approx(time, abs=1e-12)
    assert driven.step(time, H) == OK


@pytest.mark.parametrize("change", ["shorter step", "input", "state"])
def test_calls_that_clear_a_refused_step(reach: Path, host: HostMaker, change: str) -> None:
    driven = at_the_edge(reach, host)
    time = BEGIN
    state = driven.slave.getFMUstate()
    assert driven.step(time, LONG) == driven.step(time, LONG) == DISCARD
    assert driven.wishes_end()
    if change == "shorter step":
        assert driven.step(time, H) == OK
        time += H
    elif change == "input":
        assert driven.set("pull", 0.9 * PULL) == OK
    else:
        driven.slave.setFMUstate(state)
    assert driven.three or not driven.wishes_end()
    assert driven.step(time, LONG) in (OK, DISCARD)
    assert driven.step_status() in (OK, DISCARD)


def test_what_has_left_its_table_is_named_with_its_range(build: Callable[..., Path], host: HostMaker) -> None:
    driven = host(build("carried_off")).start()
    assert driven.set("force", -50.0) == OK
    count = next(k for k in range(100) if driven.step(k * H, H) != OK)
    travel = -12.5 * (count * H) ** 2  # 50 N on 2 kg
    assert -0.29 < travel < -0.25
    message = driven.messages[-1]
    assert "a coordinate has left the range of its table. 'wheel travel RL' is -0.2" in message
    value = float(message.partition("'wheel travel RL' is ")[2].partition(";")[0])
    assert value == pytest.approx(travel, abs=2e-3)
    assert "its table goes from -0.2 to 0.2" in message


def test_fmpy_ends_soon_with_the_reason(build: Callable[..., Path]) -> None:
    code = (
        "import fmpy, numpy as np\n"
        f"rows = [(0.0, 0.0), ({BEGIN}, 0.0), ({BEGIN}, {PULL}), (2.0, {PULL})]\n"
        "pull = np.array(rows, dtype=[('time', float), ('pull', float)])\n"
        f"fmpy.simulate_fmu({str(build('reach'))!r}, stop_time=2.0, output_interval={BEGIN}, input=pull)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=SECONDS)
    output = done.stdout + done.stderr
    assert "was refused" in output
    assert "step_size" in output
    assert len(output) < 10_000
