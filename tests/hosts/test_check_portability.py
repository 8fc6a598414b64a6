"""What was found wrong with FMUs once is found again by `hosts.check.command` where it is put back in."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from fmu_src.build.build import face_name
from fmu_src.native.sources import DETOUR, HERE, KERNEL_INCLUDE, shell_files
from hosts.check.all_checks import CHECKS
from hosts.check.command import main
from mbs.kernel import build
from tests import kinds
from tests.in_process import run

ROOT = Path(__file__).parents[2]
SCENES = ROOT / "tests" / "fmu" / "scenes.py"
Change = tuple[str, str, str]


@pytest.fixture(scope="module")
def fmus(scene_fmu: Callable[..., Path]) -> dict[str, Path]:
    return {kind: scene_fmu(f"{SCENES}:crank_slider", kind, plain=True) for kind in kinds.VERSIONS}


def findings(fmu: Path) -> dict[str, str]:
    """Verdict and words of each check."""
    printed = run(main, fmu, "--steps", 5).stdout
    lines = [line for line in printed.splitlines() if line[:4].strip() in ("ok", "note", "BAD")]
    return {line[6:28].strip(): line[:4].strip() + " " + line[30:] for line in lines}


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
        sources, include = [*build.sources(lanes=False), *shell.values()], (KERNEL_INCLUDE, HERE, DETOUR)
        build.compile_c(sources, build.host_target(), binary, include=include, defines=("ALI3_INSIDE",), what="a copy")
        files[library] = binary.read_bytes()
    with zipfile.ZipFile(copy, "w") as target:
        for name, data in files.items():
            target.writestr(name, data)
    return copy


@pytest.mark.slow
def test_our_fmus_have_none_of_the_faults(fmus: dict[str, Path]) -> None:
    for fmu in fmus.values():
        found = findings(fmu)
        assert len(found) == len(CHECKS)
        assert all(message.startswith("ok") for message in found.values()), found


XML = "modelDescription.xml"
OPEN = {
    *("unit names", "whole numbers", "about the file", "build description", "quiet steps", "careless calls"),
    *("resources", "refused steps", "far from zero", "stop time"),
}
"""What the standard leaves open, or hosts do not rely on."""
TEXTS: list[tuple[str, str, str, list[Change]]] = [
    (
        "native",
        "unit names",
        "'N m' and 'N.m'",
        [(XML, '<Unit name="N.m">', '<Unit name="N m"><BaseUnit kg="1" m="2" s="-2" /></Unit><Unit name="N.m">')],
    ),
    ("native", "whole numbers", "such as solver.", [(XML, "<Integer", "<Real")]),
    (
        "native",
        "about the file",
        "2000-01-01",
        [(XML, 'generationDateAndTime="', 'generationDateAndTime="2000-01-01T00:00:00Z" x="')],
    ),
    ("native", "about the file", "no author, copyright", [(XML, ' author="', ' x1="'), (XML, ' copyright="', ' x2="')]),
    ("native", "about the file", "nominal", [(XML, " nominal=", " x1=")]),
    (
        "native",
        "about the file",
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
        "are named are missing: gone.c",
        [("sources/buildDescription.xml", '<SourceFile name="values.c"', '<SourceFile name="gone.c"')],
    ),
    (
        "fmi3",
        "build description",
        "not named",
        [("sources/buildDescription.xml", '<Library name="m"', '<Library name="n"')],
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "check", "message", "changes"), TEXTS)
def test_documents(
    fmus: dict[str, Path], tmp_path: Path, kind: str, check: str, message: str, changes: list[Change]
) -> None:
    words = findings(changed(fmus[kind], tmp_path / "copy.fmu", changes))[check]
    assert words.startswith("note" if check in OPEN else "BAD")
    assert message in words


CALLS: list[tuple[str, str, str, Change]] = [
    (
        "native",
        "dependencies",
        "on which it is said not to depend",
        ("sources/values.c", "value[i] = s->value[reference[i]];", "value[i] = s->value[reference[i]] + s->value[0];"),
    ),
    ("fmi3", "derivatives", "differences are", ("sources/derivatives.c", "out[i] = all[unknown[i]];", "out[i] = 7.0;")),
    (
        "fmi3",
        "answers of steps",
        "lastSuccessfulTime is its end",
        ("sources/fmi3_step.c", "= ali3_time(face->s->fidelity.kernel)", "= time"),
    ),
    (
        "fmi3",
        "answers of steps",
        "returns early, which was not allowed",
        ("sources/fmi3_step.c", "*early_return = face->s->returned_early", "*early_return = true"),
    ),
    (
        "fmi3",
        "time",
        "cannot be read",
        ("sources/fmi3_life.c", "reference[i] >= fmi3_the_table.n_arrays", "reference[i] >= fmi3_the_table.time"),
    ),
    (
        "native",
        "quiet steps",
        "status 1",
        (
            "sources/step.c",
            "return halved > watched ? halved : watched;",
            "return halved > watched || s->calls.step_warned ? SLAVE_WARNING : SLAVE_OK;",
        ),
    ),
    ("native", "resources", "FILE://", ("sources/resource.c", "uri[n] == scheme[n] - ('a' - 'A')", "0")),
    (
        "native",
        "refused steps",
        "without end",
        ("sources/refused_step.c", "r->step == step ? r->count + 1 : 1", "r->step == step ? 1 : 1"),
    ),
    (
        "native",
        "careless calls",
        "log category",
        (
            "sources/log.c",
            "if (k == CATEGORIES)\n      return",
            "if (k == CATEGORIES) return SLAVE_OK;\n    if (k == CATEGORIES)\n      return",
        ),
    ),
    (
        "native",
        "stop time",
        "a step beyond it",
        ("sources/step.c", "time + step > s->calls.stop_time", "0.0 > 1.0 + s->calls.stop_time"),
    ),
    ("native", "careless calls", "empty instance name", ("sources/life_cycle.c", "name[0] == 0", "false")),
    ("native", "far from zero", "clock stands", ("sources/step.c", "!(time + step > time) || ", "false && ")),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "check", "message", "change"), CALLS)
def test_calls(fmus: dict[str, Path], tmp_path: Path, kind: str, check: str, message: str, change: Change) -> None:
    words = findings(changed(fmus[kind], tmp_path / "copy.fmu", [change], face_name(kind)))[check]
    assert words.startswith("note" if check in OPEN else "BAD")
    assert message in words
