"""The table of runs to a tolerance, in its reduced form, and what it calls a miss."""

import json
from pathlib import Path

import pytest

from benchmarks import work_precision
from benchmarks.methods.error_control import MAX_ERROR, compare, control_blocks
from benchmarks.shared.figures import rows_of


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
        assert row["error_over_tolerance"] < MAX_ERROR
        assert 0.0 < row["estimate_over_tolerance"] < 1.5
    assert rows[0]["steps"] > 20 * rows[2]["steps"]


def row(method: str, cpu: float, error: float, warned: str = "") -> dict[str, object]:
    results = {"method": method, "cpu_ms": cpu, "error_over_tolerance": error, "warned": warned}
    return {"scene": "s", "tolerance": 1e-3, "ratio": None} | results


@pytest.mark.parametrize(
    ("chosen", "miss"),
    [((3.0, 1.0), ""), ((5.0, 1.0), "slow"), ((3.0, 30.0), "wrong"), ((3.0, 30.0, "yes"), "wrong, warned")],
)
def test_misses_are_dear_choices_and_wrong_ones(chosen: tuple[object, ...], miss: str) -> None:
    rows = [row("radau_5", 1.0, 30.0), row("ali3p", 2.0, 1.0), row("auto: ali3p", *chosen)]
    compare(rows)
    assert [r["ratio"] for r in rows[:2]] == [0.5, 1.0]  # the wrong one is no yardstick
    (line,) = rows_of(control_blocks(rows)["control"])
    assert (line["chosen"], line["best"], line["miss"]) == ("ali3p", "ali3p", miss)
