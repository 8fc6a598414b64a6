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
from fmu_src.build.scene_registry import load_scene
from mbs.elements import GridRoad
from mbs.roads import write_road
from mbs.vehicle import load

# pytest imports this folder's files by path
sys.path.insert(0, str(Path(__file__).parent))
from wasm_hosts import Fmu

SCENES = Path(__file__).parents[1] / "fmu" / "scenes.py"
PLATFORMS = [fmpy.platform, "wasm32"]
Built = Callable[..., Fmu]


@pytest.fixture(scope="session")
def built(made_once: Callable[[str, Callable[[Path], None]], Path], tmp_path_factory: pytest.TempPathFactory) -> Built:
    """Builds the FMU of what a function gives, name and Systems, once for all processes."""

    def make(named: str, systems: Callable[[], tuple[str, object]], added: dict[str, bytes] | None = None) -> Fmu:
        def fill(folder: Path) -> None:
            name, built_systems = systems()
            build_fmu(built_systems, name, folder, PLATFORMS)

        (path,) = made_once(f"wasm_{named}", fill).glob("*.fmu")
        return Fmu(path, tmp_path_factory.mktemp(named) / "unpacked", added)

    return make


@pytest.fixture(scope="session")
def rough(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A grid with bumps that lies in a few tiles."""
    file = tmp_path_factory.mktemp("road") / "rough.road"
    heights = 0.002 * np.random.default_rng(1).standard_normal((900, 80))
    write_road(GridRoad((-10.0, -4.0), (0.1, 0.1), heights, 0.9), file)
    return file.read_bytes()


@pytest.fixture(scope="session")
def prototype(built: Built, rough: bytes) -> Fmu:
    """The prototype in its first three fidelities."""

    def systems() -> tuple[str, object]:
        return "prototype_car", [mbs.compile(load("prototype").model(fidelity=k)) for k in range(3)]

    return built("prototype", systems, {"roads/own.road": rough})


@pytest.fixture(scope="session")
def small(built: Built) -> Callable[[str], Fmu]:
    """FMUs of small scenes, built once."""
    results: dict[str, Fmu] = {}

    def make(scene: str) -> Fmu:
        if scene not in results:
            results[scene] = built(scene, lambda: load_scene(f"{SCENES}:{scene}"))
        return results[scene]

    return make
