"""FMI 3.0: arrays, states, derivatives and order of calls through FMPy."""

import math
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


def test_vectors_and_series_become_arrays():
    table = [
        *(output(f"chassis.{c}") for c in "xyz"),
        *(output(f"chassis.q{c}", "1") for c in "wxyz"),
        output("alone.x"),
        output("alone.y"),
        *(output(f"gauge_{k}.stress", "Pa") for k in (1, 2, 3)),
        output("speed", "m/s"),
    ]
    actual = arrays(table)
    assert [(a.name, len(a.items)) for a in actual] == [
        ("chassis.position", 3),
        ("chassis.orientation", 4),
        ("alone.x", 1),
        ("alone.y", 1),
        ("gauge.stress", 3),
        ("speed", 1),
    ]
    assert [k for a in actual for k in a.items] == list(range(len(table)))


def test_adjoint_is_the_transposed_directional_derivative(crane3):
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


def test_wrong_calls_are_errors_with_a_sentence(crane3):
    crane3.start()
    for call in (
        lambda: crane3.slave.getFloat64([crane3.references["rod.x"]], 3),
        crane3.slave.enterEventMode,
        crane3.slave.enterConfigurationMode,
        lambda: crane3.slave.getDirectionalDerivative([0], [0], [1.0], 1),
    ):
        count = len(crane3.messages)
        with pytest.raises(FMICallException):
            call()
        assert len(crane3.messages) == count + 1
    crane3.run(2, STEP)


@pytest.mark.parametrize("scene", ["gearstick", "hopper"])
def test_values_before_initialisation_are_start_values_or_set_values(build, host, scene):
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


def test_model_exchange_and_events_are_refused(crane3):
    with pytest.raises(Exception, match="nstantiate"):
        crane3.slave.instantiate(eventModeUsed=True, logMessage=lambda *a: crane3.messages.append(a[-1].decode()))
    assert "event mode" in crane3.messages[-1]


def test_terminals_name_variables_that_are_there(build):
    fmu = build("crane", "fmi3")
    with zipfile.ZipFile(fmu) as archive:
        root = ElementTree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    variables = {v.name for v in fmpy.read_model_description(str(fmu)).modelVariables}
    members = [m.attrib["variableName"] for m in root.iter("TerminalMemberVariable")]
    assert members
    assert set(members) <= variables


@pytest.mark.slow
def test_a_dimension_is_the_first_thing_in_its_variable(build):
    """FMI Library passes over one behind annotations; the names of elements stand in a file beside the description."""
    fmu = build("answered", "fmi3")
    with zipfile.ZipFile(fmu) as archive:
        names = element_names(archive.read(ELEMENTS).decode())
        variables = ElementTree.fromstring(archive.read("modelDescription.xml")).find("ModelVariables")
    assert variables is not None
    arrays = {v.attrib["name"]: v for v in variables if v.find("Dimension") is not None}
    assert arrays
    assert all([child.tag for child in v] == ["Dimension"] for v in arrays.values())
    assert {a: len(of) for a, of in names.items()} == {a: int(v[0].attrib["start"]) for a, v in arrays.items()}
    with Fmu(fmu) as one, Fmu(build("answered", "native")) as old:
        assert list(one.variables) == [*old.variables, "time"]


class Asked:
    """An instance of the crane that asks for its torque within steps, each of `length` inner steps."""

    def __init__(self, driven: Any, torque: Callable[[float], float | None], early: bool = False) -> None:
        self.driven, self.torque, self.times = driven, torque, list[float]()
        self.reference = driven.references["torque"]
        self.slave = driven.slave
        self.slave.instantiate(
            earlyReturnAllowed=early, intermediateUpdate=self.update, requiredIntermediateVariables=[self.reference]
        )
        driven.set("step_size", STEP)
        driven.start({"torque": torque(0.0) or 4.0})

    def update(self, environment: object, time: float, requested: bool, readable: bool, *rest: object) -> None:
        assert requested
        assert not readable
        self.times.append(time)
        value = self.torque(time)
        if value is not None:
            self.slave.setFloat64([self.reference], [value])

    def run(self, steps: int, length: int) -> list[float]:
        for k in range(steps):
            self.slave.doStep(k * length * STEP, length * STEP)
        return self.driven.outputs()

    def slope(self) -> list[float]:
        outputs = [self.driven.references[n] for n in ("rod.angle", "rod.x", "rod.ay")]
        return list(self.slave.getDirectionalDerivative(outputs, [self.reference], [1.0], len(outputs)))


