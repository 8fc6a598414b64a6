"""`python -m benchmarks.fmu`: a figure for every quantity, positive, in the file too."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from benchmarks import fmu
from benchmarks.car import road_port_cost
from benchmarks.car.road_port_steps import ANSWER, answers, height
from tests.vehicle.rigid_car import rigid_car

SCENE = Path(__file__).parents[2] / "examples" / "motor_pendulum.py"


@pytest.mark.slow
def test_every_quantity_has_a_figure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "fmu.json"
    scene = f"{SCENE}:motor_pendulum"
    arguments = ["--scene", scene, "--steps", "20", "--repeats", "2", "--instances", "5", "--json", str(file)]
    assert fmu.main(arguments) == 0
    printed = capsys.readouterr().out
    assert all(quantity in printed for quantity in fmu.QUANTITIES)
    content = json.loads(file.read_text(encoding="utf-8"))
    native = {(r["quantity"], r["host"]): r["value"] for r in content["rows"] if r["kind"] == "native"}
    assert {q for q, h in native if h == "C"} == {*fmu.QUANTITIES, "file_MB"}
    assert all(value > 0.0 for value in native.values())
    assert {h for _, h in native} == {"C", "FMPy"}
    assert content["meta"]["scene"] == scene


def test_answers_are_the_planes_that_touch_the_waves() -> None:
    places = [0.3, 1.0, 1.7, -1.0]
    for (x, y), told in zip(np.reshape(places, (2, 2)), np.reshape(answers(places, 0.015), (2, 7)), strict=True):
        point = dict(zip(ANSWER, told, strict=True))
        slope = (height(x + 1e-6, 0.015) - height(x - 1e-6, 0.015)) / 2e-6
        normal = np.array([-slope, 0.0, 1.0]) / np.hypot(1.0, slope)
        assert abs(slope) > 0.01
        assert (point["x"], point["y"], point["height"]) == (x, y, height(x, 0.015))
        assert [point[f"normal_{c}"] for c in "xyz"] == pytest.approx(normal.tolist(), abs=1e-9)


@pytest.mark.slow
def test_cars_on_a_road_of_their_own_and_at_road_ports_make_the_steps_that_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def counted(command: Sequence[str]) -> int:
        subprocess.run(command, check=True)
        return 500 + (1300 if "ported" in command[-3] else 1000) * int(command[-1])

    monkeypatch.setattr(road_port_cost, "instructions", counted)
    rows = road_port_cost.measure(str(rigid_car("hatchback", tmp_path / "hatchback")), 2, tmp_path)
    assert [row["own road"] for row in rows] == [1000, 1000]
    assert [row["ratio"] for row in rows] == [1.3, 1.3]
