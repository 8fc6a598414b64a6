"""The rooms of `benchmarks/`: who may import whom, and the list of commands."""

import ast
import importlib
from collections.abc import Iterator
from pathlib import Path

import pytest

import benchmarks
from benchmarks.__main__ import commands, main

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "benchmarks"
ROOMS = benchmarks.ROOMS
MODULES = {n: f"benchmarks.{n}.__main__" if n in benchmarks.ROOMS else f"benchmarks.{n}" for n in commands()}
COMMANDS = set(MODULES.values())


def imports(file: Path) -> Iterator[str]:
    """Names of the modules of `benchmarks` that a file imports."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def files(folder: Path) -> list[Path]:
    return [file for file in folder.rglob("*.py") if "__pycache__" not in file.parts]


def test_every_folder_is_a_room_with_a_docstring() -> None:
    packages = {file.parent.name: file for file in FOLDER.glob("*/__init__.py")}
    assert set(packages) == set(ROOMS)
    assert all(ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) for file in packages.values())
    assert all(f"`{room}`" in (benchmarks.__doc__ or "") for room in ROOMS)


def test_nothing_imports_a_command() -> None:
    wrong = {(str(f.relative_to(FOLDER)), name) for f in files(FOLDER) for name in imports(f) if name in COMMANDS}
    assert not wrong


def test_tests_other_than_those_of_the_commands_import_no_command() -> None:
    tests = [f for f in files(ROOT / "tests") if "benchmarks" not in f.relative_to(ROOT).parts]
    users = [f for f in tests if "benchmarks" in f.read_text(encoding="utf-8")]
    results = {(f.name, name) for f in users for name in imports(f) if name.startswith("benchmarks")}
    assert results, "no test uses the references: look here again"
    assert not {pair for pair in results if pair[1] in COMMANDS}


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_those_before_it(room: str) -> None:
    allowed = {*ROOMS[: ROOMS.index(room) + 1]}
    inside = [f for f in files(FOLDER / room) if f.name != "__main__.py"]
    used = {name.split(".")[1] for f in inside for name in imports(f) if name.startswith("benchmarks.")}
    assert used <= allowed


def test_the_list_names_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main() == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(commands()) == 12
    assert {line.split()[2].removeprefix("benchmarks.") for line in lines} == set(commands())
    assert all(len(line.split()) > 3 for line in lines)


@pytest.mark.parametrize("name", sorted(commands()))
def test_a_command_explains_itself_and_its_parts(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Tables of a part stand on its pages, and what is between marks there is made by a part or by `figures`."""
    module = importlib.import_module(MODULES[name])
    assert f"python -m benchmarks.{name}" in (module.__doc__ or "")
    with pytest.raises(SystemExit) as ended:
        module.main(["--help"])
    assert ended.value.code == 0
    assert f"usage: python -m benchmarks.{name} " in capsys.readouterr().out
    for key, part in module.PARTS.items() if name != "figures" else ():
        assert part.about
        assert (part.blocks is not None) == bool(part.pages), key
        assert part.rows or part.blocks is None, key
        assert all((ROOT / "docs" / page).is_file() for page in part.pages), key
