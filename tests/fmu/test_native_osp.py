"""The native FMU in libcosim (OSP), a co-simulation library that is no Python program."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.fmu.calls import HostMaker
from tests.fmu.libcosim import by_libcosim

STEPS, STEP = 50, 0.01


@pytest.mark.skipif(importlib.util.find_spec("libcosimpy") is None, reason="libcosimpy is not installed")
def test_libcosim_gets_the_same_bits(build: Callable[..., Path], host: HostMaker) -> None:
    fmu = build("crane", "native")
    names = ["rod.x", "rod.ay", "rod.angle"]
    found = by_libcosim(fmu, {"torque": 4.0}, names, STEPS, STEP)
    driven = host(fmu).start()
    driven.set("torque", 4.0)  # libcosim sets it after initialisation
    driven.run(STEPS, STEP)
    assert found == [driven.get(n) for n in names]
