"""The files of a native FMU: valid documents, repeatable reference results, documentation."""

import io
import struct
import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from lxml import etree

import mbs
from ali3.scene.scene_columns import all_columns
from fmu_src.description.description import declared_types
from fmu_src.description.probe import Dependencies
from fmu_src.geometry.geometry import geometry
from fmu_src.native.package import NativeContents
from fmu_src.native.reference_runs import reference_runs, with_other_names
from fmu_src.variables.variables import Variable, by_name_in_system, variable_table
from mbs.compiler.ports import map_followers
from mbs.scenes import cart_pole, prototype_car
from tests import kinds
from tests.fmu.scenes import spaced

SCHEMAS = Path(fmpy.__file__).parent / "schema"
LS_REF_SCHEMAS = Path(__file__).parents[1] / "data" / "fmi_ls_ref"
LS_REF = "extra/org.fmi-standard.fmi-ls-ref"


def read(fmu: Path, name: str) -> bytes:
    with zipfile.ZipFile(fmu) as archive:
        return archive.read(name)


def names(fmu: Path) -> set[str]:
    with zipfile.ZipFile(fmu) as archive:
        return set(archive.namelist())


@pytest.mark.parametrize("document", ["sources/buildDescription", "terminalsAndIcons/terminalsAndIcons"])
def test_documents_of_fmi_3_obey_the_schemas(build: Callable[..., Path], document: str) -> None:
    """FMPy holds modelDescription.xml against its schema (`test_descriptor.py`)."""
    name = document.partition("/")[2]
    checker = etree.XMLSchema(etree.parse(str(SCHEMAS / f"fmi3/fmi3{name[0].upper()}{name[1:]}.xsd")))
    text = read(build("crane", "fmi3"), f"{document}.xml")
    assert checker.validate(etree.parse(io.BytesIO(text))), checker.error_log


@pytest.mark.parametrize(
    ("kind", "document", "element"),
    [("native", "modelDescription.xml", "File"), ("fmi3", "sources/buildDescription.xml", "SourceFile")],
)
def test_documents_name_each_source(build: Callable[..., Path], kind: str, document: str, element: str) -> None:
    """A host compiles those that are named."""
    fmu = build("crane", kind)
    named = [file.get("name") for file in ElementTree.fromstring(read(fmu, document)).iter(element)]
    packed = [n.removeprefix("sources/") for n in names(fmu) if n.startswith("sources/") and n.endswith(".c")]
    assert sorted(named) == sorted(packed)
    assert "table.c" in named
    assert kind == "fmi3" or not any("fmi3" in name for name in named)


def test_columns_of_names_with_blanks_are_variables() -> None:
    system = mbs.compile(spaced())
    table = variable_table(system.meta, pose=False, step_size=0.01)
    known = {v.name for v in table}
    assert known > {"long_rod.angle_1", "motor_torque", "spring_stiffness"}
    named = by_name_in_system(table, system.meta)
    default, in_turn = (with_other_names(run, named) for run in reference_runs(system))
    assert "long_rod.angle_1" in default.columns
    assert known > set(default.columns)
    assert list(in_turn.inputs) == ["motor_torque"]
    scene = geometry(system, table, "TwoWords", "")
    assert scene is not None
    assert {"long_rod.x", "long_rod.qw"} <= set(all_columns(scene)) <= known


class _Shipped(etree.Resolver):
    """Schemas of the standard that others import, as FMPy ships them."""

    def resolve(self, url: str, public: str, context: Any) -> Any:
        shipped = SCHEMAS / "fmi3" / url.rpartition("/")[2]
        return self.resolve_filename(str(shipped), context) if url.startswith("https:") else None


def schema(file: Path) -> etree.XMLSchema:
    parser = etree.XMLParser()
    parser.resolvers.add(_Shipped())
    return etree.XMLSchema(etree.parse(str(file), parser))


@pytest.mark.parametrize(("scene", "kind"), [("sled", "native"), ("crane", "fmi3")])
def test_the_references_obey_their_schemas(build: Callable[..., Path], scene: str, kind: str) -> None:
    """Those of the repositories in `tests/data/fmi_ls_ref/README.md`, and that of SSP which FMPy ships."""
    fmu = build(scene, kind)
    manifest = ElementTree.fromstring(read(fmu, f"{LS_REF}/fmi-ls-manifest.xml"))
    related = {item.attrib["type"]: f"{LS_REF}/{item.attrib['source']}" for item in manifest}
    ssv = Path(fmpy.__file__).parent / "ssp" / "schema" / "SystemStructureParameterValues.xsd"
    for file, document in (
        (LS_REF_SCHEMAS / "fmi3LayeredStandardReferenceManifest.xsd", f"{LS_REF}/fmi-ls-manifest.xml"),
        (LS_REF_SCHEMAS / "maHarmonizedSpecificationExperiments.xsd", related["application/x-ma-hs-experiments"]),
        (ssv, related["application/x-ssp-parameter-set"]),
    ):
        checker = schema(file)
        assert checker.validate(etree.parse(io.BytesIO(read(fmu, document)))), checker.error_log
    settable = {
        v.name: v.start for v in fmpy.read_model_description(str(fmu)).modelVariables if v.causality == "parameter"
    }
    values = ElementTree.fromstring(read(fmu, related["application/x-ssp-parameter-set"]))
    parameters = {
        item.attrib["name"]: item[0].attrib["value"] for item in values.iter() if item.tag.endswith("}Parameter")
    }
    assert {name: float(value) for name, value in parameters.items()} == {n: float(s) for n, s in settable.items()}


