"""`python -m benchmarks.cost instructions`: the counts are those of the kernel; a more expensive step is reported."""

import json

import pytest

from benchmarks import cost
from benchmarks.car import scene_instructions, step_scenes
from benchmarks.car.scene_instructions import find_valgrind
from benchmarks.shared.figures import between, read, rows_of
from mbs import simulate
from tests.unoptimised import unoptimised


@pytest.mark.slow
@unoptimised()
def test_counts_are_those_of_a_run_and_a_dearer_step_is_reported(tmp_path, capsys, monkeypatch):
    scene = step_scenes.SCENES[0]._replace(steps=20)
    program = step_scenes.compile_program(tmp_path)
    monkeypatch.setattr(step_scenes, "SCENES", [scene])
    monkeypatch.setattr(step_scenes, "compile_program", lambda folder: program)
    table = tmp_path / "table.json"
    assert cost.main(["instructions", "--json", str(table)]) == 0
    stored = json.loads(table.read_text("utf-8"))
    row = stored["rows"][0]
    run = simulate(scene.system(), scene.steps * scene.step, scene.step, progress=False, estimate_error=False).report
    assert run is not None
    assert row["iterations"] == pytest.approx(run.iterations / scene.steps)
    assert (row["instructions"] is None) == (find_valgrind() is None)
    what = "factorizations" if find_valgrind() is None else "instructions"
    for ratio, exit_code in ((1.02, 0), (1.05, 1)):
        page = scene_instructions.instruction_blocks([row | {what: type(row[what])(row[what] / ratio)}])["instructions"]
        text = f"<!-- begin instructions -->\n{page}\n<!-- end instructions -->"
        monkeypatch.setattr(cost, "read", lambda _, text=text: text)
        capsys.readouterr()
        assert cost.main(["instructions", "--compare"]) == exit_code
        assert (f"double four-bar, 30 ms: {what} 5.0 % more a step." in capsys.readouterr().out) == bool(exit_code)


def test_the_table_of_the_page_has_every_scene():
    rows = rows_of(between(read(scene_instructions.PAGE), "instructions"))
    written = {(row["scene"], float(row["step, ms"])) for row in rows}
    assert written == {(scene.name, 1e3 * scene.step) for scene in step_scenes.SCENES}
