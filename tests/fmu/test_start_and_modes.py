"""An FMU starts in the equilibrium of its parameters, and its status tells that a closed loop changed its mode."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import pytest

import mbs
from fmu_src.build.build import build_fmu
from mbs.kernel.binding import Status
from tests import kinds
from tests.fmu.calls import OK, WARNING, HostMaker
from tests.simulation.loops import suspension
from tests.simulation.scenes_in_equilibrium import MASS, STIFFNESS, hanging

G, STEP = 9.81, 0.01


@pytest.fixture(scope="session")
def hung(tmp_path_factory: pytest.TempPathFactory, need: Callable[[str], None]) -> dict[str, Path]:
    system, folder = mbs.compile(hanging()), tmp_path_factory.mktemp("hung")
    need("python")
    return {kind: build_fmu(system, "hung", folder, [fmpy.platform], kind=kind) for kind in kinds.ALIKE}


@pytest.fixture(scope="session")
def thrown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    m = suspension(15.0)
    m.sense_solver("solver.status", "status")
    m.stop_time, m.step = 0.05, 5e-4
    return build_fmu(mbs.compile(m), "thrown", tmp_path_factory.mktemp("thrown"), [fmpy.platform], kind="native")


def status(host: Any) -> int:
    """Of the solver, whichever type the variable has."""
    variable = next(v for v in host.description.modelVariables if v.name == "solver.status")
    read = host.slave.getReal if variable.type == "Real" else host.slave.getInteger
    return int(read([variable.valueReference])[0])


def test_parameters_set_before_the_start_move_the_equilibrium(
    hung: dict[str, Path], kind: str, host: HostMaker
) -> None:
    fmu = host(hung[kind]).start({"k": 500.0, "payload": 7.0})
    assert fmu.get("z") == pytest.approx(-1.0 - (MASS * G + 7.0) / 500.0, abs=1e-9)
    fmu.run(5, STEP)
    assert fmu.get("z") == pytest.approx(-1.0 - (MASS * G + 7.0) / 500.0, abs=1e-8)


def test_parameters_tuned_in_motion_move_nothing(hung: dict[str, Path], kind: str, host: HostMaker) -> None:
    fmu = host(hung[kind]).start()
    start = -1.0 - MASS * G / STIFFNESS
    assert fmu.get("z") == pytest.approx(start, abs=1e-9)
    fmu.set("k", 500.0)
    assert fmu.get("z") == pytest.approx(start, abs=1e-9)
    fmu.run(5, STEP)
    assert fmu.get("z") < start - 1e-3


def test_no_equilibrium_is_refused_with_a_sentence(hung: dict[str, Path], kind: str, host: HostMaker) -> None:
    fmu = host(hung[kind])
    fmu.slave.setupExperiment(startTime=0.0)
    assert fmu.set("k", 0.0) == OK
    fmu.call("enterInitializationMode")
    assert fmu.call("exitInitializationMode") > WARNING
    assert any("no static equilibrium near the drawing" in message for message in fmu.messages)


def test_the_status_tells_a_changed_assembly_mode(thrown: Path, host: HostMaker) -> None:
    fmu = host(thrown).start()
    seen = []
    for k in range(30):
        assert fmu.step(k * 0.005, 0.005) in (OK, WARNING)
        seen.append(status(fmu))
    assert set(seen[:17]) == {0}
    assert set(seen[19:]) == {Status.BRANCH_CHANGED}
