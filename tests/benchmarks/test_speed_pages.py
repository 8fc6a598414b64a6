"""Tables of lanes, other cars and worst steps in `docs/speed.md`: cells are those of rows, each has its place."""

from benchmarks.car.lanes import LANES, lane_blocks
from benchmarks.shared.figures import between, read, rows_of

US = {"single": 40.0, "2 lanes": 32.0, "4 lanes": 16.0, "4 lanes, 2 threads": 20.0}


def lane_rows(scenes):
    return [
        {"scene": scene, "step_ms": 5.0, "way": way, "us_a_step": us, "ratio": 40.0 / us}
        for scene in scenes
        for way, us in US.items()
    ]


def test_lanes():
    scenes = [scene for names in LANES.values() for scene in names]
    blocks = lane_blocks(lane_rows(scenes))
    tables = {name: rows_of(text) for name, text in blocks.items()}
    for name, names in LANES.items():
        assert sorted(list(tables[name][0])[1:]) == sorted(f"{scene}, 5 ms" for scene in names)
        assert len(tables[name]) == len(US)
        assert tables[name][2][f"{names[0]}, 5 ms"] == "16.0 (2.50)"
        assert between(read("docs/speed.md"), name)
