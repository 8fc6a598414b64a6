"""The native FMU in libcosim (OSP), a co-simulation library that is no Python program."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import pytest

HostMaker = Callable[..., Any]
STEPS, STEP_NS = 50, 10_000_000


@pytest.mark.skipif(importlib.util.find_spec("libcosimpy") is None, reason="libcosimpy is not installed")
def test_libcosim_gets_the_same_bits(build: Callable[..., Path], host: HostMaker) -> None:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    fmu = build("crane", "native")
    references = {v.name: v.valueReference for v in fmpy.read_model_description(str(fmu)).modelVariables}
    execution = CosimExecution.from_step_size(STEP_NS)
    index = execution.add_local_slave(CosimLocalSlave(str(fmu), "crane"))
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    execution.add_observer(observer)
    execution.add_manipulator(manipulator)
    manipulator.slave_real_values(index, [references["torque"]], [4.0])
    names = ["rod.x", "rod.ay", "rod.angle"]
    assert execution.step(STEPS)
    found = list(observer.last_real_values(index, [references[n] for n in names]))
    driven = host(fmu).start()
    driven.set("torque", 4.0)  # libcosim sets it after initialisation
    driven.run(STEPS, STEP_NS * 1e-9)
    assert found == [driven.get(n) for n in names]
