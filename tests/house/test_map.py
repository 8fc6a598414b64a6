"""The map in CONTRIBUTING.md names every room, and no other."""

import re

from tests.house.test_import_directions import ROOT

PARENTS = ("ali3", "mbs", "fmu_src", "hosts", "mbs/kernel/src", "viewer")
"""Folders whose folders are rooms."""
ALONE = {"ali3", "benchmarks", "tests", "viewer"}
SOURCES = (".py", ".c", ".h", ".js")
NO_ROOMS = {"bundle"}  # built


def rooms() -> set[str]:
    """Folders with sources."""
    result = set(ALONE)
    for parent in PARENTS:
        for folder in (ROOT / parent).iterdir():
            if folder.is_dir() and folder.name not in NO_ROOMS and not folder.name.startswith(("_", ".")):
                sources = (f for suffix in SOURCES for f in folder.rglob(f"*{suffix}"))
                result |= {f"{parent}/{folder.name}"} if any(sources) else set()
    return result


def test_the_map_is_complete() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `([\w/]+)/` \|", text, re.MULTILINE)) == rooms()
