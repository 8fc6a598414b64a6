"""`python -m benchmarks.fmu plant`: positive figures, and the same results from all kinds of environments."""

from pathlib import Path

import pytest

from benchmarks.car import plant_steps as plant


@pytest.mark.slow
def test_every_way_makes_its_steps(prototype_fmu: Path) -> None:
    rows = plant.measure("LaneKeeping", 2, 2, 3, car=str(prototype_fmu))
    ways = ["2 by SyncVectorEnv", "2 by AsyncVectorEnv", "2 by threads"]
    assert [row["way"] for row in rows] == [plant.FMPY, plant.CAR, plant.ONE, *ways]
    for row in rows:
        assert row["environment"] == "LaneKeeping"
        assert row["step_ms"] == 20.0
        assert row["steps_a_second"] > 0.0
        assert (row["us_of_processor"] is None) == ("Async" in row["way"])
