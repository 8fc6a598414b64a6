"""Whole numbers are integers of FMI; for a release they can be read and set as real ones too."""

from pathlib import Path

import fmpy
import pytest

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.variables.variables import variable_table
from tests import kinds
from tests.fmu import scenes
from tests.fmu.calls import ERROR, OK, HostMaker


def test_types_and_values(crane: Path, host: HostMaker) -> None:
    driven = host(crane).start({"torque": 5.0})
    driven.run(5, 0.01)
    types = {v.name: v.type for v in driven.description.modelVariables}
    assert (
        types["solver.iterations"]
        == types["solver.status"]
        == types["solver.halvings"]
        == ("Int32" if driven.three else "Integer")
    )
    assert types["solver.energy_error"] == types["rod.x"] == ("Float64" if driven.three else "Real")
    reference = [driven.references["solver.iterations"]]
    (iterations,) = driven.slave.getInteger(reference)
    assert iterations >= 1
    assert driven.slave.getReal(reference) == [float(iterations)]


@pytest.mark.parametrize("kind", kinds.VERSIONS)
def test_the_fidelity_is_an_integer_with_a_range(tmp_path: Path, kind: str, host: HostMaker) -> None:
    systems = [mbs.compile(scenes.crane(2.0 + fidelity)) for fidelity in (0, 1)]
    fmu = build_fmu(systems, "two", tmp_path, [fmpy.platform], kind=kind, fidelity=1)
    (v,) = (v for v in fmpy.read_model_description(str(fmu)).modelVariables if v.name == "fidelity")
    assert v.type == ("Int32" if kind == "fmi3" else "Integer")
    assert (v.min, v.max, v.start) == ("0", "1", "1")
    end = [
        fmpy.simulate_fmu(str(fmu), stop_time=0.5, start_values={"fidelity": k, "torque": 5.0})["rod.x"][-1]
        for k in (0, 1)
    ]
    assert end[0] != end[1]
    if kind == "fmi3":
        return
    driven = host(fmu)
    driven.slave.setupExperiment()
    reference = [driven.references["fidelity"]]
    assert driven.call("setInteger", reference, [2]) == ERROR
    assert driven.call("setInteger", reference, [0]) == OK
    assert driven.call("setReal", reference, [0.5]) == ERROR
    driven.slave.enterInitializationMode()
    assert driven.slave.getInteger(reference) == [0]


def test_one_unit_has_one_name() -> None:
    meta = {
        "inputs": [{"name": "a", "unit": "N m", "description": "", "start": 0.0, "min": None, "max": None}],
        "parameters": [],
        "sensors": [{"name": "b", "unit": "N.m", "description": ""}, {"name": "c", "unit": "N*m", "description": ""}],
    }
    table = variable_table(meta, pose=False, step_size=0.01)
    assert {v.unit for v in table if v.name in "abc"} == {"N.m"}
    assert table[0].min is table[0].max is None


def test_descriptions_are_distinct() -> None:
    sensors = [{"name": name, "unit": "N", "description": "force"} for name in ("a.Fx", "b.Fx", "b.Fy", "c.Fx")]
    table = variable_table({"inputs": [], "parameters": [], "sensors": sensors}, pose=False, step_size=0.01)
    texts = [v.description for v in table if v.source == "sensor"]
    assert len(set(texts)) == len(texts)
    assert texts[0] == "a: force"
