"""The Python FMU answers every call as the native one: statuses, words, values and states."""

import math
import random
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fmpy.fmi1 import FMICallException

from tests import kinds
from tests.fmu.calls import DISCARD, ERROR, OK, HostMaker

H = 0.01
LAST_SUCCESSFUL_TIME = 2
OF_THE_BUILD = 40  # bytes of a state that hold its checksum and the identity of the build
VALUES = (0.0, -0.0, 0.02, 0.3, 4.0, -7.0, 60.0, math.nan, math.inf, 1.5)
STEPS = (H, 3 * H, 0.1 * H, 0.2, 0.013, 0.0, -H, math.nan, 1e9)
SEED = 7
CALLS = 400


@pytest.fixture
def pair(build: Callable[..., Path], host: HostMaker) -> list[Any]:
    return [host(build("sprung_reach", kind)) for kind in kinds.FMI_2]


def both(pair: list[Any], function: str, *arguments: Any) -> Any:
    """The same call of both; what they gave and said must be the same."""
    answers = []
    for driven in pair:
        before = len(driven.messages)
        try:
            value = getattr(driven.slave, function)(*arguments)
            answers.append((OK, repr(value), driven.messages[before:]))
        except FMICallException as error:
            answers.append((int(error.status), "", driven.messages[before:]))
    assert answers[0] == answers[1], (function, arguments)
    return answers[0]


def states(pair: list[Any]) -> list[bytes]:
    return [d.saved() for d in pair]


def random_call(rng: random.Random, references: dict[str, int], time: float) -> tuple[str, tuple[Any, ...]]:
    known_names = list(references.values())
    requested = [rng.choice([*known_names, *known_names, *known_names, 999]) for _ in range(rng.randrange(3))]
    value = rng.choice(VALUES)
    inputs = [references["pull"]]
    return rng.choice(
        [
            ("setupExperiment", (None, rng.choice([0.0, math.nan]), rng.choice([None, 0.0, 50.0]))),
            ("enterInitializationMode", ()),
            ("exitInitializationMode", ()),
            ("terminate", ()) if rng.random() < 0.1 else ("cancelStep", ()),
            ("reset", ()) if rng.random() < 0.2 else ("getStatus", (0,)),
            *[("doStep", (time + rng.choice([0.0] * 9 + [0.5]), rng.choice(STEPS)))] * 6,
            *[
                ("setReal", ([references[n]], [value]))
                for n in ("pull", "pull", "spring.stiffness", "spring.free_length", "step_size")
            ],
            ("setReal", (requested, [value] * len(requested))),
            ("setInteger", (requested, [2] * len(requested))),
            ("setString", (requested, ["x"] * len(requested))),
            ("getReal", (requested,)),
            ("getReal", (list(references.values()),)),
            ("getInteger", (requested,)),
            ("getBoolean", (requested,)),
            ("getStatus", (rng.randrange(4),)),
            ("getRealStatus", (rng.randrange(4),)),
            ("getBooleanStatus", (rng.randrange(4),)),
            ("getIntegerStatus", (1,)),
            ("setRealInputDerivatives", (inputs, [rng.randrange(5)], [value])),
            ("getRealOutputDerivatives", ([references["bob.x"]], [1])),
            ("getDirectionalDerivative", ([references["bob.x"]], inputs, [1.0])),
            ("setDebugLogging", (rng.random() < 0.8, rng.choice([[], ["logAll"], ["logStatusError"], ["logNone"]]))),
        ]
    )


def test_random_calls_are_answered_alike(pair):
    rng = random.Random(SEED)
    references = pair[0].references
    assert references == pair[1].references
    statuses = []
    for k in range(CALLS):
        status, time, _ = both(pair, "getRealStatus", LAST_SUCCESSFUL_TIME)
        function, arguments = random_call(rng, references, float(time) if status == OK else 0.0)
        statuses.append(both(pair, function, *arguments)[0])
        if k == 20:  # a run, whatever came before
            for function in ("reset", "setupExperiment", "enterInitializationMode", "exitInitializationMode"):
                both(pair, function)
        native, python = states(pair)
        assert native[OF_THE_BUILD:] == python[OF_THE_BUILD:]
    assert {OK, DISCARD, ERROR} <= set(statuses)
    assert sum(s == OK for s in statuses) > CALLS // 4


@pytest.mark.parametrize("method", ["do_step", "get_real", "set_real", "terminate"])
def test_an_exception_of_python_ends_the_instance_and_is_reported(build, host, method):
    driven, other = host(build("crane", "python")).start(), host(build("crane", "python")).start()
    main = (driven.folder / "resources" / "slavemodule.txt").read_text()
    module = sys.modules[main.replace("main", "ali3") + ".slave"]
    calls = {
        "do_step": lambda d: d.step(0.0, H),
        "get_real": lambda d: d.call("getReal", [d.references["rod.x"]]),
        "set_real": lambda d: d.set("torque", 1.0),
        "terminate": lambda d: d.call("terminate"),
    }
    kept = getattr(module.Slave, method)
    try:
        setattr(module.Slave, method, lambda self, *arguments: 1 / 0)
        assert calls[method](driven) == ERROR
        assert "division by zero" in driven.messages[-1]
    finally:
        setattr(module.Slave, method, kept)
    for call in calls.values():
        assert call(driven) == ERROR
        assert "can only be freed" in driven.messages[-1]
    driven.slave.getFMUstate()
    driven.slave.freeInstance()
    assert [call(other) for call in calls.values()] == [OK] * len(calls)
