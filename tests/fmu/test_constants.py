"""Constants of a model: given by every FMU, settable by none, no outputs, and no change of other value references."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

import mbs
from fmu_src.build.build import build_fmu
from tests import kinds
from tests.fmu import scenes
from tests.fmu.calls import ERROR, FMI_2, OK, HostMaker

H = 0.01
CONSTANTS = {"crane.reach": (1.25, "m"), "crane.ratio": (17.1, "1")}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory, need: Callable[[str], None]) -> dict[str, Path]:
    need("python")
    m = scenes.crane(name="told")
    for name, (value, unit) in CONSTANTS.items():
        m.constant(name, value, unit, f"{name} as built")
    folder, system = tmp_path_factory.mktemp("told"), mbs.compile(m)
    return {k: build_fmu(system, "told", folder, [fmpy.platform], kind=k) for k in kinds.ALL}


def test_the_description_tells_them_and_leaves_the_rest(
    files: dict[str, Path], build: Callable[..., Path], kind: str
) -> None:
    assert validate_fmu(str(files[kind])) == []
    with_them, without = (
        {v.name: v for v in fmpy.read_model_description(str(f)).modelVariables}
        for f in (files[kind], build("crane", kind))
    )
    for name, (value, unit) in CONSTANTS.items():
        v = with_them.pop(name)
        assert (v.causality, v.variability, float(v.start), v.unit) == ("local", "constant", value, unit)
        assert v.description == f"{name} as built"
    assert {n: v.valueReference for n, v in with_them.items()} == {n: v.valueReference for n, v in without.items()}


@FMI_2
def test_they_can_be_read_and_not_set(files: dict[str, Path], host: HostMaker, kind: str) -> None:
    driven = host(files[kind]).start()
    before = driven.outputs()
    for name, (value, _) in CONSTANTS.items():
        assert driven.get(name) == value
        assert driven.set(name, 3.0) == ERROR
        assert f"'{name}' is a constant and cannot be set" in driven.messages[-1]
    driven.run(3, H)
    assert [driven.get(name) for name in CONSTANTS] == [value for value, _ in CONSTANTS.values()]
    assert driven.outputs() != before
    torque, reach, x = (driven.references[n] for n in ("torque", "crane.reach", "rod.x"))
    assert driven.call("getDirectionalDerivative", [x], [torque], [1.0]) == OK
    assert driven.call("getDirectionalDerivative", [reach], [torque], [1.0]) == ERROR
    assert driven.three or driven.call("getRealOutputDerivatives", [reach], [1]) == ERROR


def test_fmi_3_reads_them_beside_time_and_outputs(files: dict[str, Path], host: HostMaker) -> None:
    driven = host(files["fmi3"]).start()
    slave, references = driven.slave, driven.references
    slave.doStep(0.0, H)
    asked = [references[n] for n in ("crane.ratio", "time", "rod.x", "crane.reach", "time")]
    ratio, time, x, reach, again = slave.getFloat64(asked)
    assert (ratio, reach) == (17.1, 1.25)
    assert time == again == H
    assert x == slave.getFloat64([references["rod.x"]])[0]
    for name in ("crane.reach", "time"):
        with pytest.raises(FMICallException):
            slave.setFloat64([references[name]], [1.0])
