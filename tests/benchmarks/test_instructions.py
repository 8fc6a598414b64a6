"""`python -m benchmarks.cost instructions`: the counts are those of the kernel; a more expensive step is reported."""

import json

import pytest

from benchmarks import cost
from benchmarks.car import scene_instructions
from benchmarks.car.scene_instructions import counter
from mbs import simulate
from tests.unoptimised import unoptimised


@pytest.mark.slow
@unoptimised()
def test_counts_are_those_of_a_run_and_a_dearer_step_is_reported(tmp_path, capsys, monkeypatch):
    scene = scene_instructions.SCENES[0]._replace(steps=20)
    program = scene_instructions.compiled(tmp_path)
    monkeypatch.setattr(scene_instructions, "SCENES", [scene])
    monkeypatch.setattr(scene_instructions, "compiled", lambda folder: program)
    table = tmp_path / "table.json"
    assert cost.main(["instructions", "--json", str(table)]) == 0
    stored = json.loads(table.read_text("utf-8"))
    row = stored["rows"][0]
    run = simulate(scene.system(), scene.steps * scene.step, scene.step, progress=False, estimate_error=False).report
    assert run is not None
    assert row["iterations"] == pytest.approx(run.iterations / scene.steps)
    assert (row["instructions"] is None) == (counter() is None)
    assert cost.main(["instructions", "--against", str(table)]) == 0
    what = "factorizations" if counter() is None else "instructions"
    row[what] /= 1.05
    table.write_text(json.dumps(stored), "utf-8")
    capsys.readouterr()
    assert cost.main(["instructions", "--against", str(table)]) == 1
    assert f"double four-bar, 30 ms: {what} 5.0 % more a step." in capsys.readouterr().out


def test_the_table_of_the_project_has_every_scene():
    rows = json.loads(scene_instructions.STORED.read_text("utf-8"))["rows"]
    stored = {(row["scene"], row["step_ms"]) for row in rows}
    assert stored == {(scene.name, 1e3 * scene.step) for scene in scene_instructions.SCENES}
