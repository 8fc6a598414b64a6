"""Compilation begins before the model is compiled; the object files are shared and never part of an FMU."""

import shutil
import subprocess
import tempfile
import time
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

import fmpy
import pytest

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.native import compilation, sources
from fmu_src.native import early_compilation as ahead
from fmu_src.native.early_compilation import compiled_ahead
from mbs.kernel import build
from tests.fmu import scenes
from tests.unoptimised import unoptimised

PLATFORM = fmpy.platform


@pytest.fixture(autouse=True)
def empty(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A cache of the compiler in which nothing is."""
    folder = tmp_path / "cache"
    folder.mkdir()
    monkeypatch.setattr(build, "cache_directory", lambda: folder)
    return folder


@pytest.fixture
def commands(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """What would be compiled, in its order."""
    begun: list[list[str]] = []

    def compilers(commands: list[list[str]]) -> AbstractContextManager[None]:
        begun.extend(commands)
        return nullcontext()

    monkeypatch.setattr(ahead, "_compilers", compilers)
    return begun


def test_the_first_library_is_begun_at_both_ends(commands):
    with compiled_ahead([("fmi2", "linux64"), ("fmi3", "darwin64")]):
        pass
    assert len(commands) == 4  # darwin64 has two processors
    first, second = ([part for part in c if part.endswith(".c")] for c in commands[:2])
    assert second == first[::-1]
    assert len(set(first)) == len(first) > 50
    assert len({c[c.index("-o") + 1] for c in commands}) == 4
    assert [c[c.index("-target") + 1] for c in commands[2:]] == ["x86_64-macos.10.13", "aarch64-macos.11.0"]


def test_its_compilers_end_with_it(monkeypatch, tmp_path):
    started: list[subprocess.Popen[bytes]] = []
    popen = subprocess.Popen

    def start(*arguments: object, **options: object) -> subprocess.Popen[bytes]:
        started.append(popen(["sleep", "60"], **options))  # type: ignore[call-overload]
        return started[-1]

    monkeypatch.setattr(ahead.subprocess, "Popen", start)
    place = tmp_path / "temporary"
    place.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(place))

    def interrupted() -> None:
        with compiled_ahead([("fmi2", "linux64")]):
            while not started:
                time.sleep(0.01)
            raise KeyError

    with pytest.raises(KeyError):
        interrupted()
    assert started
    assert all(process.poll() not in (None, 0) for process in started)
    assert list(place.iterdir()) == []


@pytest.mark.slow
def test_what_a_build_has_compiled_is_not_begun_again(commands, monkeypatch):
    """Until a source or an option changes; a build that fails leaves it to the next."""

    def count() -> int:
        commands.clear()
        with compiled_ahead([("fmi2", "linux64")]):
            return len(commands)

    with pytest.raises(KeyError), compiled_ahead([("fmi2", "linux64")]):
        raise KeyError
    assert (count(), count()) == (2, 0)
    with unoptimised():
        assert (count(), count()) == (2, 0)
    read = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda file: read(file) + b" " * (file.name == "ali3.h"))
    assert (count(), count()) == (2, 0)


@pytest.mark.slow
def test_folders_with_the_same_sources_share_their_objects(monkeypatch, tmp_path):
    """A changed C file is another file for the compiler, a changed header makes all of them others."""
    monkeypatch.setattr(build, "cache_directory", lambda: tmp_path / "cache")

    def given() -> set[str]:
        command = compilation.library_command("python", build.host_target(), tmp_path / "table.c", tmp_path / "library")
        return {part for part in command if part.endswith(".c") or part.startswith("-I")}

    rooms, here = compilation._ROOMS, given()
    for root, name in rooms.items():
        shutil.copytree(root, tmp_path / name, ignore=shutil.ignore_patterns("lib", "__pycache__"))
    monkeypatch.setattr(compilation, "_ROOMS", {tmp_path / name: name for name in rooms.values()})
    monkeypatch.setattr(build, "HERE", tmp_path / "kernel")
    monkeypatch.setattr(sources, "HERE", tmp_path / "shell")
    monkeypatch.setattr(sources, "PYTHON_SLAVE", tmp_path / "python")
    assert given() == here
    with (tmp_path / "shell" / "step.c").open("a") as file:
        file.write("\n")
    (other,) = given() - here
    assert Path(other).read_text() == (tmp_path / "shell" / "step.c").read_text()
    with (tmp_path / "kernel" / "src" / "instance.h").open("a") as file:
        file.write("\n")
    assert given() & here == {str(tmp_path / "table.c")}


@pytest.mark.slow
def test_kinds_share_the_objects_of_generated_code(tmp_path):
    """The compiler knows an object by the place of its source, its headers and its options."""

    def given(face: str, code: str) -> str:
        files, include = compilation._files(face, tmp_path / "table.c", {"code": code})
        (file,) = (file for file in files if file.parent.name == "generated")
        assert file.read_text() == code
        return f"{file} {include}"

    first = given("fmi2", "int one;")
    assert given("fmi3", "int one;") == given("python", "int one;") == first
    assert given("fmi2", "int two;") != first


@pytest.mark.proof  # the keys by which the compiler finds objects are those of the tests above
@unoptimised()
def test_a_second_model_compiles_its_table_and_its_code_only(tmp_path, empty):
    def objects() -> int:
        return len(list((empty / "o").rglob("*.o")))

    system = mbs.compile(scenes.crane())
    with compiled_ahead([("fmi2", PLATFORM)]):
        cold = build_fmu(system, "crane", tmp_path / "cold", [PLATFORM]).read_bytes()
    assert build_fmu(system, "crane", tmp_path / "usual", [PLATFORM]).read_bytes() == cold
    before = objects()
    assert before > 90
    build_fmu(mbs.compile(scenes.sled()), "sled", tmp_path, [PLATFORM])
    assert objects() == before + 2
