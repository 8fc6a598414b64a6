"""FMUs for these tests."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # for what the tests share


@pytest.fixture(scope="session")
def tuned(scene_fmu: Callable[..., Path]) -> Path:
    return scene_fmu(f"{HERE.parent / 'scenes.py'}:tuned")
