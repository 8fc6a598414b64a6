"""Dependencies on parameters: true for each of them, and no more trials for many than for few."""

import random
from typing import Any

import pytest

import mbs
from fmu_src.description import probe as module
from fmu_src.description.parameter_groups import parameter_groups
from fmu_src.description.probe import probe
from fmu_src.variables.variables import Variable, variable_table
from mbs.elements import EndStops, PlaneRoad
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance


def hanging(links: int, settled: bool = True) -> mbs.Model:
    """Masses on springs below each other, a payload on the last; each spring has a stiffness, a damping and a stop."""
    m = mbs.Model("hanging", dimension=2)
    end: Any = (m.ground, (0.0, 0.0))
    for k in range(links):
        bob = m.point_mass(f"bob {k}", mass=1.0, position=(0.0, -1.0 - k))
        m.point_on_line(f"rail {k}", (bob, None), (m.ground, (0.0, 0.0)), axis=(0.0, 1.0))
        stops = EndStops(rebound_length=1.4, rebound_stiffness=1e3)  # not met where it hangs
        spring = m.spring_damper(f"spring {k}", end, bob, stiffness=5e3, damping=10.0, free_length=1.0, stops=stops)
        for real, start, unit in (
            ("stiffness", 5e3, "N/m"),
            ("damping", 10.0, "N.s/m"),
            ("rebound_stiffness", 1e3, "N/m"),
        ):
            m.parameter(f"spring_{k}.{real}", start, 0.5 * start, 2.0 * start, unit, targets=[(spring, real, 1.0)])
        m.sense_position(f"bob_{k}.y", bob, None, "y")
        m.sense_element(f"spring_{k}.force", spring, "force")
        end = bob
    payload = m.payload("load", bob, (0.0, -float(links)))
    m.parameter("load", 0.0, 0.0, 1.0, "kg", targets=[(payload, "mass", 1.0)], tunable=False)
    m.parameter("friction", 0.5, 0.0, 1.0, targets=[(("road", m.road(PlaneRoad(friction=0.5))), "friction", 1.0)])
    m.sense_mass("mass")
    m.start_in_equilibrium = settled
    return m


def table_of(system: mbs.System) -> tuple[Variable, ...]:
    return variable_table(system.meta, pose=False, step_size=0.01)


def groups_of(model: mbs.Model) -> list[list[str]]:
    system, rng = mbs.compile(model), random.Random(3)
    entries = system.meta["parameters"]
    result = parameter_groups(
        system,
        Instance(LoadedSystem(system.to_bytes())),
        lambda p: rng.uniform(entries[p]["min"], entries[p]["max"]),
        rng,
    )
    return [[entries[p]["name"] for p in group] for group in result]


def test_what_changes_a_force_at_rest_moves_an_equilibrium() -> None:
    """A stop too, though none is met where the masses hang."""
    at_rest = [f"spring_{k}.{real}" for k in range(2) for real in ("stiffness", "rebound_stiffness")]
    moving = ["spring_0.damping", "spring_1.damping"]
    assert groups_of(hanging(2)) == [[*at_rest, "load"], ["friction"], moving]
    assert len(groups_of(hanging(2, settled=False))) == 2  # a drawing moves with none


@pytest.mark.parametrize("settled", [True, False])
def test_each_parameter_reaches_no_more_than_is_declared(settled: bool) -> None:
    system, rng = mbs.compile(hanging(3, settled)), random.Random(5)
    table = table_of(system)
    reach, entries = probe([system], table), system.meta["parameters"]
    names = [v.name for v in table]
    visited = set()
    for _ in range(5):
        values = {p["name"]: rng.uniform(p["min"], p["max"]) for p in entries}
        base = mbs.Simulation(system, parameters=values).sensors
        for p in entries:
            changed = values | {p["name"]: rng.uniform(p["min"], p["max"])}
            other = mbs.Simulation(system, parameters=changed).sensors
            for output in (name for name in base if base[name] != other[name]):
                assert names.index(p["name"]) in reach.initial[names.index(output)], (p["name"], output)
                visited.add((p["name"], output))
    assert ("load", "mass") in visited
    assert (("spring_0.stiffness", "bob_2.y") in visited) == settled
    number = names.index("spring_0.damping")
    assert number not in reach.initial[names.index("bob_2.y")]
    assert names.index("friction") not in reach.initial[names.index("bob_2.y")]


def test_many_parameters_take_no_more_starts_than_few(monkeypatch: pytest.MonkeyPatch) -> None:
    starts = []

    class Counted(Instance):
        def initialise(self, t0: float = 0.0) -> None:
            starts[-1] += 1
            super().initialise(t0)

    monkeypatch.setattr(module, "Instance", Counted)
    for links in (1, 20):
        system = mbs.compile(hanging(links))
        starts.append(0)
        probe([system], table_of(system))
    assert len(system.meta["parameters"]) == 62
    assert starts[0] == starts[1] < 60
