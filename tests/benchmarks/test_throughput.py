"""`python -m benchmarks.cost throughput`: single runs, lanes and threads make the same steps."""

import json

import pytest

from benchmarks import cost
from benchmarks.car import lanes
from mbs.kernel.binding.many import widest_lanes


@pytest.mark.slow
def test_all_ways_make_the_same_steps(tmp_path, monkeypatch):
    names = ("slalom", "double four-bar", "flexible four-bar")
    monkeypatch.setattr(lanes, "PARTS", 2)
    measure = lanes.measure
    monkeypatch.setattr(lanes, "measure", lambda *scene, **more: measure(*scene, seconds=0.1, **more))
    chosen = ["--only", *names, "--rounds", "2", "--json", str(tmp_path / "rows.json")]
    assert cost.main(["throughput", *chosen]) == 0
    written = json.loads((tmp_path / "rows.json").read_text("utf-8"))["rows"]
    rows, planar, flexible = ({row["way"]: row for row in written if row["scene"] == name} for name in names)
    assert list(planar) == list(flexible) == list(rows)
    assert all(row["steps_alone"] == 0 for row in [*planar.values(), *flexible.values()])
    assert [way for way in rows if way.endswith("lanes")] == [f"{w} lanes" for w in (2, 4, 8) if w <= widest_lanes()]
    assert all(row["steps_alone"] == 0 for row in rows.values())
