"""Random legal and illegal sequences of calls: the status the standard asks for, and never a crash or a NaN."""

import math
from collections.abc import Callable
from ctypes import CFUNCTYPE, c_size_t, c_void_p
from typing import Any

import fmpy
import pytest
from fmpy.fmi2 import fmi2CallbackFunctions
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule, run_state_machine_as_test

from mbs.kernel.binding import Status
from tests.fmu.calls import ERROR, OK, WARNING
from tests.fmu.test_statuses import said

INSTANTIATED, INITIALISING, STEPPING, TERMINATED = "instantiated", "initialising", "stepping", "terminated"
RUNS = 60
LENGTH = 30
STEPS = st.sampled_from([0.003, 0.01, 0.02, 0.0, -0.01, math.nan, math.inf])
VALUES = st.floats(-40.0, 40.0) | st.sampled_from([math.nan, math.inf, -math.inf])


def machine(make: Callable[[], Any]) -> type[RuleBasedStateMachine]:
    """A model of the life cycle beside a real instance."""

    class Calls(RuleBasedStateMachine):
        def __init__(self) -> None:
            super().__init__()
            self.driven = make()
            self.phase, self.time = INSTANTIATED, 0.0
            self.saved: tuple[Any, str, float, list[float]] | None = None

        def expect(self, status: int, allowed: bool) -> None:
            assert (status == OK) == allowed, (status, self.phase, self.driven.messages[-1:])
            if not allowed:
                assert status == ERROR
                assert self.driven.messages

        @rule()
        def setup(self) -> None:
            self.expect(self.driven.call("setupExperiment"), self.phase == INSTANTIATED)

        @rule()
        def enter(self) -> None:
            self.expect(self.driven.call("enterInitializationMode"), self.phase == INSTANTIATED)
            if self.phase == INSTANTIATED:
                self.phase = INITIALISING

        @rule()
        def leave(self) -> None:
            self.expect(self.driven.call("exitInitializationMode"), self.phase == INITIALISING)
            if self.phase == INITIALISING:
                self.phase, self.time = STEPPING, 0.0

        @rule()
        def terminate(self) -> None:
            self.expect(self.driven.call("terminate"), self.phase == STEPPING)
            if self.phase == STEPPING:
                self.phase = TERMINATED

        @rule()
        def reset(self) -> None:
            self.expect(self.driven.call("reset"), True)
            self.phase, self.time = INSTANTIATED, 0.0

        @rule(step=STEPS, late=st.booleans())
        def step(self, step: float, late: bool) -> None:
            good = self.phase == STEPPING and 0.0 < step < math.inf and not late
            status = self.driven.step(self.time + (0.5 if late else 0.0), step)
            assert status in ((OK, WARNING) if good else (ERROR,))
            if good:
                self.time += step

        @rule(value=VALUES, name=st.sampled_from(["torque", "spring.stiffness", "step_size", "rod.x"]))
        def set(self, value: float, name: str) -> None:
            status = self.driven.set(name, value)
            if self.phase == TERMINATED or name == "rod.x" or not math.isfinite(value):
                assert status == ERROR
            elif name == "torque":
                assert status in (OK, WARNING)
            elif name == "step_size":
                assert (status == OK) == (self.phase != STEPPING and 1e-4 <= value <= 0.1)
            else:
                assert (status == OK) == (0.0 <= value <= 50.0)

        @rule(order=st.integers(-1, 5), value=VALUES)
        def slope(self, order: int, value: float) -> None:
            good = self.phase != TERMINATED and 1 <= order <= 3 and math.isfinite(value)
            reference = self.driven.references["torque"]
            self.expect(self.driven.call("setRealInputDerivatives", [reference], [order], [value]), good)

        @rule()
        def cancel(self) -> None:
            assert self.driven.call("cancelStep") == ERROR

        @rule()
        def save(self) -> None:
            outputs = self.driven.outputs() if self.phase in (STEPPING, TERMINATED) else []
            if self.saved is not None:
                self.driven.slave.freeFMUstate(self.saved[0])
            self.saved = (self.driven.slave.getFMUstate(), self.phase, self.time, outputs)

        @precondition(lambda self: self.saved is not None)
        @rule(through_bytes=st.booleans())
        def restore(self, through_bytes: bool) -> None:
            assert self.saved is not None
            state, self.phase, self.time, outputs = self.saved
            if through_bytes:
                state = self.driven.slave.deSerializeFMUstate(self.driven.slave.serializeFMUstate(state))
            assert self.driven.call("setFMUstate", state) == OK
            if outputs:
                assert self.driven.outputs() == outputs

        @invariant()
        def outputs_are_numbers(self) -> None:
            if self.phase == INSTANTIATED:
                assert self.driven.call("getReal", [self.driven.references["rod.x"]]) == ERROR
            else:
                assert all(map(math.isfinite, self.driven.outputs()))

        def teardown(self) -> None:
            if self.saved is not None:
                self.driven.slave.freeFMUstate(self.saved[0])
            self.driven.slave.fmi2FreeInstance(self.driven.slave.component)

    return Calls


