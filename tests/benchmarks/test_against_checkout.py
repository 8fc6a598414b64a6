"""`python -m benchmarks.cost turns`: a checkout against itself costs the same; what is no checkout is reported."""

from pathlib import Path

import pytest

from benchmarks import cost
from benchmarks.car.against_checkout import ROOT, measure
from benchmarks.car.step_scenes import SCENES
from tests.unoptimised import unoptimised


@pytest.mark.proof
@unoptimised()
def test_a_checkout_against_itself() -> None:
    scenes = [scene for scene in SCENES if scene.name in ("double four-bar", "slalom")]
    rows = [*measure(ROOT, scenes, rounds=1, repeats=1, counted=False, steps=20)]
    assert [row["scene"] for row in rows] == ["double four-bar", "slalom"]
    for row in rows:
        assert row["iterations here"] == row["iterations there"] > 0.5
        assert row["solves here"] == row["solves there"] > 1.0
        assert row["ratio"] > 0.0


def test_a_folder_that_is_no_checkout_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cost.main(["turns", "--other", str(tmp_path), "--only", "slalom"]) == 2
    assert "has no mbs/kernel/src; git worktree add FOLDER COMMIT" in capsys.readouterr().err
    assert cost.main(["turns"]) == 2
    assert "--other is missing" in capsys.readouterr().err
