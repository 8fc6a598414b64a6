"""`python -m benchmarks.cost real-time`: every step is measured, and limits hold."""

import json

import numpy as np
import pytest

from benchmarks import cost
from benchmarks.car import real_time
from benchmarks.car.real_time import write_ground
from benchmarks.car.step_costs import drive
from benchmarks.shared.figures import rows_of

H = 2e-3


@pytest.mark.slow
def test_the_rows_have_the_costs_of_steps(prototype_fmu, tmp_path, monkeypatch):
    file = tmp_path / "rows.json"
    chosen = ["--fmu", str(prototype_fmu), "--seconds", "2", "--fidelity", "0", "--step", "2", "10", "--limit", "2"]
    monkeypatch.setattr(real_time, "drive", _without_fidelity)
    assert cost.main(["real-time", *chosen, "--json", str(file)]) == 0
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"]
    assert [(r["step_ms"], r["steps"], r["quarter_us"]) for r in rows] == [(2.0, 1000, 500.0), (10.0, 200, 2500.0)]
    for row in rows:
        assert row["most_iterations"] == 2
        assert row["halvings"] == row["refused"] == 0
        assert 0 < row["capped"] <= row["steps"]
        assert 1.0 <= row["iterations"] <= 2.0
        assert 0.0 < row["mean_us"] <= row["p99_9_us"] <= row["worst_us"]
    (limited,) = rows_of(real_time.real_time_blocks(rows)["wild limits"])
    assert limited["capped steps"] == f"{rows[0]['capped']} of 1000"
    (free,) = rows_of(real_time.real_time_blocks([rows[1] | {"limit": 0}])["wild steps"])
    assert (free["step, ms"], free["quarter of the deadline, us"]) == ("10", "2500")


def _without_fidelity(fmu, start, *rest):
    """The FMU of this test has one fidelity."""
    return drive(fmu, {name: value for name, value in start.items() if name != "fidelity"}, *rest)


@pytest.mark.slow
def test_a_drive_is_the_same_again(prototype_fmu, tmp_path):
    targets = write_ground(tmp_path / "wild.road")
    start = {"road.file": str(tmp_path / "wild.road")}
    shares: list[float] = []
    one, two = (drive(prototype_fmu, start, 1.2, targets, H, 2, shares.append) for _ in range(2))
    assert np.array_equal(one.iterations, two.iterations)
    assert one.iterations.min() >= 1
    assert one.iterations.max() >= 3
    assert shares[0] == 0.0
