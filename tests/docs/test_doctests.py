"""Examples in docstrings print what they say."""

import doctest
import importlib
from pathlib import Path

ROOT = Path(__file__).parents[2]
MODULES = sorted(
    ".".join(path.relative_to(ROOT).with_suffix("").parts)
    for package in ("mbs", "fmu_src", "hosts", "ali3")
    for path in (ROOT / package).rglob("*.py")
    if ">>>" in path.read_text(encoding="utf-8")
)


def test_examples_of_each_module() -> None:
    assert len(MODULES) > 5
    for name in MODULES:
        actual = doctest.testmod(importlib.import_module(name))
        assert (actual.attempted > 0, actual.failed) == (True, 0), name
