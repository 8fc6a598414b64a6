"""FMI 3.0: arrays, states, derivatives and order of calls through FMPy."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from fmu_src.variables.arrays import arrays
from fmu_src.variables.variables import Variable
from tests.fmu.host3 import STEP, Host3


@pytest.fixture
def crane3(build: Callable[..., Path]) -> Host3:
    return Host3(build("crane", "fmi3"))


def output(name: str, unit: str = "m") -> Variable:
    return Variable(name, "output", "continuous", unit, f"{name.rpartition('.')[2]} of it", "sensor", 0)


def test_vectors_and_series_become_arrays() -> None:
    table = [
        *(output(f"chassis.{c}") for c in "xyz"),
        *(output(f"chassis.q{c}", "1") for c in "wxyz"),
        output("alone.x"),
        output("alone.y"),
        *(output(f"gauge_{k}.stress", "Pa") for k in (1, 2, 3)),
        output("speed", "m/s"),
    ]
    found = arrays(table)
    assert [(a.name, len(a.items)) for a in found] == [
        ("chassis.position", 3),
        ("chassis.orientation", 4),
        ("alone.x", 1),
        ("alone.y", 1),
        ("gauge.stress", 3),
        ("speed", 1),
    ]
    assert [k for a in found for k in a.items] == list(range(len(table)))


def test_time_is_the_independent_variable(crane3: Host3) -> None:
    crane3.start().run(3)
    (name,) = (v.name for v in crane3.description.modelVariables if v.causality == "independent")
    assert crane3.get(name) == [3 * STEP]


def test_states_go_back_and_through_bytes(crane3: Host3, build: Callable[..., Path]) -> None:
    crane3.start().set("torque", 5.0)
    crane3.run(10)
    state = crane3.slave.getFMUState()
    data = crane3.slave.serializeFMUState(state)
    first = crane3.run(10, 10)
    crane3.slave.setFMUState(state)
    assert crane3.run(10, 10) == first
    other = Host3(build("crane", "fmi3"))
    other.slave.setFMUState(other.slave.deserializeFMUState(data))
    assert other.run(10, 10) == first
    altered = bytearray(data)
    altered[len(data) // 2] ^= 1
    with pytest.raises(FMICallException):
        other.slave.deserializeFMUState(bytes(altered))
    assert "altered" in other.messages[-1]


def test_adjoint_is_the_transposed_directional_derivative(crane3: Host3) -> None:
    crane3.start().set("torque", 5.0)
    crane3.run(10)
    crane3.slave.doStep(10 * STEP, 5 * STEP)  # of several inner steps
    unknown = [crane3.references[n] for n in ("rod.x", "rod.ay", "rod.angle")]
    known = [crane3.references["torque"]]
    forward = np.array(crane3.slave.getDirectionalDerivative(unknown, known, [1.0], 3))
    weights = np.array([2.0, -1.0, 0.5])
    (back,) = crane3.slave.getAdjointDerivative(unknown, known, list(weights), 1)
    assert back == pytest.approx(float(weights @ forward), rel=1e-12)
    assert abs(back) > 0.0


def test_wrong_calls_are_errors_with_a_sentence(crane3: Host3) -> None:
    with pytest.raises(FMICallException):
        crane3.slave.doStep(0.0, STEP)
    assert "not allowed" in crane3.messages[-1]
    crane3.start()
    for call in (
        lambda: crane3.slave.getFloat64([4711]),
        lambda: crane3.slave.getFloat64([crane3.references["rod.x"]], 3),
        lambda: crane3.slave.getInt32([0]),
        lambda: crane3.set("rod.x", 1.0),
        lambda: crane3.set("torque", float("nan")),
        crane3.slave.enterEventMode,
        crane3.slave.enterConfigurationMode,
        lambda: crane3.slave.getDirectionalDerivative([0], [0], [1.0], 1),
    ):
        said = len(crane3.messages)
        with pytest.raises(FMICallException):
            call()
        assert len(crane3.messages) == said + 1
    crane3.run(2)


def test_model_exchange_and_events_are_refused(build: Callable[..., Path]) -> None:
    host = Host3(build("crane", "fmi3"))
    with pytest.raises(Exception, match="nstantiate"):
        host.slave.instantiate(eventModeUsed=True, logMessage=lambda *a: host.messages.append(a[-1].decode()))
    assert "event mode" in host.messages[-1]


def test_terminals_name_variables_that_are_there(build: Callable[..., Path]) -> None:
    fmu = build("crane", "fmi3")
    with zipfile.ZipFile(fmu) as archive:
        root = ElementTree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    variables = {v.name for v in fmpy.read_model_description(str(fmu)).modelVariables}
    members = [m.attrib["variableName"] for m in root.iter("TerminalMemberVariable")]
    assert members
    assert set(members) <= variables


def test_a_host_that_offers_intermediate_updates_is_not_called_and_makes_short_steps_instead(build) -> None:
    """An input that is held over five inner steps gives the bits of five short steps; one that changes, others."""
    called: list[float] = []
    ends = []
    for length, torques in ((5, [4.0]), (1, [4.0] * 5), (1, [4.0, 5.0, 6.0, 7.0, 8.0])):
        host = Host3(build("crane", "fmi3"))
        torque = host.references["torque"]
        host.slave.instantiate(
            earlyReturnAllowed=True,
            intermediateUpdate=lambda *arguments: called.append(arguments[1]),
            requiredIntermediateVariables=[torque],
        )
        host.set("step_size", STEP)
        host.start()
        for k, value in enumerate(torques):
            host.set("torque", value)
            host.slave.doStep(k * length * STEP, length * STEP)
        ends.append(host.get("rod.angle"))
    assert called == []
    assert host.description.coSimulation.providesIntermediateUpdate is not True
    assert ends[0] == ends[1] != ends[2]
