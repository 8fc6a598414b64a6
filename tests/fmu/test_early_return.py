"""FMI 3.0: a step returns early where a later inner step is refused or a car turns over, if the host allows it.

By FMPy and by the project's host in C.
"""

import subprocess
from collections.abc import Callable, Mapping
from ctypes import byref, c_bool, c_double
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from fmpy import platform_tuple

from tests.fmu.calls import DISCARD, OK, HostMaker
from tests.fmu.native import HOST_SOURCE, compile_host, unpack

Host3 = Callable[..., tuple[int, list[list[float]], str]]


class Answer(NamedTuple):
    """What a step says."""

    status: int
    early: bool
    last: float


def ready(driven: Any, start: Mapping[str, float], early: bool) -> Any:
    """After initialisation, with inputs and parameters set."""
    driven.slave.instantiate(earlyReturnAllowed=early)
    for name, value in start.items():
        assert driven.set(name, value) == OK
    return driven.start()


def stepped(driven: Any, time: float, length: float) -> Answer:
    event, end, early, last = c_bool(), c_bool(), c_bool(), c_double()
    pointers = byref(event), byref(end), byref(early), byref(last)
    slave = driven.slave
    status = slave.dll.fmi3DoStep(slave.component, c_double(time), c_double(length), c_bool(True), *pointers)
    return Answer(status, early.value, last.value)


@pytest.fixture(scope="module")
def host3(tmp_path_factory: pytest.TempPathFactory) -> Host3:
    """Runs the host in C: exit code, rows and what it says."""
    folder = tmp_path_factory.mktemp("host3")
    program = compile_host(folder, source=HOST_SOURCE.with_name("host3.c"))

    def run(fmu: Path, driven: Any, steps: int, length: float, shown: str, start: Mapping[str, float], early: bool):
        place = folder / fmu.stem
        if not place.exists():
            unpack(fmu, place)
        library = next((place / "binaries" / platform_tuple).iterdir())
        number = driven.references
        assignments = [f"{number[name]}={value}" for name, value in start.items()]
        options = ["--early"] if early else []
        command = [program, *options, library, f"{place / 'resources'}/", driven.description.guid, steps, length]
        done = subprocess.run(
            [*map(str, command), *[str(number[shown])] * 2, *assignments], capture_output=True, text=True, check=False
        )
        return (
            done.returncode,
            [[float.fromhex(w) for w in row.split()] for row in done.stdout.splitlines()],
            done.stderr,
        )

    return run


@pytest.mark.slow
def test_where_a_wheel_leaves_its_table(build: Callable[..., Path], host: HostMaker, host3: Host3) -> None:
    """Its time is that of the last good inner step, from which the next step is refused as any other."""
    fmu, start, length, shown = build("carried_off", "fmi3_scalar"), {"force": -50.0}, 0.5, "travel"
    assert stepped(ready(host(fmu), start, False), 0.0, length) == (DISCARD, False, 0.0)
    driven = ready(host(fmu), start, True)
    answer = stepped(driven, 0.0, length)
    assert answer[:2] == (OK, True)
    assert 0.0 < answer.last < length
    place = driven.get(shown)
    assert stepped(driven, answer.last, length) == (DISCARD, False, answer.last)
    assert driven.get(shown) == place
    code, rows, output = host3(fmu, driven, 3, length, shown, start, True)
    assert (code, rows) == (6, [[answer.last, place]])
    assert f"the step to {length:g} s returned early at {answer.last:g} s" in output
    code, rows, _ = host3(fmu, driven, 3, length, shown, start, False)
    assert (code, rows) == (4, [])


@pytest.mark.slow
def test_where_a_car_turns_over(scene_fmu: Callable[..., Path], host: HostMaker, host3: Host3) -> None:
    """After the inner step in which it has; it goes on from there."""
    car = scene_fmu("prototype_car", "fmi3_scalar")
    start = {"initial.speed": 30.0, "front.tyre.grip": 3.0, "rear.tyre.grip": 3.0, "steering": 1.0}
    driven, time, length = ready(host(car), start, True), 0.0, 0.5
    while not (answer := stepped(driven, time, length)).early:
        assert answer.status <= 1
        time = answer.last
        assert time < 5.0
    assert time < answer.last < time + length
    roll = driven.get("chassis.roll")
    assert abs(roll) > 0.5 * np.pi
    steps = round(time / length) + 1
    code, rows, _ = host3(car, driven, steps + 3, length, "chassis.roll", start, True)
    assert code == 6
    assert len(rows) == steps
    assert rows[-1] == [answer.last, roll]
    assert all(abs(row[1]) < 0.5 * np.pi for row in rows[:-1])
    whole = stepped(driven, answer.last, length)  # it is told once
    assert (whole.early, whole.last) == (False, pytest.approx(answer.last + length))
    code, rows, _ = host3(car, driven, steps, length, "chassis.roll", start, False)
    assert (code, rows[-1][0]) == (0, pytest.approx(steps * length))
