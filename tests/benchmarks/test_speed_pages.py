"""Tables of lanes, other cars and worst steps in `docs/speed.md`: cells are those of rows, each has its place."""

from __future__ import annotations

import json
import re

from benchmarks import pages
from benchmarks.car import fmu_pages
from benchmarks.car.speed_pages import CARS, LANES
from benchmarks.shared.figures import between, rows_of
from benchmarks.shared.pages import DOCS

META = {
    "machine": {"processor": "P", "cores": 2, "system": "S", "python": "3.11", "versions": {}},
    "time": "2026-11-26T",
}
US = {"single": 40.0, "2 lanes": 32.0, "4 lanes": 16.0, "4 lanes, 2 threads": 20.0}


def lane_rows(scenes, **more):
    return [
        {"scene": scene, "step_ms": 5.0, "way": way, "us_a_step": us, "ratio": 40.0 / us, "kilobytes_a_car": 250.0 + us}
        | {key: value * 40.0 / us for key, value in more.items()}
        for scene in scenes
        for way, us in US.items()
    ]


def written(tmp_path, **files):
    """Tables of the page after `benchmarks.pages` with these files."""
    arguments = ["--docs", str(tmp_path)]
    for page in pages.PAGES:
        (tmp_path / page).write_text((DOCS / page).read_text(encoding="utf-8"), encoding="utf-8")
    for name, runs in files.items():
        arguments.append(f"--{name.replace('_', '-')}")
        for number, rows in enumerate(runs):
            file = tmp_path / f"{name}{number}.json"
            file.write_text(json.dumps({"meta": META, "rows": rows}), encoding="utf-8")
            arguments.append(str(file))
    assert pages.main(arguments) == 0
    text = (tmp_path / "speed.md").read_text(encoding="utf-8")
    return {name: rows_of(between(text, name)) for name in re.findall("<!-- begin (.*) -->", text)}


def test_lanes(tmp_path):
    scenes = dict.fromkeys([*CARS, *(scene for names in LANES.values() for scene in names)])
    runs = [lane_rows(["slalom"], ratio_to_older=1.5), lane_rows(scenes)]
    tables = written(tmp_path, throughput=runs)
    beside = {row["way"]: row["slalom, 5 ms"] for row in tables["lanes"]}
    assert beside["one car of the older commit"] == "60.0"
    assert beside["4 lanes"] == "16.0 (2.50, 3.75)"
    for name, names in LANES.items():
        assert [list(row)[1:] for row in tables[name]] == [[f"{scene}, 5 ms" for scene in names]] * len(US)
        assert tables[name][2][f"{names[0]}, 5 ms"] == "16.0 (2.50)"
    assert [row["scene"] for row in tables["lanes memory"]] == list(scenes)
    assert tables["lanes memory"][0]["4 lanes, kB"] == "266"
    links, tabled = tables["thousand cars"]
    assert (links["car"], tabled["car"]) == ("with links", "by tables")
    assert links["1000 cores, a car each"] == "8.0 ms"
    assert links["250 cores, 4 lanes"] == "12.8 ms"
    assert links["one core, 4 lanes"] == "3.2 s"
    assert links["memory: alone, in 4 lanes"] == "0.29 GB, 0.27 GB"


def test_other_cars_and_worst_steps(tmp_path):
    peers = [
        {"scene": scene, "step_ms": 5.0, "car": car, "way": "single", "us_a_step": us}
        for scene, us in (("slalom", 9.25), ("lane change", 8.0))
        for car in ("links", "MuJoCo")
    ]
    step = {"drive": "wild", "fidelity": 0, "step_ms": 2.0, "iterations": 2.0, "most_iterations": 17, "steps": 30}
    step |= {"mean_us": 89.4, "p99_9_us": 1209.2, "worst_us": 2990.0, "quarter_us": 500.0}
    free, limited = (
        step | {"limit": 0, "capped": 0, "residual_mm": 0.0},
        {"limit": 6, "capped": 3, "residual_mm": 6.7e-4},
    )
    other = step | limited | {"step_ms": 1.0}
    tables = written(
        tmp_path, car_peers=[peers], real_time=[[free, step | limited, other, free | {"drive": "kerb test"}]]
    )
    assert tables["car peers"][1] == {
        "car": "MuJoCo",
        "way": "single",
        "slalom, 5 ms": "9.2",
        "lane change, 5 ms": "8.0",
    }
    assert [row["worst, us"] for row in tables["wild steps"]] == ["2990"]
    assert tables["wild steps"][0]["iterations, mean and most"] == "2.00, 17"
    assert [list(row.values()) for row in tables["wild limits"]] == [["0", "6", "3 of 30", "0.00067"]]


def test_fmu_calls_webassembly_and_cars_in_python():
    calls = [
        {"quantity": "step", "kind": k, "host": h, "value": v}
        for k, h, v in (("native", "C", 27), ("python", "FMPy", 29.4))
    ]
    step, *_ = rows_of(fmu_pages.fmu_blocks(calls)["fmu calls"])
    assert list(step.values()) == ["one step of 2 ms", "27", "–", "–", "29.4"]
    hosts = [
        {"fidelity": "2", "what": "inner", "host": host, "best_us": us}
        for host, us in (("native", 245.3), ("Node", 313.0))
    ]
    assert rows_of(fmu_pages.wasm_blocks(hosts)["wasm"]) == [
        {"fidelity, calls": "2, inner", "native": "245", "Node": "313"}
    ]
    ways = [
        {"environment": "E", "step_ms": 20.0, "way": way, "steps_a_second": 2009.2, "us_of_processor": us}
        for way, us in (("FMPy", 472.3), ("Async", None))
    ]
    assert [row["E, 20 ms"] for row in rows_of(fmu_pages.plant_blocks(ways)["plant"])] == ["2009 (472)", "2009"]
