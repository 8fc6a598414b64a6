"""The example of a study: its car is built, its files are checked, and its plan is as described."""

from pathlib import Path

import pytest

from hosts.study.command import main

EXAMPLE = Path(__file__).parents[3] / "examples" / "handling_study.toml"


@pytest.mark.slow  # builds the car
def test_the_example_is_a_plan(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "cache"))
    for _ in range(2):
        assert main([str(EXAMPLE), "--dry-run", "--out", str(tmp_path / "out")]) == 0
        captured = capsys.readouterr()
        assert "192 points x 1 = 192 runs" in captured.out
        assert "192 runs" in EXAMPLE.read_text(encoding="utf-8")
    assert captured.err == ""  # the second time the car is there
    assert not (tmp_path / "out").exists()
