"""No circle of imports among files or rooms; imports for type checkers and inside functions count."""

from collections.abc import Iterable, Mapping
from graphlib import CycleError, TopologicalSorter

import grimp
import pytest

from tests.house.test_import_directions import KERNEL, ROOT, calls, sources

PACKAGES = ("ali3", "benchmarks", "fmu_src", "hosts", "mbs", "viewer")
FACADES = {"mbs", "mbs.elements", "mbs.flexible", "mbs.model", "mbs.vehicle"}
"""Packages whose `__init__` imports what a user asks for when he asks for it."""


@pytest.fixture(scope="module")
def imports() -> dict[str, set[str]]:
    """Imported modules by importing module."""
    graph = grimp.build_graph(*PACKAGES, exclude_type_checking_imports=False, cache_dir=None)
    return {name: graph.find_modules_directly_imported_by(name) for name in graph.modules - FACADES}


def circle(graph: Mapping[str, Iterable[str]]) -> str:
    """The first circle in words; empty where there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return " knows ".join(reversed(error.args[1]))
    return ""


def rooms(imports: Mapping[str, Iterable[str]]) -> dict[str, set[str]]:
    """Known rooms by room: what lies directly in a package."""

    def room(name: str) -> str:
        return ".".join(name.split(".")[:2])

    graph: dict[str, set[str]] = {}
    for name, known in imports.items():
        graph.setdefault(room(name), set()).update(room(k) for k in known if room(k) not in (room(name), *FACADES))
    return graph


def c_files(folder: str, prefix: str) -> dict[str, set[str]]:
    """Files whose functions a C file calls."""
    return {file: set(names.values()) for file, names in calls(sources(ROOT / folder), prefix).items()}


def test_no_circle_of_python_files(imports: dict[str, set[str]]) -> None:
    assert len(imports) > 700
    assert circle(imports) == ""


def test_no_circle_of_rooms(imports: dict[str, set[str]]) -> None:
    assert circle(rooms(imports)) == ""


@pytest.mark.parametrize(("folder", "prefix"), [(KERNEL, "ali3_"), ("fmu_src/native/src", "slave_")])
def test_no_circle_of_c_files(folder: str, prefix: str) -> None:
    graph = c_files(folder, prefix)
    assert sum(map(len, graph.values())) > 50
    assert circle(graph) == ""


def test_a_circle_is_seen(imports: dict[str, set[str]]) -> None:
    turned = {**imports, "mbs.common.errors": {"mbs.common.checks", "mbs.compiler.rows"}}
    assert "mbs.common.errors" in circle(turned)
    assert "mbs.common" in circle(rooms(turned))
