"""What was found wrong with FMUs once is found again by its check where it is put back in."""

import os
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from fmu_src.build.build import face_name
from fmu_src.native.sources import HERE, KERNEL_INCLUDE, PYTHON_SLAVE, shell_files
from mbs.kernel import build
from tests import kinds
from tests.hosts.changed_fmu import changed_fmu
from tests.hosts.one_check import one_check

ROOT = Path(__file__).parents[2]
SCENES = ROOT / "tests" / "fmu" / "scenes.py"
Change = tuple[str, str, str]
pytestmark = [pytest.mark.slow, pytest.mark.skipif(not hasattr(os, "fork"), reason="a check in a forked process")]


@pytest.fixture(scope="module")
def fmus(scene_fmu: Callable[..., Path]) -> dict[str, Path]:
    return {kind: scene_fmu(f"{SCENES}:crank_slider", kind, plain=True) for kind in kinds.VERSIONS}


def changed(fmu: Path, copy: Path, changes: list[Change], face: str = "") -> Path:
    """A copy with texts of its files replaced; with a face its library is compiled with the sources among them.

    The others are compiled where they are: the compiler knows a file that it has compiled by its place.
    """
    with zipfile.ZipFile(fmu) as source:
        files = {name: source.read(name) for name in source.namelist()}
    for name, old, new in changes:
        assert old.encode() in files[name], (name, old)
        files[name] = files[name].replace(old.encode(), new.encode())
    if face:
        (library,) = (name for name in files if name.startswith("binaries/"))
        binary, own = copy.with_name(Path(library).name), {}
        for name in ("sources/table.c", *(name for name, _, _ in changes)):
            own[Path(name).name] = copy.with_name(Path(name).name)
            own[Path(name).name].write_bytes(files[name])
        shell = {file.name: file for file in shell_files(face)} | own
        assert len(shell) == len(shell_files(face)) + 1, "a table, and only files that there are"
        sources, include = [*build.sources(lanes=False), *shell.values()], (KERNEL_INCLUDE, HERE, PYTHON_SLAVE)
        build.compile_c(sources, build.host_target(), binary, include=include, defines=("ALI3_INSIDE",), what="a copy")
        files[library] = binary.read_bytes()
    return changed_fmu(fmu, copy, files)


XML = "modelDescription.xml"
TEXTS: list[tuple[str, str, str, str, list[Change]]] = [
    (
        "native",
        "unit names",
        "note",
        "'N m' and 'N.m'",
        [(XML, '<Unit name="N.m">', '<Unit name="N m"><BaseUnit kg="1" m="2" s="-2" /></Unit><Unit name="N.m">')],
    ),
    ("native", "whole numbers", "note", "such as solver.", [(XML, "<Integer", "<Real")]),
    (
        "native",
        "about the file",
        "note",
        "2000-01-01",
        [(XML, 'generationDateAndTime="', 'generationDateAndTime="2000-01-01T00:00:00Z" x="')],
    ),
    (
        "native",
        "about the file",
        "note",
        "no author, copyright",
        [(XML, ' author="', ' x1="'), (XML, ' copyright="', ' x2="')],
    ),
    ("native", "about the file", "note", "nominal", [(XML, " nominal=", " x1=")]),
    (
        "native",
        "about the file",
        "note",
        "several variables",
        [
            (
                XML,
                "Number of halved inner steps since the start",
                "Status of the last step: 0 good, else a code of the solver",
            )
        ],
    ),
    (
        "fmi3",
        "source files",
        "bad",
        "are named are missing: gone.c",
        [("sources/buildDescription.xml", '<SourceFile name="values.c"', '<SourceFile name="gone.c"')],
    ),
    (
        "fmi3",
        "build description",
        "note",
        "not named",
        [("sources/buildDescription.xml", '<Library name="m"', '<Library name="n"')],
    ),
]


@pytest.mark.parametrize(("kind", "check", "verdict", "message", "changes"), TEXTS)
def test_documents(fmus, tmp_path, kind, check, verdict, message, changes):
    actual, words = one_check(changed(fmus[kind], tmp_path / "copy.fmu", changes), check)
    assert actual == verdict
    assert message in words


CALLS: list[tuple[str, str, str, str, Change]] = [
    (
        "fmi3",
        "answers of steps",
        "bad",
        "lastSuccessfulTime is its end",
        ("sources/fmi3_step.c", "= ali3_time(adapter->s->fidelity.kernel)", "= time"),
    ),
    (
        "fmi3",
        "answers of steps",
        "bad",
        "returns early, which was not allowed",
        ("sources/fmi3_step.c", "*early_return = adapter->s->returned_early", "*early_return = true"),
    ),
    (
        "fmi3",
        "time",
        "bad",
        "cannot be read",
        ("sources/fmi3_life.c", "reference[i] >= fmi3_the_table.n_arrays", "reference[i] >= fmi3_the_table.time"),
    ),
    ("native", "resources", "note", "FILE://", ("sources/resource.c", "uri[n] == scheme[n] - ('a' - 'A')", "0")),
    (
        "native",
        "careless calls",
        "note",
        "log category",
        (
            "sources/log.c",
            "if (k == CATEGORIES)\n      return",
            "if (k == CATEGORIES) return SLAVE_OK;\n    if (k == CATEGORIES)\n      return",
        ),
    ),
    ("native", "careless calls", "note", "empty instance name", ("sources/life_cycle.c", "name[0] == 0", "false")),
]


@pytest.mark.parametrize(("kind", "check", "verdict", "message", "change"), CALLS)
def test_calls(fmus, tmp_path, kind, check, verdict, message, change):
    copy = changed(fmus[kind], tmp_path / "copy.fmu", [change], face_name(kind))
    actual, words = one_check(copy, check, 5)
    assert actual == verdict, words
    assert message in words
