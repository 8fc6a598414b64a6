"""SSP archives of systems: as read by FMPy, valid by the schema, and refusals."""

import sys
import zipfile
from pathlib import Path
from typing import Any

import fmpy.ssp.ssd
import pyssp_standard
import pytest
from lxml import etree
from pyssp_standard.ssd import SSD

from ali3.read_parameter_set import read_parameter_set
from hosts.common.errors import HostError
from hosts.systems import write_ssp
from tests.hosts.odd_fmus import planted_fmu

SCHEMAS = {
    "1.0": Path(fmpy.ssp.__file__).parent / "schema" / "SystemStructureDescription.xsd",
    "2.0": Path(pyssp_standard.__file__).parent / "resources" / "ssp2" / "SystemStructureDescription.xsd",
}
"""Those of FMPy, and of `pyssp_standard`, which has that of the tag v2.0 of modelica/ssp-standard as it stands."""
WIRES = {"spring.position": "mass.position", "mass.force": "spring.force"}


def halves(partners: dict[str, Path]) -> dict[str, Path]:
    return {"mass": partners["half_mass"], "spring": partners["half_spring"]}


def test_fmpy_reads_the_connections(partners, tmp_path):
    file = write_ssp(tmp_path / "oscillator.ssp", halves(partners), WIRES, {"mass.start": 0.5})
    system = fmpy.ssp.ssd.read_ssd(str(file)).system
    assert [c.name for c in system.elements] == ["mass", "spring"]
    actual = {(c.endElement, c.endConnector): (c.startElement, c.startConnector) for c in system.connections}
    expected = {tuple(end.split(".")): tuple(start.split(".")) for end, start in WIRES.items()}
    assert actual == expected


def description(file: Path) -> Any:
    with zipfile.ZipFile(file) as archive:
        return etree.fromstring(archive.read("SystemStructure.ssd"))


@pytest.mark.parametrize("version", SCHEMAS)
@pytest.mark.parametrize("wires", [WIRES, {}])
def test_the_description_fits_the_schema(partners, tmp_path, wires, version):
    """With wires and a part that has none, and without any."""
    parts = halves(partners) | {"alone": partners["jump"]}
    document = description(write_ssp(tmp_path / "system.ssp", parts, wires, {"mass.start": 0.5}, version=version))
    schema = etree.XMLSchema(etree.parse(SCHEMAS[version]))
    assert schema.validate(document), schema.error_log
    assert document.get("version") == version


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the small FMUs are compiled for this machine")
@pytest.mark.parametrize(("version", "kind"), [("1.0", "Real"), ("2.0", "Float64")])
def test_parts_of_fmi_3(tmp_path, version, kind):
    """Types are those of the version; both fit its schema, and the package `pyssp_standard` reads what was wired."""
    fmu = planted_fmu(tmp_path, "NONE", True)
    file = write_ssp(
        tmp_path / "two.ssp", {"one": fmu, "other": fmu}, {"other.u": "one.y"}, {"one.u": 1.0}, "", version
    )
    document = description(file)
    schema = etree.XMLSchema(etree.parse(SCHEMAS[version]))
    assert schema.validate(document), schema.error_log
    assert [etree.QName(e[0]).localname for e in document.iter("{*}Connector")] == [kind, kind]
    with zipfile.ZipFile(file) as archive:
        archive.extract("SystemStructure.ssd", tmp_path)
    with SSD(tmp_path / "SystemStructure.ssd") as ssd:
        (wire,) = ssd.system.connections
        assert (wire.start_element, wire.start_connector) == ("one", "y")
        assert (wire.end_element, wire.end_connector) == ("other", "u")


def test_two_fmus_of_one_file_name_stay_two(partners, tmp_path):
    parts = {"one": partners["jump"], "two": partners["stateless"]}
    assert parts["one"].name == parts["two"].name
    file = write_ssp(tmp_path / "two.ssp", parts, {}, {})
    with zipfile.ZipFile(file) as archive:
        for component in fmpy.ssp.ssd.read_ssd(str(file)).system.elements:
            assert archive.read(component.source) == parts[component.name].read_bytes()


def test_start_values_of_all_types(partners, tmp_path):
    start = {"all.file": "a.road", "all.count": 3.0, "all.on": True, "all.size": 2}
    file = write_ssp(tmp_path / "all.ssp", {"all": partners["settings"]}, {}, start)
    with zipfile.ZipFile(file) as archive:
        archive.extract("resources/all.ssv", tmp_path)
    actual = read_parameter_set(tmp_path / "resources" / "all.ssv").entries
    assert [(e.name, e.kind, e.value) for e in actual] == [
        ("file", "String", "a.road"),
        ("count", "Integer", "3"),
        ("on", "Boolean", "true"),
        ("size", "Real", "2.0"),
    ]


@pytest.mark.parametrize(
    ("name", "file", "start", "message"),
    [
        ("all", "a.ssp", {"all.stop": 0.5}, "The part 'all': the FMU has no parameter or input 'stop'"),
        ("all", "a.ssp", {"all.size": "fast"}, "The part 'all': 'size' is 'fast'; it must be a Real"),
        ("all", "a.ssp", {"all.count": 1.5}, "'count' is 1.5; it must be a whole number"),
        ("all", "a.ssp", {"all.file": 1.0}, "'file' is 1; it must be a String"),
        ("all", "a.zip", {}, r"a\.zip: the name of an SSP ends in \.ssp"),
        ("all", "a.ssp", {1: 2.0}, "The names of the start values have 1 among them"),
        ("../all", "a.ssp", {}, r"A part is named '\.\./all'; its name must be of letters"),
    ],
)
def test_impossible_options_are_refused_and_write_nothing(partners, tmp_path, name, file, start, message):
    with pytest.raises(HostError, match=message):
        write_ssp(tmp_path / file, {name: partners["settings"]}, {}, start)
    assert list(tmp_path.iterdir()) == []


def test_a_file_and_a_name_that_cannot_be_are_one_sentence(partners, tmp_path):
    """Text that XML has no character for would make an SSP that nobody reads."""
    with pytest.raises(HostError, match="The file of an SSP is 1; it must be a path"):
        write_ssp(1, halves(partners), WIRES, {})  # type: ignore[arg-type]
    with pytest.raises(HostError, match=r"The version of SSP is '3\.0'; it must be 1\.0 or 2\.0"):
        write_ssp(tmp_path / "a.ssp", halves(partners), WIRES, {}, version="3.0")
    for name, text in ((1, "1"), ("a\x00b", r"'a\\x00b'"), ("\ud800", r"'\\ud800'")):
        with pytest.raises(HostError, match=f"The name of the system is {text}; it must be a text that can be printed"):
            write_ssp(tmp_path / "a.ssp", halves(partners), WIRES, {}, name=name)
    assert list(tmp_path.iterdir()) == []
    assert write_ssp(str(tmp_path / "a.ssp"), halves(partners), WIRES, {}, name="<&>").is_file()  # type: ignore[arg-type]


def test_an_older_file_stays_where_the_new_one_fails(partners, tmp_path, monkeypatch):
    file = write_ssp(tmp_path / "a.ssp", halves(partners), WIRES, {})
    before = file.read_bytes()
    monkeypatch.setattr(zipfile.ZipFile, "write", lambda *_: (_ for _ in ()).throw(RuntimeError("stopped")))
    with pytest.raises(RuntimeError, match="stopped"):
        write_ssp(file, halves(partners), WIRES, {"mass.start": 0.5})
    assert file.read_bytes() == before
