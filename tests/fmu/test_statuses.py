"""Statuses of the kernel in an FMU: message and remedy of each are in the log."""

from typing import Any

import fmpy
import pytest
from fmpy.fmi2 import fmi2CallbackFunctions

from mbs.kernel.binding import Status, load_library
from mbs.kernel.binding.errors import status_remedy
from tests.fmu.calls import DISCARD, ERROR, OK
from tests.fmu.test_refused_steps import LONG, at_the_edge

H = 0.01


HERE = {
    *(Status.NO_MEMORY, Status.NOT_ASSEMBLED, Status.NOT_CONVERGED),
    *(Status.NOT_FINITE, Status.START_REFUSED, Status.UNRESOLVED, Status.WHEEL_IN_ROAD, Status.BAD_INERTIA),
    Status.TURNS_TOO_FAR,
}
ELSEWHERE = {
    Status.BAD_FILE: "test_native_calls",
    Status.TOO_FAR: "test_native_agreement",
    Status.NO_EQUILIBRIUM: "test_changed_parameters",
    Status.BRANCH_CHANGED: "test_watch",
    Status.BAD_ROAD: "test_road_files",
    Status.ROAD_LOST: "test_road_files",
    Status.TOO_MUCH_WORK: "test_bounded_calls",
    Status.BAD_NORMAL: "test_road_answers",
    Status.BEYOND_TABLE: "test_refused_steps",
}
NEVER = {
    Status.BAD_ARGUMENT: "it refuses numbers that are not finite or out of range itself, by the name of the variable",
    Status.BAD_STATE: "it refuses bytes that were altered or are those of another FMU or version itself",
    Status.NOT_INITIALISED: "it refuses calls out of order itself",
    Status.FIXED_PARAMETER: "it refuses them itself, by the name of the variable",
    Status.WRONG_METHOD: "its method is 'ali3p', which accepts every System",
    Status.NO_TREE: "likewise",
    Status.TOO_STIFF: "likewise",
    Status.SINGULAR: "a model whose masses could be zero is refused when it is compiled",
}
"""Why an FMU does not say it."""


def said(status: Status, text: str) -> None:
    assert load_library().ali3_status_text(status).decode() in text
    assert text.count(status_remedy(status)) == 1


def test_every_status_is_caused_or_cannot_be():
    assert HERE | {*ELSEWHERE} | {*NEVER} == {*Status} - {Status.OK}
    assert len(HERE) + len(ELSEWHERE) + len(NEVER) == len(Status) - 1


def test_a_start_that_does_not_close(build, host):
    driven = host(build("led_crank"))
    assert driven.set("angle", 1.6) == OK
    driven.slave.setupExperiment(startTime=0.0)
    driven.slave.enterInitializationMode()
    assert driven.call("exitInitializationMode") == ERROR
    said(Status.NOT_ASSEMBLED, driven.messages[-1])
    assert "Worst constraint: 'bar" in driven.messages[-1]


def test_a_motion_that_becomes_infinite(build, host):
    driven = host(build("led_crank")).start()
    assert driven.set("push", 1e300) == OK
    assert driven.step(0.0, H) == DISCARD
    said(Status.NOT_FINITE, driven.messages[-1])
    assert "The step_size is 0.01 s" in driven.messages[-1]


def test_what_is_pulled_beyond_its_reach(build, host):
    driven = at_the_edge(build("reach"), host)
    assert driven.step(0.05, LONG) == DISCARD
    said(Status.NOT_CONVERGED, driven.messages[-1])


def refused_start(driven: Any, values: dict[str, float]) -> str:
    driven.slave.setupExperiment(startTime=0.0)
    for name, value in values.items():
        assert driven.set(name, value) == OK
    driven.slave.enterInitializationMode()
    assert driven.call("exitInitializationMode") == ERROR
    return str(driven.messages[-1])


def test_a_start_in_the_road(build, host):
    fmu = build("before_a_wall")
    text = refused_start(host(fmu), {"initial.z": -5.0})
    said(Status.START_REFUSED, text)
    clear = float(text.partition("from ")[2].partition(" m on it is clear")[0])
    assert host(fmu).start({"initial.z": clear}).step(0.0, H) == OK


def test_a_car_that_drove_into_a_wall_continues_from_another_state(build, host):
    fmu = build("before_a_wall")
    fast, slow = host(fmu).start({"initial.speed": 30.0}), host(fmu).start({"initial.speed": 3.0})
    begins = next(k * 0.002 for k in range(100) if fast.step(k * 0.002, 0.002) != OK)
    said(Status.WHEEL_IN_ROAD, fast.messages[-1])
    assert fast.restore(slow.saved()) == OK
    assert begins > 0
    assert fast.step(0.0, H) == OK
    assert fast.get("block.x") == pytest.approx(3.0 * H, rel=1e-6)


def test_an_inertia_that_no_body_has(build, host):
    fmu = build("thrown")
    text = refused_start(host(fmu), {"xx": 2.0})
    said(Status.BAD_INERTIA, text)
    assert "'xx' is 2 kg.m2, farthest from its start value 0.3" in text
    assert host(fmu).start({"xx": 0.35}).step(0.0, H) == OK


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "status", "shorter"),
    [("fast_armature", Status.TURNS_TOO_FAR, 1e-3), ("fast_cart", Status.UNRESOLVED, 1e-5)],
)
def test_a_shorter_step_passes(build, host, scene, status, shorter):
    driven = host(build(scene)).start({"step_size": H})
    begins = next((k for k in range(60) if driven.step(k * H, H) != OK), None)
    assert begins is not None
    said(status, driven.messages[-1])
    again = host(build(scene)).start({"step_size": shorter})
    again.run(begins + 1, H)


def test_without_memory(build, host):
    driven = host(build("crane"))
    inner, budget = fmpy.fmi2.defaultCallbacks, [10**6]

    def allocate(count: int, size: int) -> int | None:
        budget[0] -= 1
        return inner.allocateMemory(count, size) if budget[0] > 0 else None

    callbacks = fmi2CallbackFunctions()
    callbacks.logger = driven._callbacks.logger
    callbacks.allocateMemory = type(callbacks.allocateMemory)(allocate)
    callbacks.freeMemory = inner.freeMemory
    driven._callbacks = callbacks
    driven.instance()
    needed, texts = 10**6 - budget[0], []
    for most in range(1, needed):
        budget[0] = most
        with pytest.raises(Exception, match="nstantiate"):
            driven.instance()
        texts.append(driven.messages[-1])
    messages = [
        text
        for text in texts
        if load_library().ali3_status_text(Status.NO_MEMORY).decode() in text and "was refused" in text
    ]
    assert messages
    for text in messages:
        said(Status.NO_MEMORY, text)
