"""FMUs for these tests."""

from __future__ import annotations

import sys
from pathlib import Path

import fmpy
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # for what the tests share


@pytest.fixture(scope="session")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    name, system = load_scene(f"{HERE.parent / 'scenes.py'}:tuned")
    return build_fmu(system, name, tmp_path_factory.mktemp("tuned"), [fmpy.platform])
