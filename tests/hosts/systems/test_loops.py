"""Systems of a car and its partners have no algebraic loop as masters see one, and step without iteration."""

from collections.abc import Mapping
from pathlib import Path

import fmpy
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from hosts.systems import CoupledFmus
from tests.hosts.systems import controlled, weak_coupling
from tests.hosts.systems.controlled import SYSTEMS
from tests.hosts.systems.weak_coupling import CASES
from tests.quick import quick

SYSTEM = "brakes on split friction"
"""A car, a controller of its brakes and a driver."""


def loops(parts: Mapping[str, Path], wires: Mapping[str, str], declared: bool = True) -> list[set[str]]:
    """Strongly connected components of wires and declared dependencies.

    As OMSimulator finds them (src/OMSimulatorLib, `ComponentFMUCS::initializeDependencyGraph_outputs` and
    `DirectedGraph::getSortedConnections`): an output without a list depends on all inputs of its FMU. `declared`:
    False: every output is taken so.
    """
    edges = [(source, target) for target, source in wires.items()]
    for part, path in parts.items():
        description = fmpy.read_model_description(str(path))
        inputs = [v.name for v in description.modelVariables if v.causality == "input"]
        for unknown in description.outputs:
            listed = unknown.dependencies if declared else None
            known = inputs if listed is None else [v.name for v in listed]
            edges += [(f"{part}.{name}", f"{part}.{unknown.variable.name}") for name in known]
    names = sorted({name for edge in edges for name in edge})
    rows, columns = ([names.index(edge[k]) for edge in edges] for k in (0, 1))
    graph = coo_array(([1] * len(edges), (rows, columns)), shape=(len(names), len(names)))
    count, labels = connected_components(graph, directed=True, connection="strong")
    parts_of = [{name for name, label in zip(names, labels, strict=True) if label == k} for k in range(count)]
    return [found for found in parts_of if len(found) > 1]


@pytest.mark.slow
@pytest.mark.parametrize("name", quick((SYSTEM, "drive", "trailer"), (*SYSTEMS, *CASES), "proof"))
def test_a_car_and_its_partners_make_no_loop(name: str) -> None:
    """Their partners declare no dependencies, and so have all."""
    if name in CASES:
        parts, wires = weak_coupling.parts_of(name), CASES[name].wires
    else:
        parts, wires = controlled.parts_of(SYSTEMS[name]), SYSTEMS[name].wires
    assert loops(parts, wires) == []
    assert loops(parts, wires, declared=False)


@pytest.mark.slow
def test_a_step_of_it_calls_each_part_once() -> None:
    case, calls = SYSTEMS[SYSTEM], dict[str, int]()
    with CoupledFmus(controlled.parts_of(case), case.wires, step=0.004) as system:
        system.initialise(**controlled.start_of(SYSTEM))
        for part in ("car", "controller", "driver"):
            fmu, calls[part] = system.fmu(part), 0
            make = fmu.step

            def counted(*arguments: float, part: str = part, make=make) -> None:
                calls[part] += 1
                make(*arguments)

            fmu.step = counted
        for _ in range(50):
            system.step()
        assert not system.messages
    assert calls == {"car": 50, "controller": 50, "driver": 50}
