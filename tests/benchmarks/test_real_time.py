"""`python -m benchmarks.real_time`: every step is measured, limits hold, and steps that are repeated are the same."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks import real_time
from benchmarks.car import limited_fall
from benchmarks.car.step_costs import drive
from benchmarks.car.step_replay import Replay
from benchmarks.car.wild_ground import write_ground
from benchmarks.shared.instructions import counter, instructions

H = 2e-3


@pytest.mark.slow
def test_the_rows_say_what_steps_cost_and_the_pictures_are_drawn(prototype_fmu, tmp_path, capsys, monkeypatch):
    for module in ("benchmarks.shared.instructions", "benchmarks.real_time"):
        monkeypatch.setattr(f"{module}.counter", lambda: None)  # counted in another test
    names = [tmp_path / name for name in ("rows.json", "chart.png")]
    chosen = ["--fmu", str(prototype_fmu), "--seconds", "2", "--fidelity", "0"]
    chosen += ["--step", "2", "--step", "10", "--limit", "2"]
    monkeypatch.setattr(real_time, "drive", _without_fidelity)
    assert real_time.main([*chosen, "--json", str(names[0]), "--chart", str(names[1])]) == 0
    rows = json.loads(names[0].read_text(encoding="utf-8"))["rows"]
    assert {row["drive"] for row in rows} == {real_time.WILD}
    assert [(r["step_ms"], r["steps"], r["quarter_us"]) for r in rows] == [(2.0, 1000, 500.0), (10.0, 200, 2500.0)]
    for row in rows:
        assert row["most_iterations"] == 2
        assert row["halvings"] == row["refused"] == 0
        assert 0 < row["capped"] <= row["histogram"][2]
        assert sum(row["histogram"]) == row["steps"]
        assert 0.0 < row["mean_us"] <= row["p99_us"] <= row["worst_us"]
        assert row["instructions"] is None
    assert names[1].read_bytes().startswith(b"\x89PNG")
    assert "valgrind is not installed" in capsys.readouterr().out


def _without_fidelity(fmu, start, *rest):
    """The FMU of this test has one fidelity."""
    return drive(fmu, {name: value for name, value in start.items() if name != "fidelity"}, *rest)


@pytest.mark.slow
def test_a_drive_is_the_same_again_and_its_worst_steps_are_repeated(prototype_fmu, tmp_path):
    targets = write_ground(tmp_path / "wild.road")
    start = {"road.file": str(tmp_path / "wild.road")}
    shares: list[float] = []
    one, two = (drive(prototype_fmu, start, 1.2, targets, H, 2, shares.append) for _ in range(2))
    assert np.array_equal(one.iterations, two.iterations)
    assert one.iterations.min() >= 1
    assert shares[0] == 0.0
    assert one.worst[-1].iterations >= 3
    most = max(one.worst, key=lambda worst: worst.iterations)
    assert most.iterations == one.iterations.max()
    replay = Replay(prototype_fmu, tmp_path / "unpacked")
    assert not replay.time(most, one.kinds, H) <= 0.0


@pytest.mark.slow
@pytest.mark.skipif(counter() is None, reason="valgrind, which counts instructions, is not installed; .ci/run does it")
def test_the_instructions_of_the_worst_steps_are_counted(prototype_fmu, tmp_path):
    targets = write_ground(tmp_path / "wild.road")
    run = drive(prototype_fmu, {"road.file": str(tmp_path / "wild.road")}, 0.4, targets, H, 2, lambda share: None)
    replay = Replay(prototype_fmu, tmp_path / "unpacked")
    ends = [f(run.worst, key=lambda worst: worst.iterations) for f in (min, max)]
    assert all(100_000 < replay.instructions(worst, run.kinds, H) < 20_000_000 for worst in ends)
    worst = max(run.worst, key=lambda worst: worst.steps)
    assert worst.steps > 2
    whole, before = (
        instructions(replay._arguments(replace(worst, steps=n), run.kinds, H, 1), "fmi2DoStep")
        for n in (worst.steps, worst.steps - 1)
    )
    counted = replay.instructions(worst, run.kinds, H)
    assert counted == pytest.approx(whole - before, rel=1e-2)  # a restored road looks for its cells again


def test_limits_that_are_wider_leave_less(prototype_fmu):
    runs = [limited_fall.fall(prototype_fmu, None, H, limit) for limit in (0, 1, 3)]
    assert [run.limit for run in runs] == [0, 1, 3]
    free, narrow, wide = runs
    assert free.capped == 0
    assert narrow.capped > wide.capped
    assert narrow.residual.max() > 100.0 * wide.residual.max()
    apart = [float(np.abs(run.place - free.place).max()) for run in (narrow, wide)]
    # 5.1 times: limits of 2 to 6 leave the same abrupt steps whole, 0.85 mm; that of 20 leaves none
    assert apart[0] > 4.0 * apart[1]
    assert np.array_equal(limited_fall.fall(prototype_fmu, None, H, 20).place, free.place)
    assert apart[0] < 0.01
    assert math.isclose(narrow.balance, free.balance, rel_tol=1.0, abs_tol=1e-3)
    # what is left goes away within the following steps
    last = narrow.residual[-50:]
    assert last.max() < 0.1 * narrow.residual.max()
