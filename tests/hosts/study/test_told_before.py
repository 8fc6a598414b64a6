"""What a study tells before it: its plan, and a measure that the trial could not compute."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from hosts.study.campaign import run_study


@pytest.mark.slow
def test_a_function_that_raises_is_told_before_the_study(
    study_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "own.py").write_text("def value(result):\n    raise ArithmeticError('no such number')\n")
    run_study(study_file(more='own = "own.py:value"\n'), tmp_path / "out", None, None, dry=True)
    said = capsys.readouterr().err
    assert "note: Run 0, fall, is incomplete: " in said
    assert "no such number" in said


@pytest.mark.slow
@pytest.mark.parametrize(("workers", "words"), [(1, "in all on one worker"), (2, "in all with 2 workers")])
def test_the_plan_tells_its_workers(
    study_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str], workers: int, words: str
) -> None:
    run_study(study_file(), tmp_path / "out", None, workers, dry=True)
    assert words in capsys.readouterr().out
