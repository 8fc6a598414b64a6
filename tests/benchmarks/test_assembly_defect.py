"""The command of the four-bar with assembly defect writes the rows it promises, a table and a chart."""

import json

import pytest
from matplotlib import image

from benchmarks.paper import __main__ as paper

GOAL = 0.03  # of the largest moment


@pytest.mark.slow
def test_quick_run(tmp_path, capsys):
    file, chart = tmp_path / "rows.json", tmp_path / "chart.png"
    assert paper.main(["defect", "--quick", "--json", str(file), "--chart", str(chart)]) == 0
    printed = capsys.readouterr().out
    assert "| 1 | 2, 12 | " in printed
    assert "diameter_mm" in printed
    row, thick, thin = json.loads(file.read_text(encoding="utf-8"))["rows"]
    assert thick["Mz"] > thin["Mz"] > 0.0
    assert row["largest_of_moment"] < GOAL
    assert image.imread(chart).std() > 0.05