@pytest.mark.slow
def test_random_sequences(build, host):
    first = host(build("crane", "native"))

    def make() -> Any:
        driven = object.__new__(type(first))
        driven.__dict__.update(first.__dict__)
        driven.slave = first.instance()
        return driven

    run_state_machine_as_test(
        machine(make),
        settings=settings(
            max_examples=RUNS,
            stateful_step_count=LENGTH,
            deadline=None,
            derandomize=True,
            database=None,
            suppress_health_check=list(HealthCheck),
        ),
    )


def test_allocation_is_the_hosts(build, host):
    driven = host(build("crane", "native"))
    alive: set[int] = set()
    inner = fmpy.fmi2.defaultCallbacks

    @CFUNCTYPE(c_void_p, c_size_t, c_size_t)
    def allocate(count: int, size: int) -> int:
        block = inner.allocateMemory(count, size)
        alive.add(block)
        return int(block)

    @CFUNCTYPE(None, c_void_p)
    def free(block: int) -> None:
        alive.remove(block)
        inner.freeMemory(block)

    callbacks = fmi2CallbackFunctions()
    callbacks.logger = driven._callbacks.logger
    callbacks.allocateMemory = type(callbacks.allocateMemory)(lambda n, size: allocate(n, size))
    callbacks.freeMemory = type(callbacks.freeMemory)(lambda block: free(block))
    driven._callbacks = callbacks
    slave = driven.instance()
    instance = len(alive)
    state = slave.getFMUstate()
    assert len(alive) == instance + 1 > 4
    slave.freeFMUstate(state)
    slave.fmi2FreeInstance(slave.component)
    assert not alive


def test_log_categories(build, host):
    driven = host(build("crane", "native"))

    def logging(on: bool, *names: str) -> int:
        return int(driven.call("setDebugLogging", on, list(names)))

    assert driven.messages == []
    assert logging(True) == OK
    driven.start()
    assert any("Initialised" in m for m in driven.messages)
    driven.set("torque", 99.0)
    assert "99" in driven.messages[-1]
    assert logging(True, "logStatusError") == OK
    count = len(driven.messages)
    driven.slave.doStep(0.0, 0.003)
    assert len(driven.messages) == count
    assert driven.set("torque", math.nan) == ERROR
    assert len(driven.messages) == count + 1
    assert logging(True, "logNothing") == ERROR
    assert "logNothing" in driven.messages[-1]
    assert logging(False) == OK
    assert driven.set("torque", math.nan) == ERROR
    assert len(driven.messages) == count + 3


def test_a_damaged_system_file_is_refused_with_a_reason(build, host, tmp_path):
    driven = host(build("crane", "native"), tmp_path / "fmu")
    file = driven.folder / "resources" / "system_0.ali3"
    good = file.read_bytes()
    for bad, reason in ((good[:-1], "refused"), (good[:40] + b"\xff" + good[41:], "refused"), (b"", "cannot be read")):
        file.write_bytes(bad)
        with pytest.raises(Exception, match="instantiate"):
            driven.instance()
        assert reason in driven.messages[-1]
        if reason == "refused":
            said(Status.BAD_FILE, driven.messages[-1])
    file.unlink()
    with pytest.raises(Exception, match="instantiate"):
        driven.instance()
    assert "system_0.ali3" in driven.messages[-1]


def test_the_system_of_another_fmu_is_refused(build, host, tmp_path):
    driven, other = host(build("crane", "native"), tmp_path / "a"), host(build("reach", "native"), tmp_path / "b")
    mine, theirs = (instance.folder / "resources" / "system_0.ali3" for instance in (driven, other))
    mine.write_bytes(theirs.read_bytes())
    with pytest.raises(Exception, match="instantiate"):
        driven.instance()
    assert "does not belong" in driven.messages[-1]
