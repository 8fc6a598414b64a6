"""An archive that would unpack outside its folder, or to too many bytes, is refused by all readers of archives."""

import stat
import warnings
import zipfile
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

import pytest

from ali3.archives import Archive, faults_of
from ali3.errors import FileError, UserError
from fmu_src.native.added_platforms import add_platforms
from hosts.check.documents import check_archive
from hosts.common.errors import HostError
from hosts.fmu import description_file
from hosts.fmu.description_file import read_description
from hosts.fmu.fmu import unpack
from hosts.fmu.geometry import scene_of

DESCRIPTION = (
    '<fmiModelDescription fmiVersion="2.0" modelName="m" guid="g"><CoSimulation modelIdentifier="m"/>'
    "<ModelVariables>{}</ModelVariables><ModelStructure/></fmiModelDescription>"
)
CONTENT = {"modelDescription.xml": DESCRIPTION.format("")}


def archive(file: Path, *entries: tuple[str | zipfile.ZipInfo, str], method: int = zipfile.ZIP_DEFLATED) -> Path:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of doubled names
        with zipfile.ZipFile(file, "w", method) as target:
            for name, content in (*CONTENT.items(), *entries):
                target.writestr(name, content)
    return file


def link(file: Path) -> Path:
    info = zipfile.ZipInfo("sources/table.c")
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    return archive(file, (info, "/etc/passwd"))


def encrypted(file: Path) -> Path:
    content = bytearray(archive(file).read_bytes())
    content[content.find(b"PK\1\2") + 8] |= 1
    file.write_bytes(content)
    return file


def zero_byte(file: Path) -> Path:
    """Its name ends at the zero byte for who reads it as text of C."""
    content = archive(file, ("sources/a.c#", "x")).read_bytes()
    file.write_bytes(content.replace(b"a.c#", b"a.c\0"))
    return file


ATTACKS: dict[str, tuple[Callable[[Path], Path], str, str]] = {
    "climbs": (lambda f: archive(f, ("sources/../../x", "x")), "leads out of its folder", "note"),
    "absolute": (lambda f: archive(f, ("/tmp/x", "x")), "is an absolute path", "bad"),
    "drive": (lambda f: archive(f, ("C:/x", "x")), "is an absolute path", "bad"),
    "double slash": (lambda f: archive(f, ("sources//x", "x")), "is not a file name", "note"),
    "backslash": (lambda f: archive(f, ("sources\\..\\x", "x")), "with a backslash", "bad"),
    "zero byte": (zero_byte, "is not a file name", "note"),
    "twice": (lambda f: archive(f, ("modelDescription.xml", "x")), "'modeldescription.xml' twice", "note"),
    "twice by case": (lambda f: archive(f, ("a", "x"), ("A", "y")), "'a' twice", "note"),
    "folder and file": (lambda f: archive(f, ("sources", "x"), ("sources/a", "y")), "in a folder that is a", "note"),
    "link": (link, "which is a link", "note"),
    "encrypted": (encrypted, "is encrypted", "bad"),
    "method": (lambda f: archive(f, method=zipfile.ZIP_LZMA), "packed by method 14", "bad"),
}


@pytest.mark.parametrize("kind", ATTACKS)
def test_an_archive_is_refused_by_all_that_open_it(kind: str, tmp_path: Path) -> None:
    make, message, verdict = ATTACKS[kind]
    file = make(tmp_path / "a.fmu")
    out = tmp_path / "inside" / "of" / "it"
    out.mkdir(parents=True)
    before = sorted(tmp_path.rglob("*"))
    for use in (
        read_description,
        scene_of,
        lambda fmu: unpack(fmu, out),
        lambda fmu: add_platforms(fmu, ["linux64"], tmp_path / "made.fmu", lambda what, note: nullcontext()),
    ):
        with pytest.raises(UserError, match=message) as refused:
            use(file)
        assert "\n" not in str(refused.value)
    assert sorted(tmp_path.rglob("*")) == before
    (finding,) = check_archive(file)
    assert finding.verdict == verdict
    assert message in finding.words


def test_sizes_are_held_to_bounds_before_anything_is_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bomb = archive(tmp_path / "a.zip", ("zeros", "\0" * 10**6))
    assert bomb.stat().st_size < 10_000
    with Archive(bomb, unpacked=1_001_000) as opened:
        assert opened.names == ["modelDescription.xml", "zeros"]
        with pytest.raises(FileError, match="zeros in .* has 1000000 bytes; it must have at most 1000"):
            opened.read("zeros", 1000)
    with pytest.raises(FileError, match="bytes when it is unpacked; it must have at most 1000000"):
        Archive(bomb, unpacked=1_000_000)
    many = archive(tmp_path / "b.zip", *((f"{k}", "") for k in range(1000)))
    monkeypatch.setattr("ali3.archives.MAX_ENTRIES", 1000)
    message = "has 1001 entries; it must have at most 1000 (or ALI3_LIMITS=2 set)"
    assert [fault.words for fault in faults_of(many)] == [message]
    monkeypatch.setattr("ali3.archives.MAX_ENTRIES", 100)
    with pytest.raises(FileError, match="has a directory of 48956 bytes"):
        faults_of(many)


V = '<ScalarVariable name="v{0}" valueReference="{0}" causality="local"><Real/></ScalarVariable>'
THREE = (
    '<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="g"><CoSimulation modelIdentifier="m"/>'
    '<ModelVariables><Float64 name="a" valueReference="1"><Dimension start="1000000000"/></Float64></ModelVariables>'
    "<ModelStructure/></fmiModelDescription>"
)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (DESCRIPTION.format("".join(map(V.format, range(101)))), "has more than 100 variables"),
        (THREE, "has 1000000000 variables, the elements of arrays counted; it must have at most 100"),
        (DESCRIPTION.format("<a>" * 1000 + "</a>" * 1000), "nested more than 100 deep"),
        ('<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]>' + DESCRIPTION, "has a document type"),
        (DESCRIPTION.replace('fmiVersion="2.0"', ""), "it must begin with <fmiModelDescription fmiVersion"),
        ("<a/>", "begins with <a>"),
        ("\0", "is not readable XML"),
        ('<?xml version="1.0" encoding="utf-7"?><a/>', "in an encoding that is not read"),
    ],
)
def test_descriptions_have_bounds(content: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(description_file, "MAX_VARIABLES", 100)
    file = tmp_path / "a.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", content)
    with pytest.raises(HostError, match=message) as refused:
        read_description(file, validate=False)
    assert "\n" not in str(refused.value)
