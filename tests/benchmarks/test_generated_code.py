"""`python -m benchmarks.cost generated`: loops and generated code take equal iterations; generated code is cheaper."""

import pytest

from benchmarks.car.generated_code import blocks, measure
from benchmarks.car.operations import disassembler
from benchmarks.car.scene_instructions import find_valgrind
from benchmarks.car.step_scenes import SCENES
from benchmarks.shared.figures import rows_of
from tests.unoptimised import unoptimised


@pytest.mark.slow
@unoptimised()
def test_generated_code_makes_the_same_steps() -> None:
    scenes = [scene._replace(steps=20) for scene in SCENES if scene.name == "Bricard's mechanism"]
    (row,) = measure(scenes, rounds=1, repeats=1)
    assert row["iterations generated"] == row["iterations loops"] > 1.0
    assert row["solves generated"] == row["solves loops"] > 1.0
    assert row["ratio"] > 0.0
    assert row["kB"] > 1
    if find_valgrind() is not None:
        assert row["instructions generated"] < 0.9 * row["instructions loops"]
        if disassembler() is not None:
            assert row["operations generated"] == pytest.approx(row["operations loops"], rel=0.2)
    row |= {"us loops": 20.0, "us generated": 12.5, "ratio": 0.625}
    (written,) = rows_of(blocks([row])["generated"])
    assert (written["us, loops"], written["us, generated"], written["times as fast"]) == ("20.0", "12.5", "1.60")
