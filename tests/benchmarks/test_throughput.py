"""`python -m benchmarks.throughput`: all ways make the same steps, from which follows what a thousand cars take."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest

from benchmarks import throughput
from benchmarks.car import lanes
from benchmarks.car.older_cars import older_cars
from mbs.kernel.binding.many import widest_lanes


@pytest.mark.slow
def test_ways_and_the_thousand_cars(tmp_path, capsys, monkeypatch):
    names = ("slalom", "double four-bar", "flexible four-bar")
    monkeypatch.setattr(throughput, "SCENES", tuple(scene for scene in throughput.SCENES if scene[0] in names))
    monkeypatch.setattr(lanes, "PARTS", 2)
    measure = throughput.measure
    monkeypatch.setattr(throughput, "measure", lambda *scene, **more: measure(*scene, seconds=0.1, **more))
    assert throughput.main(["--json", str(tmp_path / "rows.json"), "--rounds", "2"]) == 0
    written = json.loads((tmp_path / "rows.json").read_text("utf-8"))["rows"]
    rows, planar, flexible = ({row["way"]: row for row in written if row["scene"] == name} for name in names)
    assert list(planar) == list(flexible) == list(rows)
    assert all(row["steps_alone"] == 0 for row in [*planar.values(), *flexible.values()])
    assert [way for way in rows if way.endswith("lanes")] == [f"{w} lanes" for w in (2, 4, 8) if w <= widest_lanes()]
    assert all(row["steps_alone"] == 0 for row in rows.values())
    assert all(row["cars_in_real_time_a_core"] == pytest.approx(5e3 / row["us_a_step"]) for row in rows.values())
    assert rows["2 lanes"]["kilobytes_a_car"] > rows["single"]["kilobytes_a_car"] > 100.0
    single = rows["single"]["us_a_step"] / 5.0
    table = capsys.readouterr().out.partition("A second of 1000 cars")[2]
    assert f"| with links | {single:.1f} ms |" in table
    assert f"| {1e-3 * rows['single']['kilobytes_a_car']:.2g} GB, " in table
    assert "four-bar" not in table  # a mechanism is no car
    assert "ratio_to_older" not in rows["single"]


@pytest.mark.slow
def test_beside_cars_of_a_clone() -> None:
    """The clone is this one: its car takes as long as a single one here, but for what else the machine does."""
    name, h, seconds = "slalom", 0.005, 0.2
    with older_cars(Path(__file__).parents[2], name, h, seconds, lanes.CARS) as cars:
        rows = throughput.measure(name, h, partial(lanes.varied_cars, name, 0), seconds, rounds=2, older=cars)
    ratio = {row["way"]: row["ratio_to_older"] for row in rows}
    assert 0.2 < ratio["single"] < 5.0
    assert all(row["ratio_to_older"] == pytest.approx(row["ratio"] * ratio["single"]) for row in rows)
