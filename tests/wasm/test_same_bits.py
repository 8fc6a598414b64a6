"""Whole drives as WebAssembly: every output after every step and the states have the bits of the native library."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wasm_hosts import Chromium, Fmu, HostResult, Plan, assert_same, native, node, wasmtime

from hosts.common.options import FmuOptions
from hosts.fmu.fmu import described
from hosts.fmu.settings import settings_of
from hosts.fmu.variables import Variables

H = 0.002


pytestmark = pytest.mark.slow  # as in test_instance.py


def drive(steps: int, start: dict[str, Any], every: int = 250, h: float = H) -> Plan:
    """A start from rest, a slalom on the throttle, then the brakes."""
    inputs = []
    for k in range(steps):
        t, part = k * h, k / steps
        steering = 0.4 * np.sin(3.0 * t) if part > 0.2 else 0.0
        throttle, brake = (0.7, 0.0) if part < 0.7 else (0.0, 0.8)
        inputs.append([float(steering), throttle, brake])
    plan_steps = [{"h": h, "inputs": values, "save": (k + 1) % every == 0} for k, values in enumerate(inputs)]
    return Plan(start, ["steering", "throttle", "brake"], plan_steps)


def moved(driven: HostResult) -> int:
    """Outputs that changed: a drive that stands still compares nothing."""
    return int((np.ptp(driven.rows, axis=0) > 1e-6).sum())


@pytest.fixture(scope="module")
def expected() -> Callable[[Fmu, str, Plan], HostResult]:
    """What the native library gives, driven once a plan."""
    results: dict[str, HostResult] = {}

    def get(fmu: Fmu, name: str, plan: Plan) -> HostResult:
        if name not in results:
            results[name] = native(fmu, plan)
        return results[name]

    return get


PLANS = {
    "rigid": (500, {"initial.speed": 5.0}),
    "road file": (500, {"initial.speed": 12.0, "road.file": "own.road"}),
    "load paths": (250, {"initial.speed": 10.0, "fidelity": 2}),
}


@pytest.mark.parametrize(("host", "name"), [(wasmtime, "rigid"), (node, "road file"), (node, "load paths")])
def test_the_prototype(prototype: Fmu, expected: Any, name: str, host: Callable[[Fmu, Plan], HostResult]) -> None:
    steps, start = PLANS[name]
    plan = drive(steps, dict(start))
    compared = expected(prototype, name, plan)
    assert len(compared.states) == steps // 250
    assert moved(compared) > 70
    assert_same(host(prototype, plan), compared, prototype, plan)


def test_a_parameter_set(prototype: Fmu, tmp_path: Path) -> None:
    file = tmp_path / "softer.ssv"
    file.write_text(SSV)
    settings = settings_of(Variables(described(prototype.path)), FmuOptions([file], []))
    assert settings.start == {"front.spring.stiffness": 18500.0, "road.friction": 0.7, "payload.passenger.mass": 80.0}
    plan = drive(200, {"initial.speed": 15.0, **settings.start}, every=100)
    compared = native(prototype, plan)
    usual = native(prototype, drive(200, {"initial.speed": 15.0}, every=100))
    assert np.abs(compared.rows - usual.rows).max() > 1.0
    assert_same(wasmtime(prototype, plan), compared, prototype, plan)


def refused_steps() -> Plan:
    steps = [{"h": 0.01, "inputs": [0.1], "save": True}] * 3
    steps += [{"h": 2.0, "inputs": [10.0], "save": True}] * 3  # beyond its reach: discard twice, then an error
    steps += [{"h": 0.01, "inputs": [0.05], "save": True}] * 20
    return Plan({}, ["pull"], steps)


def test_steps_that_are_refused(small: Callable[[str], Fmu]) -> None:
    fmu, plan = small("reach"), refused_steps()
    compared = native(fmu, plan)
    assert compared.refusals == [(3, "discard"), (4, "discard"), (5, "error")]
    assert np.array_equal(compared.rows[3], compared.rows[6])
    assert moved(compared) > 0
    assert_same(wasmtime(fmu, plan), compared, fmu, plan)


def test_in_chromium(prototype: Fmu, small: Callable[[str], Fmu], expected: Any) -> None:
    """One start of the browser for all drives."""
    with Chromium() as chromium:
        for name, (steps, start) in PLANS.items():
            plan = drive(steps, dict(start))
            assert_same(chromium(prototype, plan), expected(prototype, name, plan), prototype, plan)
        plan = refused_steps()
        assert_same(chromium(small("reach"), plan), native(small("reach"), plan), small("reach"), plan)
        chromium.run("(xml) => (window.xml = xml)", described_text(prototype))
        description = chromium.run("async () => (await import('/description.js')).describe(window.xml)")
    written = prototype.job(plan)["description"]
    assert (description["guid"], description["modelName"]) == (written["guid"], written["modelName"])
    assert [
        {key: v[key] for key in w} for v, w in zip(description["variables"], written["variables"], strict=True)
    ] == (written["variables"])
    assert (description["stepSize"], description["stopTime"]) == (H, 10.0)
    variables = {v["name"]: v for v in description["variables"]}
    assert variables["fidelity"] | {"type": "Integer", "min": 0, "max": 2, "start": 0} == variables["fidelity"]
    assert variables["front.spring.stiffness"]["unit"] == "N/m"
    assert variables["road.file"]["start"] == ""


def described_text(fmu: Fmu) -> str:
    return (fmu.folder / "modelDescription.xml").read_text(encoding="utf-8")


SSV = """<?xml version="1.0" encoding="UTF-8"?>
<ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
  xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon" version="1.0" name="softer">
  <ssv:Parameters>
    <ssv:Parameter name="front.spring.stiffness"><ssv:Real value="18.5" unit="kN/m"/></ssv:Parameter>
    <ssv:Parameter name="road.friction"><ssv:Real value="0.7" unit="1"/></ssv:Parameter>
    <ssv:Parameter name="payload.passenger.mass"><ssv:Real value="80" unit="kg"/></ssv:Parameter>
  </ssv:Parameters>
  <ssv:Units>
    <ssc:Unit name="kN/m"><ssc:BaseUnit kg="1" s="-2" factor="1000"/></ssc:Unit>
    <ssc:Unit name="1"><ssc:BaseUnit/></ssc:Unit>
    <ssc:Unit name="kg"><ssc:BaseUnit kg="1"/></ssc:Unit>
  </ssv:Units>
</ssv:ParameterSet>
"""
