"""The FMU of the prototype."""

from __future__ import annotations

from pathlib import Path

import fmpy
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene


@pytest.fixture(scope="session")
def prototype_fmu(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of this platform, built once for all tests that drive it."""
    folder = shared / "prototype_fmu"
    folder.mkdir(exist_ok=True)
    if not list(folder.glob("*.fmu")):
        name, system = load_scene("prototype_car")
        made = build_fmu(system, name, tmp_path_factory.mktemp("prototype"), [fmpy.platform])
        made.replace(folder / made.name)  # whole at once: other processes look for it too
    (path,) = folder.glob("*.fmu")
    return path
