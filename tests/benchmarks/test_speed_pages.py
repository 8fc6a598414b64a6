"""Tables of lanes, other cars and worst steps in `docs/speed.md`: cells are those of rows, each has its place."""

from benchmarks import car_peers
from benchmarks.car import real_time
from benchmarks.car.lanes import LANES, lane_blocks
from benchmarks.shared.figures import between, read, rows_of

US = {"single": 40.0, "2 lanes": 32.0, "4 lanes": 16.0, "4 lanes, 2 threads": 20.0}


def lane_rows(scenes):
    return [
        {"scene": scene, "step_ms": 5.0, "way": way, "us_a_step": us, "ratio": 40.0 / us, "kilobytes_a_car": 250.0 + us}
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
    assert [row["scene"] for row in tables["lanes memory"]] == scenes
    assert tables["lanes memory"][0]["4 lanes, kB"] == "266"


def test_other_cars_and_worst_steps():
    peers = [
        {"scene": scene, "step_ms": 5.0, "car": car, "way": "single", "us_a_step": us}
        for scene, us in (("slalom", 9.25), ("lane change", 8.0))
        for car in ("links", "MuJoCo")
    ]
    step = {"fidelity": 0, "step_ms": 2.0, "iterations": 2.0, "most_iterations": 17, "steps": 30}
    step |= {"mean_us": 89.4, "p99_9_us": 1209.2, "worst_us": 2990.0, "quarter_us": 500.0}
    free, limited = (
        step | {"limit": 0, "capped": 0, "residual_mm": 0.0},
        {"limit": 6, "capped": 3, "residual_mm": 6.7e-4},
    )
    other = step | limited | {"step_ms": 1.0}
    blocks = car_peers.peer_blocks(peers)
    blocks |= real_time.real_time_blocks([free, step | limited, other])
    tables = {name: rows_of(text) for name, text in blocks.items()}
    assert tables["car peers"][1] == {
        "car": "MuJoCo",
        "way": "single",
        "slalom, 5 ms": "9.2",
        "lane change, 5 ms": "8.0",
    }
    assert [row["worst, us"] for row in tables["wild steps"]] == ["2990"]
    assert tables["wild steps"][0]["iterations, mean and most"] == "2.00, 17"
    assert [list(row.values()) for row in tables["wild limits"]] == [["0", "6", "3 of 30", "0.00067"]]
