"""Examples in docstrings print what they say."""

import doctest
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES = sorted(
    ".".join(path.relative_to(ROOT).with_suffix("").parts)
    for package in ("mbs", "fmu_src", "hosts", "ali3")
    for path in (ROOT / package).rglob("*.py")
    if ">>>" in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_a_module(name: str) -> None:
    actual = doctest.testmod(importlib.import_module(name))
    assert actual.attempted > 0
    assert actual.failed == 0


def test_there_are_some() -> None:
    assert {"mbs.common.affine", "mbs.compiler.elimination", "mbs.model.model", "fmu_src.variables.units"} <= set(
        MODULES
    )
