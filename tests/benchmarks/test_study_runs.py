"""The benchmark of studies at a small size, and its page."""

from pathlib import Path

import pytest

from benchmarks.methods import studies
from benchmarks.shared.figures import rows_of


@pytest.mark.proof
def test_small_sizes_and_their_tables(tmp_path: Path) -> None:
    fmu = studies.spring_fmu(tmp_path)
    runs = studies.study_runs("spring", fmu, 40, 1, 0.2, tmp_path / "runs")
    assert (runs["runs"], runs["failed"], runs["workers"]) == (40, 0, 1)
    # What is not in the runs is overhead: together they are the time of the worker.
    assert 40 * (runs["run, s"] + 1e-3 * runs["overhead, ms/run"]) == pytest.approx(runs["elapsed_s"])
    assert runs["main at most, MB"] >= runs["main before, MB"] > 10.0
    tables = {name: rows_of(text) for name, text in studies.study_blocks([runs | {"case": "car"}, runs]).items()}
    assert set(tables) == {"study overhead", "study memory"}
    assert tables["study overhead"][0]["overhead"] == f"{runs['overhead']:.2%}"
    assert tables["study memory"][0]["bytes/run"] == f"{runs['bytes/run']:.0f}"
