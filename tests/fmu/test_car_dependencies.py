"""The car's declared dependencies hold against its derivatives, also where a wheel stands at a kerb, and against what
setting an input changes at a communication point.
"""

import random
from collections.abc import Callable
from typing import Any

import pytest

from mbs.vehicle.read_car import CARS
from tests.fmu.calls import OK, WARNING
from tests.in_process import build_fmu
from tests.quick import quick

H = 0.002  # s
SEED = 5
UNDERIVED = ("step_size", "fidelity", "initial.settling")


def declared(unknowns: list[Any], every: list[str] | None = None) -> dict[str, set[str]]:
    """Of an unknown without dependencies they are `every` one."""
    return {
        u.variable.name: set(every or ()) if u.dependencies is None else {v.name for v in u.dependencies}
        for u in unknowns
    }


def slopes(driven: Any, names: list[str], known: str) -> dict[str, float]:
    references = [driven.references[n] for n in names]
    result = driven.slave.getDirectionalDerivative(references, [driven.references[known]], [1.0])
    return dict(zip(names, result, strict=True))


def test_initial_derivatives(prototype_fmu, host):
    driven = host(prototype_fmu)
    outputs = [v.name for v in driven.description.modelVariables if v.causality == "output" and v.type == "Real"]
    variables = driven.description.modelVariables
    settable = [v.name for v in variables if v.causality in ("input", "parameter") and v.type == "Real"]
    reach = declared(driven.description.initialUnknowns, settable)
    driven.slave.setupExperiment()
    driven.slave.enterInitializationMode()
    for name, value in (("road.kerb_x", 0.0), ("initial.speed", 8.0), ("initial.yaw", 0.1), ("throttle", 0.3)):
        assert driven.set(name, value) == 0
    visited = set()
    for known in (n for n in settable if n not in UNDERIVED):
        moved = {n for n, slope in slopes(driven, outputs, known).items() if slope != 0.0}
        assert moved <= {n for n in outputs if known in reach[n]}, known
        visited |= {(known, n) for n in moved}
    assert len(visited) > 250
    assert ("initial.x", "wheel_FR.Fz") in visited
    # While a start settles all that is set reaches what moves; it does not reach what only repeats an input.
    assert {n for n, known in reach.items() if known != set(settable)} >= {"used.brake", "solver.status"}


PORTS = (
    ("hatchback", "torque=half_shafts,brakes=torque,steering=rack_position,road,forces=earth,wind"),
    ("hatchback", "torque=hub_motors,brakes=pressure,forces=vehicle,tyre"),
    ("saloon", "gear,clutch"),
    ("ferrari_250_lm", "steering=rack_force"),
)
DRIVEN = [
    (*of, kind)
    for of in (*((p.name, "") for p in sorted(CARS.iterdir()) if p.is_dir()), *PORTS)
    for kind in ("native", "fmi3_scalar")
]
DRIVEN_FEW = [*((*of, "fmi3_scalar") for of in PORTS[:3]), ("prototype", "", "native")]
STATES = 100


def numbers(driven: Any) -> Callable[[], list[float]]:
    """Reads all outputs that are numbers."""
    kinds_of = ("Real", "Float64"), ("Integer", "Int32")
    variables = [v for v in driven.description.modelVariables if v.causality == "output"]
    reals, wholes = ([v.valueReference for v in variables if v.type in kind] for kind in kinds_of)
    return lambda: [*driven.slave.getReal(reals), *driven.slave.getInteger(wholes)]


def nudged(driven: Any, states: int, steps: int) -> set[str]:
    """Outputs that an input changes before the next step, in states by chance; also where they are found anew."""
    variables = {v.name: v for v in driven.description.modelVariables}
    inputs = [v for v in variables.values() if v.causality == "input"]
    outputs = [v.name for v in variables.values() if v.causality == "output" and v.type in ("Real", "Float64")]
    outputs += [v.name for v in variables.values() if v.causality == "output" and v.type in ("Integer", "Int32")]
    read, rng, moved, time = numbers(driven), random.Random(SEED), set[str](), 0.0

    def put(v: Any, share: float) -> None:
        start = float(v.start or 0.0)
        low, high = (
            float(end) if end and abs(float(end)) < 1e6 else start + side for end, side in ((v.min, -1.0), (v.max, 1.0))
        )
        value = start + share * (rng.uniform(low, high) - start)
        whole = v.type in ("Integer", "Int32")
        setter = driven.slave.setInteger if whole else driven.slave.setReal
        setter([v.valueReference], [round(value) if whole else value])

    for state in range(states):
        for v in inputs:
            put(v, 0.02)
        for _ in range(rng.randrange(1, steps)):
            assert driven.whole_status(time, H) in (OK, WARNING)
            time += H
        before = read()
        for v in inputs:
            put(v, 1.0)
            if state % 2:  # what is read is then computed again
                again = driven.slave.getFMUstate()
                driven.slave.setFMUstate(again)
                driven.slave.freeFMUstate(again)
            moved |= {n for n, one, other in zip(outputs, before, read(), strict=True) if one != other}
        for v in inputs:  # the state goes on from where its drive was
            put(v, 0.02)
    return moved


def held_against(driven: Any, states: int, start: dict[str, float], steps: int = 4) -> None:
    """What moves is declared, and what is declared moves."""
    depends = {n for n, known in declared(driven.description.outputs).items() if known}
    assert depends == nudged(driven.start(start), states, steps)


@pytest.mark.parametrize(("scene", "kind"), [("crane", "fmi3"), ("towed", "native"), ("gearstick", "native")])
def test_what_an_input_changes_at_a_communication_point_is_declared(build, host, scene, kind):
    held_against(host(build(scene, kind)), STATES // 2, {})


@pytest.mark.slow
@pytest.mark.parametrize(("car", "ports", "kind"), quick(DRIVEN_FEW, DRIVEN, "proof"))
def test_what_an_input_of_a_car_changes_is_declared(host, tmp_path, car, ports, kind):
    options = ("--car", car, "--fidelity", "0", "--kind", kind, *(("--ports", ports) if ports else ()))
    driven = host(build_fmu(tmp_path, *options))
    held_against(driven, STATES, {"initial.speed": 10.0})
