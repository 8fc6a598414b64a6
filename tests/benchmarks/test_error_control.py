"""The table of runs to a tolerance, in its reduced form, and what it calls a miss."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks import work_precision
from benchmarks.methods.error_control import MOST_ERROR, compare, misses


@pytest.mark.slow
def test_the_table_holds_every_method_and_the_choice(tmp_path: Path) -> None:
    file = tmp_path / "e.json"
    assert work_precision.main(["control", "--quick", "--only", "spatial_slider_crank", "--json", str(file)]) == 0
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"]
    methods = [r["method"] for r in rows]
    assert methods[:3] == ["ali3p", "radau_5", "runge_kutta_8"]
    assert methods[3] == "auto: runge_kutta_8"
    for row in rows:
        assert row["ended"] == "finished"
        assert row["error_over_tolerance"] < MOST_ERROR
        assert 0.0 < row["estimate_over_tolerance"] < 1.5
    assert rows[0]["steps"] > 20 * rows[2]["steps"]


def row(method: str, cpu: float, error: float, warned: str = "") -> dict[str, object]:
    found = {"method": method, "cpu_ms": cpu, "error_over_tolerance": error, "warned": warned}
    return {"ratio": None, "ended": "finished"} | found


def test_misses_are_dear_choices_and_silent_errors() -> None:
    rows = [row("radau_5", 1.0, 30.0), row("ali3p", 2.0, 1.0), row("auto: ali3p", 3.0, 1.0)]
    compare(rows)
    assert [r["ratio"] for r in rows] == [0.5, 1.0, 1.5]  # the wrong one is no yardstick
    assert misses(rows) == rows[:1]
    rows = [row("radau_5", 1.0, 30.0, "yes"), row("ali3p", 2.0, 1.0), row("auto: ali3p", 5.0, 1.0)]
    compare(rows)
    assert misses(rows) == rows[2:]
