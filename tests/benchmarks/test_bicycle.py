"""The bicycle's benchmark command: three sources beside each other, a row for each method."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks import work_precision

DIFFERENCES = 1e-5  # of the central differences


@pytest.mark.slow
def test_the_command_prints_all_three_and_every_method(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert work_precision.main(["bicycle", "--quick", "--json", str(tmp_path / "b.json")]) == 0
    data = json.loads((tmp_path / "b.json").read_text(encoding="utf-8"))
    linear, methods = ([r for r in data["rows"] if r["table"] == name] for name in ("linear", "methods"))
    assert len(linear) == 6
    for row in linear:
        assert row["system"] == pytest.approx(row["published"], abs=1e-6)
        assert row["outside"] == pytest.approx(row["published"], rel=DIFFERENCES, abs=DIFFERENCES)
    assert all(row["error"] < 1e-4 for row in methods)
    printed = capsys.readouterr().out
    assert "capsize begins" in printed
    assert "runge_kutta_8" in printed
