"""FMI 3.0: arrays, states, derivatives and order of calls through FMPy."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from fmu_src.variables.arrays import arrays
from fmu_src.variables.variables import Variable
from hosts.fmu.fmu import Fmu
from hosts.fmu.scalars import ELEMENTS, element_names
from tests.fmu.calls import HostMaker

STEP = 0.01


@pytest.fixture
def crane3(build: Callable[..., Path], host: HostMaker) -> Any:
    return host(build("crane", "fmi3"))


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


def test_time_is_the_independent_variable(crane3: Any) -> None:
    crane3.start().run(3, STEP)
    (name,) = (v.name for v in crane3.description.modelVariables if v.causality == "independent")
    assert crane3.get(name) == 3 * STEP


def test_adjoint_is_the_transposed_directional_derivative(crane3: Any) -> None:
    crane3.start().set("torque", 5.0)
    crane3.run(10, STEP)
    crane3.slave.doStep(10 * STEP, 5 * STEP)  # of several inner steps
    unknown = [crane3.references[n] for n in ("rod.x", "rod.ay", "rod.angle")]
    known = [crane3.references["torque"]]
    forward = np.array(crane3.slave.getDirectionalDerivative(unknown, known, [1.0], 3))
    weights = np.array([2.0, -1.0, 0.5])
    (back,) = crane3.slave.getAdjointDerivative(unknown, known, list(weights), 1)
    assert back == pytest.approx(float(weights @ forward), rel=1e-12)
    assert abs(back) > 0.0


def test_wrong_calls_are_errors_with_a_sentence(crane3: Any) -> None:
    crane3.start()
    for call in (
        lambda: crane3.slave.getFloat64([crane3.references["rod.x"]], 3),
        crane3.slave.enterEventMode,
        crane3.slave.enterConfigurationMode,
        lambda: crane3.slave.getDirectionalDerivative([0], [0], [1.0], 1),
    ):
        said = len(crane3.messages)
        with pytest.raises(FMICallException):
            call()
        assert len(crane3.messages) == said + 1
    crane3.run(2, STEP)


@pytest.mark.parametrize("scene", ["crane", "gearstick", "hopper"])
def test_values_before_initialisation_are_start_values_or_what_was_set(
    build: Callable[..., Path], host: HostMaker, scene: str
) -> None:
    """Those of modelDescription.xml, of every type; outputs have none and are refused; again after a reset."""
    one = host(build(scene, "fmi3"))
    read = {"Float64": one.slave.getFloat64, "Int32": one.slave.getInt32, "String": one.slave.getString}
    put = {"Float64": one.slave.setFloat64, "Int32": one.slave.setInt32}
    known = [v for v in one.description.modelVariables if v.start is not None]
    assert "parameter" in {v.causality for v in known}

    def values() -> list[str | float]:
        return [read[v.type]([v.valueReference])[0] for v in known]

    starts = [v.start if v.type == "String" else float(v.start) for v in known]
    begun = [x.decode() if isinstance(x, bytes) else x for x in values()]
    assert begun == starts
    for v in known:
        if v.type in put and v.variability != "constant":
            low, high = (float(b) if b is not None else None for b in (v.min, v.max))
            value = low if low is not None and low != float(v.start) else high if high is not None else 1.0
            put[v.type]([v.valueReference], [int(value) if v.type == "Int32" else value])
            assert read[v.type]([v.valueReference]) == [value]
    with pytest.raises(FMICallException):
        one.get("solver.energy_error")
    assert "'solver.energy_error' is an output without a start value" in one.messages[-1]
    assert one.get("time") == 0.0
    one.slave.reset()
    assert [x.decode() if isinstance(x, bytes) else x for x in values()] == starts


def test_a_run_may_end_where_it_starts(crane3: Any) -> None:
    """Then no step fits; its state can be set again; an end before the start is refused."""
    one = crane3
    one.slave.setupExperiment(startTime=2.0, stopTime=1.0)
    with pytest.raises(FMICallException):
        one.slave.enterInitializationMode()
    assert "lies before the start time 2 s" in one.messages[-1]
    one.slave.reset()
    one.slave.setupExperiment(startTime=2.0, stopTime=2.0)
    one.slave.enterInitializationMode()
    one.slave.exitInitializationMode()
    x = one.get("rod.x")
    data = one.slave.serializeFMUState(one.slave.getFMUState())
    one.slave.setFMUState(one.slave.deserializeFMUState(data))
    assert one.get("time") == 2.0
    assert one.get("rod.x") == x
    with pytest.raises(FMICallException):
        one.slave.doStep(2.0, STEP)
    assert "beyond the stop time" in one.messages[-1]


def test_model_exchange_and_events_are_refused(crane3: Any) -> None:
    with pytest.raises(Exception, match="nstantiate"):
        crane3.slave.instantiate(eventModeUsed=True, logMessage=lambda *a: crane3.messages.append(a[-1].decode()))
    assert "event mode" in crane3.messages[-1]


def test_terminals_name_variables_that_are_there(build: Callable[..., Path]) -> None:
    fmu = build("crane", "fmi3")
    with zipfile.ZipFile(fmu) as archive:
        root = ElementTree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    variables = {v.name for v in fmpy.read_model_description(str(fmu)).modelVariables}
    members = [m.attrib["variableName"] for m in root.iter("TerminalMemberVariable")]
    assert members
    assert set(members) <= variables


def test_a_dimension_is_the_first_thing_in_its_variable(build: Callable[..., Path]) -> None:
    """FMI Library passes over one behind annotations; the names of elements stand in a file beside the description."""
    fmu, scalar = build("answered", "fmi3"), build("answered", "fmi3_scalar")
    with zipfile.ZipFile(fmu) as archive:
        names = element_names(archive.read(ELEMENTS).decode())
        variables = ElementTree.fromstring(archive.read("modelDescription.xml")).find("ModelVariables")
    assert variables is not None
    arrays = {v.attrib["name"]: v for v in variables if v.find("Dimension") is not None}
    assert arrays
    assert all([child.tag for child in v] == ["Dimension"] for v in arrays.values())
    assert {a: len(of) for a, of in names.items()} == {a: int(v[0].attrib["start"]) for a, v in arrays.items()}
    with Fmu(fmu) as one, Fmu(scalar) as two:
        assert list(one.variables) == list(two.variables)
    with zipfile.ZipFile(scalar) as archive:
        assert ELEMENTS not in archive.namelist()


def test_a_host_that_offers_intermediate_updates_is_not_called_and_makes_short_steps_instead(build, host) -> None:
    """An input that is held over five inner steps gives the bits of five short steps; one that changes, others."""
    called: list[float] = []
    ends = []
    for length, torques in ((5, [4.0]), (1, [4.0] * 5), (1, [4.0, 5.0, 6.0, 7.0, 8.0])):
        driven = host(build("crane", "fmi3"))
        torque = driven.references["torque"]
        driven.slave.instantiate(
            earlyReturnAllowed=True,
            intermediateUpdate=lambda *arguments: called.append(arguments[1]),
            requiredIntermediateVariables=[torque],
        )
        driven.set("step_size", STEP)
        driven.start()
        for k, value in enumerate(torques):
            driven.set("torque", value)
            driven.slave.doStep(k * length * STEP, length * STEP)
        ends.append(driven.get("rod.angle"))
    assert called == []
    assert driven.description.coSimulation.providesIntermediateUpdate is not True
    assert ends[0] == ends[1] != ends[2]
