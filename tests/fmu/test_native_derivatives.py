"""Derivatives: inputs followed inside a step, rates of outputs, outputs by inputs against differences of steps."""

from collections.abc import Callable
from ctypes import c_double
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest

from tests.fmu.calls import ERROR, OK

STEP = 0.1  # s
INNER = 0.01  # s, of the steps within

# Differences of steps that end at a tolerance of 1e-10 m, over a part of the input's range.
PART = 1e-3
DERIVATIVE_ERROR = 2e-5
RATE_STEP = 1e-4
RATE_ERROR = 1e-3
SEEN = {
    "torque": ("rod.x", "rod.angle", "rod.ay"),
    "pull": ("bob.x", "bob.vx", "pulled"),
    "thrust": ("chassis.x", "speed"),
}


@pytest.fixture(params=["crane", "reach", "sled"])
def scene(request: pytest.FixtureRequest, build: Callable[..., Path]) -> tuple[Path, str, float, float]:
    """FMU, input, its value, its range."""
    values = {"crane": ("torque", 3.0, 60.0), "reach": ("pull", 0.05, 1.0), "sled": ("thrust", 2.0, 10.0)}
    return (build(request.param, "native"), *values[request.param])


def slope(driven: Any, name: str, order: int, value: float) -> int:
    return int(driven.call("setRealInputDerivatives", [driven.references[name]], [order], [value]))


def derivative(driven: Any, unknown: list[int], known: list[int], seed: list[float]) -> list[float]:
    return list(driven.slave.getDirectionalDerivative(unknown, known, seed))


def outputs(driven: Any) -> list[int]:
    return [v.valueReference for v in driven.description.modelVariables if v.causality == "output"]


def test_a_ramp_is_followed_inside_the_step(build, host):
    fine, ramp, held = (host(build("crane", "native")).start({"torque": 1.0}) for _ in range(3))
    torque = [1.0 + 40.0 * (k * INNER) - 100.0 * (k * INNER) ** 2 for k in range(11)]
    for k in range(10):
        fine.set("torque", torque[k])
        slope(fine, "torque", 1, (torque[k + 1] - torque[k]) / INNER)
        assert fine.step(k * INNER, INNER) == OK
    assert slope(ramp, "torque", 1, 40.0) == slope(ramp, "torque", 2, -200.0) == OK
    assert ramp.step(0.0, STEP) == held.step(0.0, STEP) == OK
    assert np.allclose(ramp.outputs(), fine.outputs(), rtol=1e-12, atol=1e-12)
    assert abs(ramp.get("rod.x") - held.get("rod.x")) > 1e-4
    # What the host set stays set, and the derivatives are spent.
    assert ramp.get("torque") == 1.0
    state = ramp.slave.getFMUstate()
    assert ramp.step(STEP, STEP) == OK
    spent = ramp.outputs()
    ramp.slave.setFMUstate(state)
    assert slope(ramp, "torque", 1, 0.0) == OK
    assert ramp.step(STEP, STEP) == OK
    assert ramp.outputs() == spent


def test_derivatives_set_are_part_of_the_state(build, host):
    driven = host(build("crane", "native")).start()
    assert slope(driven, "torque", 1, 50.0) == OK
    data = driven.saved()
    assert driven.step(0.0, STEP) == OK
    expected = driven.outputs()
    other = host(build("crane", "native"))
    assert other.restore(data) == OK
    assert other.step(0.0, STEP) == OK
    assert other.outputs() == expected


def test_rates_of_positions_angles_and_velocities(build, host):
    for name, known in (
        ("crane", {"rod.x", "rod.angle"}),
        ("sled", {"chassis.x", "chassis.y", "chassis.yaw", "speed"}),
        ("reach", {"bob.x", "bob.vx", "pulled"}),
    ):
        driven = host(build(name, "native")).start()
        driven.slave.setReal([0], [1.0 if name != "reach" else 0.02])
        driven.run(20, INNER)
        rates = {}
        for output in outputs(driven):
            try:
                rates[output] = driven.slave.getRealOutputDerivatives([output], [1])[0]
            except fmpy.fmi1.FMICallException:
                assert "rate" in driven.messages[-1]
        names = {v.valueReference: v.name for v in driven.description.modelVariables}
        assert {names[r] for r in rates} == known
        before = driven.slave.getReal(list(rates))
        driven.slave.doStep(20 * INNER, RATE_STEP)
        after = driven.slave.getReal(list(rates))
        slopes = (np.array(after) - np.array(before)) / RATE_STEP
        assert np.allclose(list(rates.values()), slopes, rtol=RATE_ERROR, atol=2e-2)
        assert np.max(np.abs(slopes)) > 0.01


def test_rates_of_higher_order_are_refused(build, host):
    driven = host(build("crane", "native")).start()
    assert driven.call("getRealOutputDerivatives", [driven.references["rod.x"]], [2]) == ERROR
    assert driven.call("getRealOutputDerivatives", [driven.references["torque"]], [1]) == ERROR


