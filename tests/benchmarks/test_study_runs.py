"""The benchmark of studies at a small size, and its page."""

from pathlib import Path

import pytest

from benchmarks.methods import studies
from benchmarks.methods.study_pages import study_blocks
from benchmarks.shared.figures import rows_of


@pytest.mark.proof
def test_small_sizes_and_their_tables(tmp_path: Path) -> None:
    fmu = studies.spring_fmu(tmp_path)
    runs = studies.study_runs("spring", fmu, 40, 1, 0.2, tmp_path / "runs")
    again = studies.start_again("spring", 40, tmp_path / "runs")
    written = studies.measure_writer("spring", fmu, 1000, tmp_path / "rows")
    plan = studies.measure_plan("spring", fmu, 2000, "sobol", tmp_path / "plan")
    assert (runs["runs"], runs["failed"], runs["workers"]) == (40, 0, 1)
    # What is not in the runs is overhead: together they are the time of the worker.
    assert 40 * (runs["run, s"] + 1e-3 * runs["overhead, ms/run"]) == pytest.approx(runs["elapsed_s"])
    assert runs["main at most, MB"] >= runs["main before, MB"] > 10.0
    assert again["start_s"] > 0.1
    assert 20.0 < written["bytes"] < 500.0
    tasks = {"table": "empty tasks", "runs": 100, "workers": 1, "elapsed_s": 0.1, "task_ms": 1.0, "main_ms": 0.5}
    rows = [runs | {"case": "car", "overhead": 0.02}, runs, again, written | {"main_ms": 0.01}, plan, tasks]
    tables = {name: rows_of(text) for name, text in study_blocks(rows).items()}
    assert set(tables) == {"study overhead", "study memory", "study single"}
    assert tables["study overhead"][0]["overhead"] == "2.00%"
    assert tables["study memory"][0]["start again, s"] == f"{again['start_s']:.1f}"
    single = {row["what"]: row for row in tables["study single"]}
    assert single["rows written"]["in all, s"] == "0.01"  # 1000 of 0.01 ms
    assert single["empty tasks, client and scheduler"]["ms each"] == "0.5000"
