"""Constants of a model: given by every FMU, settable by none, no outputs, and no change of other value references."""

import tomllib
import zipfile
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from lxml import etree

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.description.terminals import LS_STRUCT
from mbs.vehicle import load
from mbs.vehicle.read_car import CARS
from tests import kinds
from tests.fmu import scenes
from tests.fmu.calls import ERROR, OK
from tests.fmu.test_native_file import schema

H = 0.01
CONSTANTS = {"crane.reach": (1.25, "m"), "crane.ratio": (17.1, "1")}
TABLE = {"speed": ("m/s", (-1.0, 0.0, 0.5)), "force": ("N", (-400.0, 0.0, 250.0))}
SCHEMA = Path(__file__).parents[1] / "data" / "fmi_ls_ref" / "fmi3LayeredStandardStructManifest.xsd"


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    m = scenes.crane(name="told")
    for name, (value, unit) in CONSTANTS.items():
        m.constant(name, value, unit, f"{name} as built")
    folder, system = tmp_path_factory.mktemp("told"), mbs.compile(m)
    return {k: build_fmu(system, "told", folder, [fmpy.platform], kind=k) for k in kinds.VERSIONS}


@pytest.mark.parametrize("kind", kinds.VERSIONS)
def test_the_description_declares_constants_and_keeps_other_references(files, build, kind):
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


def test_they_can_be_read_and_not_set(files, host):
    driven = host(files["native"]).start()
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
    assert driven.call("getRealOutputDerivatives", [reach], [1]) == ERROR


def test_fmi_3_reads_them_beside_time_and_outputs(files, host):
    driven = host(files["fmi3"]).start()
    slave, references = driven.slave, driven.references
    slave.doStep(0.0, H)
    requested = [references[n] for n in ("crane.ratio", "time", "rod.x", "crane.reach", "time")]
    ratio, time, x, reach, again = slave.getFloat64(requested)
    assert (ratio, reach) == (17.1, 1.25)
    assert time == again == H
    assert x == slave.getFloat64([references["rod.x"]])[0]
    for name in ("crane.reach", "time"):
        with pytest.raises(FMICallException):
            slave.setFloat64([references[name]], [1.0])


@pytest.fixture(scope="module")
def tabled(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """An FMU with the constants of a table, of a kind."""
    m = scenes.crane(name="tabled")
    for column, (unit, values) in TABLE.items():
        for k, value in enumerate(values, 1):
            m.constant(f"crane.damper.{column}_{k}", value, unit, f"{column} in row {k}")
    m.constant("crane.alone_1", 1.0)  # no table
    m.constant("crane.alone_2", 2.0)
    folder, system = tmp_path_factory.mktemp("tabled"), mbs.compile(m)
    return lambda kind: build_fmu(system, "tabled", folder, [fmpy.platform], kind=kind)


@pytest.mark.slow
def test_a_table_of_constants_is_a_map_of_fmi_ls_struct(tabled, host):
    """Its terminal and manifest as the layered standard has them (modelica/fmi-ls-struct, 1.0.0-rc.1)."""
    fmu = tabled("fmi3")
    assert validate_fmu(str(fmu)) == []
    with zipfile.ZipFile(fmu) as archive:
        manifest = etree.fromstring(archive.read(f"extra/{LS_STRUCT}/fmi-ls-manifest.xml"))
        icons = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    checker = schema(SCHEMA)
    assert checker.validate(manifest), checker.error_log
    (actual,) = [t for t in icons.iter("Terminal") if t.get("matchingRule") == f"{LS_STRUCT}.map"]
    assert (actual.get("name"), actual.get("terminalKind")) == ("crane.damper", f"{LS_STRUCT}.map.rectilinearGrid")
    members = [(m.get("variableName"), m.get("memberName"), m.get("variableKind")) for m in actual]
    assert members == [
        ("crane.damper.speed", "speed", f"{LS_STRUCT}.map.domain"),
        ("crane.damper.force", "force", f"{LS_STRUCT}.map.codomain"),
    ]
    driven = host(fmu).start()
    variables = {v.name: v for v in driven.description.modelVariables}
    for column, (unit, values) in TABLE.items():
        v = variables[f"crane.damper.{column}"]
        assert (v.causality, v.variability, v.unit, v.shape) == ("local", "constant", unit, (len(values),))
        assert tuple(driven.slave.getFloat64([v.valueReference], len(values))) == values
        assert tuple(map(float, v.start.split())) == values
        with pytest.raises(FMICallException):
            driven.slave.setFloat64([v.valueReference], values)


def test_without_arrays_there_are_the_numbers_and_no_map(tabled, host):
    fmu = tabled("fmi3_scalar")
    with zipfile.ZipFile(fmu) as archive:
        assert not [name for name in archive.namelist() if LS_STRUCT in name]
    driven = host(fmu).start()
    for column, (_, values) in TABLE.items():
        assert tuple(driven.get(f"crane.damper.{column}_{k}") for k in range(1, 4)) == values


def test_the_tables_of_a_car_are_constants():
    stated = {entry["name"]: entry["value"] for entry in mbs.compile(load("hatchback").model()).meta["constants"]}
    content = tomllib.loads((CARS / "hatchback" / "car.toml").read_text(encoding="utf-8"))
    for axle in ("front", "rear"):
        for column, values in zip(("speed", "force"), zip(*content[axle]["damper"]["table"], strict=True), strict=True):
            names = [f"{axle}.damper.table.{column}_{k}" for k in range(1, len(values) + 1)]
            assert [stated[name] for name in names] == list(values)