@pytest.mark.parametrize(("inner_steps", "ramp"), [(2, 0.0), (5, 3.0)])
def test_outputs_by_inputs_of_a_communication_step(scene, host, inner_steps, ramp):
    """All of it, held inputs or such that follow derivatives; also after the state went to another instance."""
    fmu, name, value, size = scene
    driven, other = host(fmu).start(), host(fmu)
    known, step = [driven.references[name]], inner_steps * INNER
    driven.slave.setReal(known, [value])
    driven.run(20, INNER)
    state, ends = driven.slave.getFMUstate(), []
    unknown = [v.valueReference for v in driven.description.modelVariables if v.name in SEEN[name]]
    for sign in (1.0, -1.0, 0.0):
        driven.slave.setFMUstate(state)
        driven.slave.setReal(known, [0.9 * value + sign * PART * size])
        assert slope(driven, name, 1, ramp * size) == OK
        assert driven.step(20 * INNER, step) == OK
        ends.append(np.array(driven.slave.getReal(unknown)))
    expected = (ends[0] - ends[1]) / (2.0 * PART * size)
    driven.slave.setReal(known, [value])  # of the next step
    actual = derivative(driven, unknown, known, [1.0])
    scale = np.abs(expected) + np.max(np.abs(expected)) * 1e-2
    assert np.all(np.abs(actual - expected) < DERIVATIVE_ERROR * scale)
    assert np.min(np.abs(expected)) > 0.0
    assert derivative(driven, unknown, known, [-3.0]) == pytest.approx([-3.0 * x for x in actual], rel=1e-6)
    assert other.restore(driven.saved()) == OK
    assert derivative(other, unknown, known, [1.0]) == actual
    assert other.step(20 * INNER + step, step) == driven.step(20 * INNER + step, step) == OK
    assert other.outputs() == driven.outputs()


def test_a_step_that_was_halved_has_no_derivative(build, host):
    driven = host(build("crank_slider", "native")).start({"torque": 4.0, "step_size": 1e-3})
    unknown, known = [driven.references["crank.angle"]], [driven.references["torque"]]
    refused, whole, halvings = 0, 0, 0.0
    for k in range(1500):
        driven.step(k * 1e-3, 1e-3)
        before, halvings = halvings, driven.get("solver.halvings")
        if halvings == before:
            whole += derivative(driven, unknown, known, [1.0])[0] != 0.0
            continue
        end = driven.outputs()
        assert driven.call("getDirectionalDerivative", unknown, known, [1.0]) == ERROR
        assert "an inner step of it was halved" in driven.messages[-1]
        assert driven.outputs() == end
        refused += 1
    assert refused > 10
    assert whole > 10


def test_a_contact_that_is_made_has_no_derivative(prototype_fmu, host):
    """A dropped car: derivatives in the air and on the ground, none where a wheel meets the road or leaves it, or where
    its load changes so abruptly that the step is divided."""
    driven = host(prototype_fmu).start({"initial.z": 0.05, "initial.speed": 10.0})
    unknown = [driven.references[n] for n in ("wheel_FL.Fz", "chassis.ay")]
    known, touched, seen = [driven.references["steering"]], False, []
    for k in range(40):
        driven.step(k * 0.01, 0.01)
        before, touched = touched, driven.get("wheel_FL.Fz") > 0.0
        status = driven.call("getDirectionalDerivative", unknown, known, [1.0])
        seen.append((before != touched, status))
        if status == ERROR:
            messages = driven.messages[-1]
            result = (
                "a contact with the road was made or lost" in messages or "an inner step of it was halved" in messages
            )
            assert result or "'tyre" in driven.messages[-1]  # not yet deep enough for all of its damping
    assert (True, OK) not in seen
    assert (True, ERROR) in seen
    assert seen.count((False, OK)) > 20


def test_derivatives_of_outputs_by_variables_set_in_initialisation(build, host):
    ends = []
    for torque in (2.0 + 1e-3, 2.0 - 1e-3):
        driven = host(build("crane", "native")).start({"torque": torque})
        ends.append(driven.get("rod.ay"))
    driven = host(build("crane", "native"))
    driven.slave.setupExperiment()
    driven.set("torque", 2.0)
    driven.slave.enterInitializationMode()
    unknown, known = driven.references["rod.ay"], driven.references["torque"]
    before = driven.outputs()
    (actual,) = derivative(driven, [unknown], [known], [1.0])
    assert actual == pytest.approx((ends[0] - ends[1]) / 2e-3, rel=1e-6)
    assert abs(actual) > 0.1
    assert driven.outputs() == before
    assert driven.call("getDirectionalDerivative", [known], [unknown], [1.0]) == ERROR


def test_a_derivative_before_the_first_step_is_refused_with_the_reason(build, host):
    driven = host(build("crane", "native")).start()
    output = driven.references["rod.x"]
    assert driven.call("getDirectionalDerivative", [output], [0], [1.0]) == ERROR
    assert "one step" in driven.messages[-1]
    assert driven.run(1, INNER)
    assert driven.call("getDirectionalDerivative", [output], [1], [1.0]) == ERROR
    assert "not an input" in driven.messages[-1]


def test_null_pointers_are_errors(build, host):
    driven = host(build("crane", "native")).start()
    raw, c = driven.slave.dll, driven.slave.component
    for call in (
        lambda: raw.fmi2GetReal(c, None, 1, None),
        lambda: raw.fmi2SetReal(c, None, 1, None),
        lambda: raw.fmi2GetFMUstate(c, None),
        lambda: raw.fmi2SetFMUstate(c, None),
        lambda: raw.fmi2SerializedFMUstateSize(c, None, None),
        lambda: raw.fmi2GetDirectionalDerivative(c, None, 1, None, 1, None, (c_double * 1)()),
        lambda: raw.fmi2GetRealStatus(c, 2, None),
    ):
        assert call() == ERROR
    assert raw.fmi2GetReal(c, None, 0, None) == OK
    assert raw.fmi2GetReal(None, None, 0, None) == ERROR
    assert all("null pointer" in m for m in driven.messages)