def columns_of(fmu: Path, file: str) -> Any:
    content = io.BytesIO(read(fmu, f"{LS_REF}/{file}"))
    return np.genfromtxt(content, delimiter=",", names=True, deletechars="", dtype=float)


@pytest.mark.parametrize("kind", kinds.VERSIONS)
def test_the_reference_results_repeat(build: Callable[..., Path], kind: str) -> None:
    """To the bit, without inputs and with those of the FMU, which FMPy holds over a step."""
    fmu = build("crane", kind)
    manifest = ElementTree.fromstring(read(fmu, f"{LS_REF}/fmi-ls-manifest.xml"))
    listed = {item.attrib["source"] for item in manifest}
    assert {f"{LS_REF}/{source}" for source in listed} <= names(fmu)
    experiments = list(ElementTree.fromstring(read(fmu, f"{LS_REF}/experiments.exp")))
    assert [e.attrib["name"] for e in experiments] == ["default", "in_turn"]
    swings = []
    for experiment in experiments:
        settings = experiment[0].attrib
        files = {item.tag: item.attrib["source"] for item in experiment[1:]}
        assert set(files.values()) <= listed
        table, interval = columns_of(fmu, files["References"]), float(settings["stepSize"])
        stimuli = columns_of(fmu, files["Stimuli"]) if "Stimuli" in files else None
        run = fmpy.simulate_fmu(
            str(fmu),
            stop_time=float(settings["stopTime"]),
            output_interval=interval,
            output=["rod.ay"],
            input=stimuli,
            set_input_derivatives=False,
        )
        every = round((table["time"][1] - table["time"][0]) / interval)
        assert len(table) > 50
        assert np.allclose(table["rod.ay"], run["rod.ay"][::every], rtol=1e-9, atol=1e-9 * np.ptp(table["rod.ay"]))
        assert stimuli is not None or np.array_equal(table["rod.ay"], run["rod.ay"][::every])
        swings.append(np.ptp(table["rod.ay"]))
    assert swings[0] > 1.0
    assert swings[1] != swings[0]


@pytest.mark.slow
def test_the_reference_results_of_a_car_have_stresses() -> None:
    cars = [mbs.compile(prototype_car.build(fidelity=fidelity)) for fidelity in (0, 1)]
    systems, (follower, _) = map_followers(cars)
    default, in_turn = reference_runs(systems[0], systems[follower])
    for run in (default, in_turn):
        assert np.abs(run.columns["stress.SG1"]).min() > 1e3
        assert np.all(run.columns["stress.computed"] == 1.0)
    assert set(in_turn.inputs) == {"steering", "throttle", "brake", "hand_brake", "steering_wheel_angle_demand"}
    assert np.ptp(in_turn.columns["stress.SG1"]) > 20.0 * np.ptp(default.columns["stress.SG1"])
    assert np.ptp(in_turn.columns["speed"]) > 1.0


def test_documentation_and_picture(build: Callable[..., Path]) -> None:
    fmu = build("crane", "native")
    page = read(fmu, "documentation/index.html").decode()
    assert all(v.name in page for v in fmpy.read_model_description(str(fmu)).modelVariables)
    assert "x forward" in page
    picture = read(fmu, "model.png")
    assert picture.startswith(b"\x89PNG")
    assert struct.unpack_from(">2I", picture, 16) == (200, 150)
    assert b"Redistribution" in read(fmu, "documentation/licenses/license.txt")


def test_types_are_quantities_and_ranges_stand_at_variables(build: Callable[..., Path]) -> None:
    description = fmpy.read_model_description(str(build("crane", "native")))
    by_name = {v.name: v for v in description.modelVariables}
    torque = by_name["torque"]
    assert (torque.declaredType.name, torque.declaredType.quantity, torque.declaredType.unit) == (
        *2 * ["Torque"],
        "N.m",
    )
    assert (torque.min, torque.max) == ("-30.0", "30.0")
    assert by_name["rod.angle"].declaredType.displayUnit == "deg"
    assert by_name["solver.halvings"].type == by_name["solver.halvings"].declaredType.type == "Integer"
    assert all(v.declaredType is not None and v.declaredType.unit == v.unit for v in description.modelVariables)


def test_types_of_one_name_and_two_meanings_get_two_names() -> None:
    def speed(display: str | None) -> Variable:
        return Variable("v", "input", "continuous", "m/s", "", "input", 0, 0.0, 0.0, 1.0, display)

    types = declared_types([speed(None), speed("km/h"), speed(None)])
    assert set(types) == {"Velocity", "Velocity_in_m_s"}
    assert {t.get("displayUnit") for t in types.values()} == {None, "km/h"}


def test_a_scene_whose_default_experiment_fails_is_refused_with_a_remedy() -> None:
    with pytest.raises(
        mbs.SimulationError, match=r"10 s in steps of 0\.01 s as `m\.stop_time` and `m\.step` .* step from"
    ):
        reference_runs(mbs.compile(cart_pole.build()))


def test_the_system_that_follows_may_be_the_first() -> None:
    """Systems are counted from 0, and only -1 is none."""
    systems = mbs.compile(cart_pole.build()), mbs.compile(prototype_car.build())

    def contents(fidelity: int, *followers: int) -> NativeContents:
        return NativeContents("model", "", "1", systems, (), Dependencies({}, {}), fidelity, followers)

    assert contents(1, -1, 0).follower is systems[0]
    assert contents(0, 1, -1).follower is systems[1]
    assert contents(0, -1, 0).follower is None
