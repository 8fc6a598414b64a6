"""A host may round in another way, take denormal numbers for 0 or trap: it gets the same bits, and keeps its register.
No call raises a flag of invalid, division by zero or overflow."""

import math
import platform
import sys
import zipfile
from collections.abc import Callable
from ctypes import c_double
from pathlib import Path
from typing import Any

import pytest

from mbs.vehicle.read_car import car_names
from tests.fmu.calls import DISCARD, OK, HostMaker
from tests.in_process import build_fmu
from tests.processor import DEFAULT, FLAGS, ODD, control, flags, mathematics, set_control, set_flags
from tests.quick import quick

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64", reason="the test sets the register of x86-64 Linux"
)
STEP = 0.01
WRONG = FLAGS["invalid"] | FLAGS["division by zero"] | FLAGS["overflow"]
PARTS = {"throttle": (0.0, 0.4), "steering": (0.2, 0.6), "brake": (0.5, 0.8), "hand_brake": (0.9, 1.0)}
"""Of a drive: from where to where an input that jumps to 1 and back is on."""

STARTS: tuple[dict[str, float], ...] = ({}, {"initial.z": 1.5, "initial.speed": 15.0})
"""At rest on the ground; in the air and fast, from where it falls on its stops and its wheels turn alone."""


class Messages(list[str]):
    """What the host's logger gets; `controls`: of the register while it was called."""

    def __init__(self) -> None:
        super().__init__()
        self.controls: set[int] = set()

    def append(self, text: str) -> None:
        self.controls.add(control())
        super().append(text)


class Odd:
    """Methods of an object, each called under a control, which must still be there when it returns.

    `calls`: how many; `wrong`: those that raised a flag of invalid, division by zero or overflow, and which.
    """

    def __init__(self, called: Any, under: int) -> None:
        self.called, self.under, self.calls = called, under, 0
        self.wrong: list[tuple[str, int, int]] = []

    def __getattr__(self, name: str) -> Any:
        method = getattr(self.called, name)
        if not callable(method):
            return method

        def call(*arguments: Any, **more: Any) -> Any:
            set_flags(0)
            set_control(self.under)
            try:
                return method(*arguments, **more)
            finally:
                after, raised = control(), flags() & WRONG
                set_control(DEFAULT)
                self.calls += 1
                self.wrong += [(name, self.calls, raised)] if raised else []
                assert after == self.under, f"{name} leaves {after:#x} for {self.under:#x}"

        return call


def odd_host(host: HostMaker, fmu: Path, under: int) -> Any:
    """A host of the fixture `host` all of whose calls are made under a control."""
    set_control(under)
    odd = host(fmu)
    after = control()
    set_control(DEFAULT)
    assert after == under
    odd.messages = Messages()
    odd.slave = Odd(odd.slave, under)
    return odd


def bits(host: HostMaker, fmu: Path, under: int, drive: dict[str, float], steps: int, **start: float) -> list[Any]:
    """Outputs of each step, a derivative and a saved state."""
    odd = odd_host(host, fmu, under)
    odd.start({name.replace("__", "."): value for name, value in start.items()})
    for name, value in drive.items():
        assert odd.set(name, value) == OK
    result: list[Any] = odd.run(steps, STEP)
    known = odd.references[next(iter(drive))]
    unknown = [v.valueReference for v in odd.description.modelVariables if v.causality == "output"][:3]
    result.append(list(odd.slave.getDirectionalDerivative(unknown, [known], *([1.0], 3) if odd.three else [[1.0]])))
    state = odd.slave.getFMUState() if odd.three else odd.slave.getFMUstate()
    result.append(bytes(odd.slave.serializeFMUstate(state)))
    assert odd.slave.calls > steps
    odd.slave.terminate()
    return result


def test_the_bits_do_not_depend_on_the_host(crane: Path, host: HostMaker) -> None:
    drive = {"torque": 5.0}
    usual = bits(host, crane, DEFAULT, drive, 20)
    assert all(map(math.isfinite, usual[-3]))
    for name, under in ODD.items():
        assert bits(host, crane, under, drive, 20) == usual, name


def test_the_logger_has_the_register_of_its_host(reach: Path, host: HostMaker) -> None:
    for name, under in ODD.items():
        result = odd_host(host, reach, under)
        result.start()
        result.set("pull", 10.0)
        assert result.step(0.0, 1.0) == DISCARD
        assert result.messages
        assert result.messages.controls == {under}, name
        result.messages.clear()
        result.call("getReal", [10**6])
        assert result.messages.controls == {under}


def test_flags_of_the_host_stay(crane: Path, host: HostMaker) -> None:
    for under in (DEFAULT, *ODD.values()):
        result = host(crane).start()
        set_flags(FLAGS["division by zero"])
        set_control(under)
        result.slave.doStep(0.0, STEP)
        assert flags() & WRONG == FLAGS["division by zero"]
        set_control(DEFAULT)


def test_a_flag_is_seen() -> None:
    library = Odd(mathematics(), DEFAULT)
    library.called.log.argtypes, library.called.log.restype = [c_double], c_double
    assert library.log(1.0) == 0.0
    assert math.isnan(library.log(-1.0))
    library.log(0.0)
    assert library.wrong == [("log", 2, FLAGS["invalid"]), ("log", 3, FLAGS["division by zero"])]


@pytest.fixture(scope="session")
def car_fmu(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Callable[[str], Path]:
    """Builds the FMU of a car in all fidelities once."""
    return lambda car: next(made_once(f"all_of_{car}", lambda folder: build_fmu(folder, "--car", car)).glob("*.fmu"))


@pytest.mark.slow
@pytest.mark.parametrize("car", quick(("prototype", "commonroad_320i"), car_names(), "proof"))
def test_a_drive_of_a_car_raises_no_flag(car_fmu: Callable[[str], Path], host: HostMaker, car: str) -> None:
    """A start, full lock, braking to a stop, and what stands, all by jumps, at 2 ms; of several fidelities each from
    one of the starts.
    """
    fmu, steps = car_fmu(car), 1500
    systems = len([name for name in zipfile.ZipFile(fmu).namelist() if name.endswith(".ali3")])
    for fidelity in range(systems):
        chosen = {"fidelity": float(fidelity)} if systems > 1 else {}
        for start in STARTS if systems == 1 else STARTS[fidelity % 2 :][:1]:
            set_flags(0)
            result = host(fmu)
            assert flags() & WRONG == 0
            result.slave = Odd(result.slave, DEFAULT)
            result.start(chosen | start)
            variables = result.description.modelVariables
            inputs = {v.name: v.valueReference for v in variables if v.causality == "input"}
            outputs = [v.valueReference for v in variables if v.causality == "output"]
            for k in range(steps):
                on = {name for name, (begin, end) in PARTS.items() if begin <= k / steps < end} | {"selector"}
                result.slave.setReal([*inputs.values()], [float(name in on) for name in inputs])
                result.slave.doStep(k * 0.002, 0.002)
                result.slave.getReal(outputs)
            assert result.slave.wrong == [], f"fidelity {fidelity} from {start}"


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", quick((0, 3), range(4), "proof"))
def test_no_car_depends_on_the_host(car_fmu: Callable[[str], Path], host: HostMaker, fidelity: int) -> None:
    fmu, drive = car_fmu("prototype"), {"throttle": 0.4, "steering": 0.3, "selector": 1.0}
    usual = bits(host, fmu, DEFAULT, drive, 20, initial__speed=10.0, fidelity=fidelity)
    for name, under in ODD.items():
        assert bits(host, fmu, under, drive, 20, initial__speed=10.0, fidelity=fidelity) == usual, name
