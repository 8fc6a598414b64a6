"""Instances do not see each other; neither do FMUs in one process."""

import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.fmu.calls import OK, HostMaker


def test_two_interleaved_instances(crane: Path, host: HostMaker) -> None:
    alone = [host(crane).start({"torque": u}).run(40, 0.01) for u in (2.0, -6.0)]
    pair = [host(crane).start({"torque": u}) for u in (2.0, -6.0)]
    rows: list[list[list[float]]] = [[], []]
    for k in range(40):
        for h, r in zip(pair, rows, strict=True):
            r += h.run(1, 0.01, 0.01 * k)
    assert rows == alone
    assert alone[0] != alone[1]


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


def test_many_lives_of_one_instance(crane: Path, host: HostMaker) -> None:
    driven = host(crane)
    expected = driven.start().run(5, 0.01)
    for _ in range(50):
        driven.free(driven.slave)
        driven.slave = driven.instance()
        assert driven.start().run(5, 0.01) == expected


def test_the_path_of_the_hosts_python_stays_as_it_was(crane: Path, host: HostMaker) -> None:
    before = list(sys.path)
    first = host(crane)
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


@pytest.mark.parametrize("name", ["with space", "ü", "a#b", "a+b&c", "(x),y", "100%"])
def test_any_folder_name(crane: Path, host: HostMaker, tmp_path: Path, name: str) -> None:
    folder = tmp_path / name
    assert host(crane, folder).start().step(0.0, 0.01) == OK
    shutil.rmtree(folder)
