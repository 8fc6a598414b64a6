"""The benchmark of studies at a small size, and its page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from benchmarks.methods import studies
from benchmarks.methods.study_pages import parts_of, study_blocks


@pytest.mark.slow
def test_small_sizes_and_their_tables(tmp_path: Path) -> None:
    fmu = studies.spring_fmu(tmp_path)
    runs = studies.study_runs("spring", fmu, 40, 1, 0.2, tmp_path / "runs")
    again = studies.start_again("spring", fmu, 40, 0.2, tmp_path / "runs")
    written = studies.rows_written("spring", fmu, 1000, tmp_path / "rows")
    plan = studies.plan_alone("spring", fmu, 2000, "sobol", tmp_path / "plan")
    assert (runs["runs"], runs["failed"], runs["workers"]) == (40, 0, 1)
    # What is not in the runs is overhead: together they are the time of the worker.
    assert 40 * (runs["run_s"] + 1e-3 * runs["overhead_ms"]) == pytest.approx(runs["elapsed_s"])
    assert runs["main_mb"] >= runs["before_mb"] > 10.0
    assert again["start_s"] > 0.1
    assert 20.0 < written["bytes"] < 500.0
    tasks: dict[str, Any] = {
        "table": "empty tasks",
        "runs": 100,
        "workers": 1,
        "elapsed_s": 0.1,
        "task_ms": 1.0,
        "main_ms": 0.5,
    }
    car = runs | {"case": "car", "run_s": 0.1, "overhead": 0.02}
    small, large = runs | {"main_mb": 200.0}, runs | {"runs": 1040, "main_mb": 201.0}
    rows = [car, small, large, again, written | {"main_ms": 0.01}, plan | {"main_mb": 0.0}, tasks]
    blocks = study_blocks(rows)
    assert set(blocks) == {"study overhead", "study memory", "study single", "study scale"}
    scale = blocks["study scale"]
    assert "| 1,000,000 × 0.1 s / 1,000, and 2.0% | 102 s |" in scale
    assert "| 500 per s × 0.50 ms | 25% of a core |" in scale
    assert "| 0.1 s / 0.0100 ms | 10,000 |" in scale
    # A thousand bytes a run: 1 MB in 1000 runs.
    assert f"| {runs['before_mb']:.0f} MB + 1,000,000 × (1000 B + 0 B of the plan) |" in scale


def test_parts_of_a_study_by_its_time() -> None:
    """Every 2 s up to 100 s; where 50 000 rows come sooner, as often as they do."""
    assert parts_of(100.0, 100.0) == 50
    assert parts_of(100.0, 50_000.0) == 100
    assert 50 + 60 < parts_of(3600.0, 100.0) < 50 + 200
