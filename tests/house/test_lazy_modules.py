"""Packages of the engine are attributes of `mbs`, and importing `mbs` loads none of them."""

from __future__ import annotations

import subprocess
import sys

import pytest

PATHS = (
    "vehicle.load",
    "vehicle.json_schema",
    "vehicle.kinematics.read_curve",
    "elements.ScalarSpringDamper",
    "flexible.craig_bampton",
    "flexible.scene_part.flexible_parts",
    "shapes.pose_outputs.pose_outputs",
    "roads.read_road",
)


def ran(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("path", PATHS)
def test_paths_of_the_documents_need_one_import(path: str) -> None:
    done = ran(f"import mbs; assert callable(mbs.{path})")
    assert done.returncode == 0, done.stderr


def test_what_is_not_there_is_an_attribute_error() -> None:
    done = ran("import mbs; mbs.vehicles")
    assert done.stderr.endswith("AttributeError: module 'mbs' has no attribute 'vehicles'\n")


def test_importing_loads_none_of_them() -> None:
    code = "import sys, mbs; print(*(n for n in sys.modules if n in ('mbs.vehicle', 'mbs.scenes')))"
    assert ran(code).stdout.split() == []
