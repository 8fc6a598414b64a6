"""Instances do not see each other; neither do FMUs in one process."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests import kinds
from tests.fmu.calls import OK, HostMaker

OF_ALL_KINDS = pytest.mark.parametrize("kind", [*kinds.FACES, "python"])
"""Two kinds share nothing but the slave in C; in Python all instances share an interpreter."""


@OF_ALL_KINDS
def test_thirty_instances(crane: Path, host: HostMaker) -> None:
    first = host(crane)
    slaves = [first.instance() for _ in range(30)]
    outputs = [r for n, r in first.references.items() if n.startswith("rod.")]
    for k, slave in enumerate(slaves):
        slave.setupExperiment()
        slave.setReal([first.references["torque"]], [float(k)])
        slave.enterInitializationMode()
        slave.exitInitializationMode()
    for k in range(20):
        for slave in slaves:
            slave.doStep(0.01 * k, 0.01)
    values = [tuple(slave.getReal(outputs)) for slave in slaves]
    assert len(set(values)) == 30
    for slave in slaves:
        first.free(slave)
    assert host(crane).start({"torque": 7.0}).run(20, 0.01)[-1][: len(outputs)] == list(values[7])


@OF_ALL_KINDS
def test_many_lives_of_one_instance(crane: Path, host: HostMaker) -> None:
    driven = host(crane)
    expected = driven.start().run(5, 0.01)
    for _ in range(15):
        driven.free(driven.slave)
        driven.slave = driven.instance()
        assert driven.start().run(5, 0.01) == expected


def test_the_path_of_the_hosts_python_stays_as_it_was(build: Callable[..., Path], host: HostMaker) -> None:
    before = list(sys.path)
    first = host(build("crane", "python"))
    first.instance()
    assert first.start().step(0.0, 0.01) == OK
    assert sys.path == before


def test_two_builds_of_a_scene_in_one_process(build: Callable[..., Path], host: HostMaker) -> None:
    light, heavy = (host(build(s)).start({"torque": 3.0}) for s in ("crane", "heavy_crane"))
    first, second = light.run(50, 0.01), heavy.run(50, 0.01)
    assert not np.allclose(first, second)
    assert heavy.description.guid != light.description.guid


def test_reset_restores_the_start(crane: Path, host: HostMaker) -> None:
    driven = host(crane)
    expected = driven.start().run(10, 0.01)
    driven.set("torque", 11.0)
    driven.set("spring.stiffness", 30.0)
    driven.run(10, 0.01, 0.1)
    driven.slave.reset()
    driven.slave.setupExperiment()
    driven.slave.enterInitializationMode()
    assert driven.get("torque") == 0.0
    assert driven.get("spring.stiffness") == 5.0
    driven.slave.exitInitializationMode()
    assert driven.run(10, 0.01) == expected


@OF_ALL_KINDS
def test_any_folder_name(crane: Path, host: HostMaker, tmp_path: Path) -> None:
    for name in ("with space", "ü", "a#b", "a+b&c", "(x),y", "100%"):
        assert host(crane, tmp_path / name).start().step(0.0, 0.01) == OK, name
