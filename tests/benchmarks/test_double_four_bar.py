"""The command of the double four-bar writes the rows it promises, a table and a chart."""

import json

import pytest
from matplotlib import image

from benchmarks.paper import __main__ as paper
from benchmarks.paper.double_four_bar import METHODS

KEYS = {
    "method",
    "N",
    "h_s",
    "energy_deviation_J",
    "position_error_m",
    "iterations_mean",
    "iterations_max",
    "wall_s",
}


@pytest.mark.slow
def test_quick_run(tmp_path, capsys):
    file, chart = tmp_path / "rows.json", tmp_path / "chart.png"
    assert paper.main(["four-bar", "--quick", "--repeats", "1", "--json", str(file), "--chart", str(chart)]) == 0
    printed = capsys.readouterr().out
    assert "paper dE J" in printed
    written = json.loads(file.read_text(encoding="utf-8"))
    assert {"benchmark", "time", "machine", "settings", "quick"} <= set(written["meta"])
    rows = written["rows"]
    assert {(r["N"], r["method"]) for r in rows} == {(2, m) for m in METHODS}
    for row in rows:
        assert (row["wall_s"] is None) == (row["failed_at_s"] is not None)
        assert set(row) >= (KEYS if row["wall_s"] else set())
    row = next(r for r in rows if r["h_s"] == 0.01 and r["method"] == "ALi3-P")
    assert row["energy_deviation_J"] < 0.1
    assert len({tuple(p) for p in image.imread(chart).reshape(-1, 4)}) > 20