def test_inputs_are_asked_for_at_the_end_of_each_inner_step_before_it_is_made(build, host):
    """Nothing given is held, to the bits; a line is that of derivatives in FMI 2.0, to round-off."""
    scalar, two = build("crane", "fmi3_scalar"), build("crane", "native")
    quiet = Asked(host(scalar), lambda time: None)
    assert quiet.driven.description.coSimulation.providesIntermediateUpdate
    silent = host(scalar)
    silent.set("step_size", STEP)
    silent.start({"torque": 4.0})
    for k in range(6):
        assert silent.step(5 * k * STEP, 5 * STEP) == 0
    assert quiet.run(6, 5) == silent.outputs()
    assert quiet.times == pytest.approx([(k + 1) * STEP for k in range(30)])
    assert quiet.driven.saved() == silent.saved()
    line = Asked(host(scalar), lambda time: 4.0 - 30.0 * time)
    led = host(two)
    led.set("step_size", STEP)
    led.start({"torque": 4.0})
    for k in range(6):
        torque = led.references["torque"]
        led.set("torque", 4.0 - 30.0 * 5 * k * STEP)
        led.slave.setRealInputDerivatives([torque], [1], [-30.0])
        assert led.step(5 * k * STEP, 5 * STEP) == 0
    assert line.run(6, 5) == pytest.approx(led.outputs(), rel=1e-9, abs=1e-12)
    assert line.run(0, 5) != pytest.approx(silent.outputs(), rel=1e-3)
    known, unknown = [torque], [led.references[n] for n in ("rod.angle", "rod.x", "rod.ay")]
    assert line.slope() == pytest.approx(led.slave.getDirectionalDerivative(unknown, known, [1.0]), rel=1e-6)


def test_what_was_given_within_a_step_is_kept_in_states(build, host):
    """Behind a state the run and its derivatives go on to the bit, in another instance too, whatever is asked next."""
    scalar = build("crane", "fmi3_scalar")
    curve = lambda time: 4.0 * math.cos(40.0 * time)  # noqa: E731
    one, other = Asked(host(scalar), curve), Asked(host(scalar), curve)
    one.run(3, 5)
    data = one.driven.saved()
    other.slave.setFMUstate(other.slave.deSerializeFMUstate(data))
    slope = one.slope()
    assert other.slope() == slope
    assert one.driven.get("torque") == other.driven.get("torque") == pytest.approx(curve(15 * STEP))
    for requested in (one, other):
        requested.slave.doStep(15 * STEP, 5 * STEP)
    assert one.driven.outputs() == other.driven.outputs()
    assert one.slope() == other.slope() != slope
    with pytest.raises(FMICallException):
        other.slave.deSerializeFMUstate(data[:-8])


def test_a_derivative_is_over_all_that_was_given_within_the_step(build, host):
    """Against differences: the same torque, a little higher all along."""
    scalar, part, ends = build("crane", "fmi3_scalar"), 1e-3, []
    for extra in (part, -part):
        curve = lambda time, extra=extra: 4.0 * math.cos(40.0 * time) + (extra if time > 5 * STEP else 0.0)  # noqa: E731
        requested = Asked(host(scalar), curve)
        requested.slave.doStep(0.0, 5 * STEP)
        requested.driven.set("torque", 4.0 * math.cos(200.0 * STEP) + extra)
        requested.slave.doStep(5 * STEP, 5 * STEP)
        ends.append([requested.driven.get(n) for n in ("rod.angle", "rod.x", "rod.ay")])
    exact = Asked(host(scalar), lambda time: 4.0 * math.cos(40.0 * time))
    exact.run(2, 5)
    differences = (np.array(ends[0]) - np.array(ends[1])) / (2.0 * part)
    assert exact.slope() == pytest.approx(differences, rel=1e-5)


def test_in_an_intermediate_update_only_real_inputs_can_be_set(build, host):
    requested = Asked(host(build("crane", "fmi3_scalar")), lambda time: None)
    tried: list[str] = []

    def wrong(time: float) -> None:
        calls = {
            "get": lambda: requested.slave.getFloat64([requested.reference]),
            "step": lambda: requested.slave.doStep(0.0, STEP),
            "parameter": lambda: requested.slave.setFloat64([requested.driven.references["spring.stiffness"]], [1.0]),
        }
        for what, call in calls.items():
            with pytest.raises((FMICallException, AssertionError)):
                call()
            tried.append(what)

    requested.torque = wrong
    requested.slave.doStep(0.0, STEP)
    assert tried == ["get", "step", "parameter"]
    assert requested.driven.get("torque") == 4.0
