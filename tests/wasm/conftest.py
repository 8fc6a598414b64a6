"""FMUs with a binary for wasm32 beside that of this machine."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import fmpy
import numpy as np
import pytest

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.build.car_registry import build_car
from fmu_src.build.scene_registry import load_scene
from mbs.elements import GridRoad
from mbs.roads import write_road
from mbs.scenes import prototype_car

# pytest imports this folder's files by path
sys.path.insert(0, str(Path(__file__).parent))
from wasm_hosts import Fmu

SCENES = Path(__file__).parents[1] / "fmu" / "scenes.py"
PLATFORMS = [fmpy.platform, "wasm32"]


def built(tmp: pytest.TempPathFactory, systems: object, name: str, added: dict[str, bytes] | None = None) -> Fmu:
    folder = tmp.mktemp(name)
    return Fmu(build_fmu(systems, name, folder, PLATFORMS, kind="native"), folder / "unpacked", added)


@pytest.fixture(scope="session")
def rough(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A grid with bumps that lies in a few tiles."""
    file = tmp_path_factory.mktemp("road") / "rough.road"
    heights = 0.002 * np.random.default_rng(1).standard_normal((900, 80))
    write_road(GridRoad((-10.0, -4.0), (0.1, 0.1), heights, 0.9), file)
    return file.read_bytes()


@pytest.fixture(scope="session")
def prototype(tmp_path_factory: pytest.TempPathFactory, rough: bytes) -> Fmu:
    """The prototype in its first three fidelities."""
    offered = prototype_car.fidelities()
    systems = {k: mbs.compile(make()) for k, make in offered.items() if k <= 2}
    return built(tmp_path_factory, systems, "prototype_car", {"roads/own.road": rough})


@pytest.fixture(scope="session")
def hatchback(tmp_path_factory: pytest.TempPathFactory) -> Fmu:
    """The hatchback in all its fidelities."""
    return built(tmp_path_factory, build_car("hatchback").systems, "hatchback")


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Fmu]:
    """FMUs of small scenes, built once."""
    made: dict[str, Fmu] = {}

    def make(scene: str) -> Fmu:
        if scene not in made:
            name, system = load_scene(f"{SCENES}:{scene}")
            made[scene] = built(tmp_path_factory, system, name)
        return made[scene]

    return make
