"""A missing package is reported with the extra that installs it."""

import ast
import importlib
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from ali3.commands import COMMANDS
from ali3.extras import command_needs, extras, missing_module, missing_package

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("ali3", "mbs", "fmu_src", "hosts", "viewer")


def imported() -> Iterator[str]:
    """Packages of others that the product imports."""
    for package in PACKAGES:
        for file in (ROOT / package).rglob("*.py"):
            if file.name == "main_template.py":  # its imports are named when an FMU is packed
                continue
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Import):
                    yield from (alias.name.partition(".")[0] for alias in node.names)
                elif isinstance(node, ast.ImportFrom) and node.level == 0:
                    yield (node.module or "").partition(".")[0]


@pytest.mark.slow
def test_every_import_has_a_line_that_installs_it() -> None:
    names = set(imported()) - sys.stdlib_module_names - set(PACKAGES)
    assert len(names) > 20
    lines = {name: re.search(r'pip install (ali3|"ali3\[(\w+)\]")$', missing_package(name)) for name in names}
    packed = {"slave"}  # beside each other in an FMU
    assert [name for name, line in lines.items() if line is None] == []
    without = {name for name, line in lines.items() if line is not None and line[2] is None}
    assert without - packed <= {
        "annotated_types",
        "filelock",
        "numpy",
        "platformdirs",
        "pydantic",
        "pydantic_core",
        "scipy",
        "threadpoolctl",
        "tqdm",
    }


def test_extras_that_are_named_exist() -> None:
    files = [*ROOT.glob("*.md"), *(f for f in ROOT.glob("docs/**/*.md") if "_site" not in f.parts)]
    files += [f for package in (*PACKAGES, "benchmarks") for f in (ROOT / package).rglob("*.py")]
    named = [n for f in files for n in re.findall(r"(?:ali3|WHEEL|['\"]\.)\[([a-z,]+)\]['\"]", f.read_text("utf-8"))]
    assert len(named) > 15
    assert {n for names in named for n in names.split(",")} <= extras().keys()
    assert {c.extra for c in COMMANDS} <= extras().keys()


@pytest.mark.parametrize(
    ("command", "extra", "package", "reported"),
    [
        ("study", "", "pyarrow", "study"),
        ("simulator", "", "pyarrow", "simulator"),
        ("study", "", "lxml", "study"),
        ("run", "", "matplotlib", "hosts"),
        ("build", "", "lxml", "fmu"),
        ("view", "pictures", "PIL", "pictures"),
        ("road", "roads", "PIL", "roads"),
        ("view", "pictures", "trimesh", "pictures"),
        ("road", "roads", "trimesh", "roads"),
    ],
)
def test_the_extra_of_the_command_comes_first(command: str, extra: str, package: str, reported: str) -> None:
    command_needs(next(c.extra for c in COMMANDS if c.name == command))
    assert missing_package(package, extra).endswith(f'pip install "ali3[{reported}]"')


def caught(work: Callable[[], object]) -> ModuleNotFoundError:
    with pytest.raises(ModuleNotFoundError) as raised:
        work()
    return raised.value


@pytest.mark.slow
def test_a_module_that_a_library_wants_at_run_time(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("trimesh.viewer")
    monkeypatch.setitem(sys.modules, "pyglet", None)
    error = caught(lambda: importlib.import_module("trimesh.viewer.windowed"))
    message = missing_module(error, "pictures")
    assert message == (
        'The package trimesh needs pyglet, which is not installed; run: python -m pip install "ali3[pictures]" pyglet'
    )


@pytest.mark.proof
def test_each_extra_alone_is_sufficient() -> None:
    done = subprocess.run([sys.executable, "-m", "tests.extras"], cwd=ROOT, check=False)
    assert done.returncode == 0
