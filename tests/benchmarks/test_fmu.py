"""`python -m benchmarks.fmu`: a figure for every quantity, positive, in the file too."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks import fmu

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
