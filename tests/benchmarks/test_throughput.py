"""`python -m benchmarks.throughput`: all ways make the same steps, from which follows what a thousand cars take."""

from __future__ import annotations

import json

import pytest

from benchmarks import throughput
from mbs.kernel.binding.many import widest_lanes


@pytest.mark.slow
def test_ways_and_the_thousand_cars(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(throughput, "SCENES", throughput.SCENES[:1])
    monkeypatch.setattr(throughput, "PARTS", 2)
    measure = throughput.measure
    monkeypatch.setattr(throughput, "measure", lambda *scene: measure(*scene, seconds=0.1))
    assert throughput.main(["--json", str(tmp_path / "rows.json")]) == 0
    rows = {row["way"]: row for row in json.loads((tmp_path / "rows.json").read_text("utf-8"))["rows"]}
    assert [way for way in rows if way.endswith("lanes")] == [f"{w} lanes" for w in (2, 4, 8) if w <= widest_lanes()]
    assert all(row["steps_alone"] == 0 for row in rows.values())
    assert all(row["cars_in_real_time_a_core"] == pytest.approx(5e3 / row["us_a_step"]) for row in rows.values())
    assert rows["2 lanes"]["kilobytes_a_car"] > rows["single"]["kilobytes_a_car"] > 100.0
    single = rows["single"]["us_a_step"] / 5.0
    assert f"takes {single:.1f} ms on 1000 cores" in capsys.readouterr().out
