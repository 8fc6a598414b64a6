"""The example of a study: its file is checked, and its plan is as described."""

from pathlib import Path

import pytest

from hosts.study.command import main

EXAMPLE = Path(__file__).parents[3] / "examples" / "handling_study.toml"


@pytest.mark.slow
def test_the_example_is_a_plan(
    prototype_fmu: Path,
    tmp_path: Path,
    in_process: None,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("hosts.fmu.built_fmu.fmu_of_car", lambda car, *_: {"prototype": prototype_fmu}[car])
    assert main([str(EXAMPLE), "--dry-run", "--out", str(tmp_path / "out")]) == 0
    assert "192 points x 1 = 192 runs" in capsys.readouterr().out
    assert "192 runs" in EXAMPLE.read_text(encoding="utf-8")
    assert not (tmp_path / "out").exists()
