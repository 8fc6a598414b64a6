"""What must be read for a command does not grow unseen; `python -m tests.house.reading` prints the whole table."""

from __future__ import annotations

import subprocess
import sys

import grimp
import pytest

from ali3.commands import COMMANDS
from tests.house.reading import WAYS, lines_of, read_for
from tests.house.test_circles import PACKAGES

MOST = {
    "build": 46487,
    "build --kernel": 400,
    "car": 30912,
    "run": 4304,
    "run, all of it": 8627,
    "view": 797,
    "simulator": 8999,
    "simulator, all of it": 16197,
    "check": 6097,
    "catalogue": 8607,
    "compare": 9890,
    "study": 7058,
    "study --run": 8647,
    "study, all of it": 16457,
    "road": 700,
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


@pytest.mark.slow
def test_a_car_that_asks_for_none_of_the_ways_imports_none() -> None:
    """But the readers of matrices, which `mbs.flexible` offers by name, and what they need."""
    offered = {"mbs.flexible.read_nastran", "mbs.flexible.read_calculix", "mbs.flexible.external_model", "ali3.extras"}
    ways = set(WAYS["car"].values()) - offered
    code = (
        "import sys; from mbs.vehicle.command import main; main(['hatchback']); "
        "print('imported', *(name for name in sys.argv[1:] if name in sys.modules))"
    )
    command = [sys.executable, "-c", code, *sorted(ways), "mbs.compiler.assembly_modes", "mbs.vehicle.summary"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    assert done.stdout.splitlines()[-1] == "imported mbs.vehicle.summary"


def test_what_is_read_goes_on_behind_each_module_but_those_besides() -> None:
    graph = grimp.ImportGraph()
    for importer, imported in (("a", "b"), ("b", "c")):
        graph.add_import(importer=importer, imported=imported)
    assert read_for(graph, "a") == {"a", "b", "c"}
    assert read_for(graph, "a", ["b"]) == {"a"}
