"""The car's declared dependencies hold against its derivatives, also where a wheel stands at a kerb."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from tests.fmu.calls import HostMaker

H, SEED = 0.002, 5
UNDERIVED = ("step_size", "fidelity", "initial.settling")


def declared(unknowns: list[Any], every: list[str] | None = None) -> dict[str, set[str]]:
    """Of an unknown without dependencies they are `every` one."""
    return {
        u.variable.name: set(every or ()) if u.dependencies is None else {v.name for v in u.dependencies}
        for u in unknowns
    }


def slopes(driven: Any, names: list[str], known: str) -> dict[str, float]:
    references = [driven.references[n] for n in names]
    found = driven.slave.getDirectionalDerivative(references, [driven.references[known]], [1.0])
    return dict(zip(names, found, strict=True))


@pytest.mark.parametrize("kerb", [1e6, 0.0])
def test_initial_derivatives(prototype_fmu: Path, host: HostMaker, kerb: float) -> None:
    driven = host(prototype_fmu)
    outputs = [v.name for v in driven.description.modelVariables if v.causality == "output" and v.type == "Real"]
    variables = driven.description.modelVariables
    settable = [v.name for v in variables if v.causality in ("input", "parameter") and v.type == "Real"]
    reach = declared(driven.description.initialUnknowns, settable)
    driven.slave.setupExperiment()
    driven.slave.enterInitializationMode()
    for name, value in (("road.kerb_x", kerb), ("initial.speed", 8.0), ("initial.yaw", 0.1), ("throttle", 0.3)):
        assert driven.set(name, value) == 0
    seen = set()
    for known in (n for n in settable if n not in UNDERIVED):
        moved = {n for n, slope in slopes(driven, outputs, known).items() if slope != 0.0}
        assert moved <= {n for n in outputs if known in reach[n]}, known
        seen |= {(known, n) for n in moved}
    assert len(seen) > 250
    if kerb == 0.0:
        assert ("initial.x", "wheel_FR.Fz") in seen
    # While a start settles all that is set reaches what moves; it does not reach what only repeats an input.
    assert {n for n, known in reach.items() if known != set(settable)} >= {"used.brake", "solver.status"}


def test_derivatives_of_a_step(prototype_fmu: Path, host: HostMaker) -> None:
    driven = host(prototype_fmu).start({"initial.speed": 10.0})
    reach = declared(driven.description.outputs)
    outputs = [v.name for v in driven.description.modelVariables if v.causality == "output" and v.type == "Real"]
    rng, refused = random.Random(SEED), 0
    for k in range(60):
        for name, low in (("steering", -1.0), ("throttle", 0.0), ("brake", 0.0)):
            driven.set(name, rng.uniform(low, 1.0))
        assert driven.step(k * H, H) == 0
        for known in ("steering", "throttle", "brake"):
            try:
                moved = {n for n, slope in slopes(driven, outputs, known).items() if slope != 0.0}
            except FMICallException:  # across a kink, such as that of a drive that begins to push
                refused += 1
                continue
            assert moved <= {n for n in outputs if known in reach[n]}, known
    assert refused < 90
    assert len(moved) > 80
    assert reach["used.brake"] == {"brake"}
    assert np.isfinite(driven.get("solver.energy_balance"))
