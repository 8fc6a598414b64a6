"""What must be read for a command does not grow unseen; `python -m tests.house.reading` prints the whole table."""

from __future__ import annotations

import grimp
import pytest

from ali3.commands import COMMANDS
from tests.house.reading import WAYS, lines_of, read_for
from tests.house.test_circles import PACKAGES

MOST = {
    "build": 42551,
    "build --kernel": 283,
    "car": 14986,
    "run": 3633,
    "run, all of it": 7780,
    "view": 599,
    "simulator": 8115,
    "simulator, all of it": 14623,
    "check": 3366,
    "check --reference": 5145,
    "catalogue": 7728,
    "compare": 8930,
    "study": 5482,
    "study --run": 7296,
    "study, all of it": 14046,
    "road": 512,
}
"""Lines; a command that needs fewer takes its number down with it."""
_SLACK = 300


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph(*PACKAGES, exclude_type_checking_imports=False, cache_dir=None)


def test_no_command_needs_more_than_it_did(graph: grimp.ImportGraph) -> None:
    found = {}
    for command in COMMANDS:
        ways = WAYS.get(command.name, {})
        files = {command.name: read_for(graph, command.module, ways.values())}
        files |= {f"{command.name} {way}": read_for(graph, module) for way, module in ways.items()}
        files[f"{command.name}, all of it"] = read_for(graph, command.module)
        found |= {name: sum(map(lines_of, modules)) for name, modules in files.items()}
    assert {c.name for c in COMMANDS} <= MOST.keys() <= found.keys()
    wrong = {name: (found[name], most) for name, most in MOST.items() if not most - _SLACK < found[name] <= most}
    assert not wrong, "lines and what is stored"


def test_every_way_is_a_module_that_its_command_imports(graph: grimp.ImportGraph) -> None:
    modules = {command.name: command.module for command in COMMANDS}
    for name, ways in WAYS.items():
        assert set(ways.values()) <= read_for(graph, modules[name]), name


def test_a_kind_of_a_part_of_a_car_has_one_door(graph: grimp.ImportGraph) -> None:
    """What the file names by another kind need not be read: only the list of the kinds of its part knows it."""
    plain = read_for(graph, "mbs.vehicle.command", WAYS["car"].values())
    kinds = [module for way, module in WAYS["car"].items() if ".kind " in way]
    assert len(kinds) > 5
    doors = {kind: graph.find_modules_that_directly_import(kind) & plain for kind in kinds}
    assert doors == {kind: {kind.rpartition(".")[0]} for kind in kinds}


def test_what_is_read_goes_on_behind_each_module_but_those_besides() -> None:
    graph = grimp.ImportGraph()
    for importer, imported in (("a", "b"), ("b", "c")):
        graph.add_import(importer=importer, imported=imported)
    assert read_for(graph, "a") == {"a", "b", "c"}
    assert read_for(graph, "a", ["b"]) == {"a"}
