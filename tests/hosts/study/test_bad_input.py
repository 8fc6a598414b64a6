"""What cannot be run is said in one sentence before the first run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from hosts.study import trial
from hosts.study.command import main

RANGE = '"spring.stiffness" = { range = [50.0, 80.0] }'
SOBOL = 'method = "sobol"\nruns = 16\nseed = 7'
GRID = 'method = "grid"'


@pytest.fixture(autouse=True)
def _no_run(monkeypatch: pytest.MonkeyPatch) -> None:
    def run(*_: object) -> None:
        raise AssertionError("a run was made")

    monkeypatch.setattr(trial, "run_isolated", run)


@pytest.fixture
def told(study_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    def tell(*replaced: tuple[str, str], more: str = "") -> str:
        assert main([str(study_file(*replaced, more=more)), "--out", str(tmp_path / "out")]) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert not (tmp_path / "out").exists()
        return error.removeprefix("error: ").replace(f"{tmp_path}/", "").strip()

    return tell


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("step = 0.01", "stepp = 0.01", "study.toml: there is no key stepp; did you mean step?"),
        ("step = 0.01", "step = -1.0", "study.toml: step is -1.0; it must be a positive number, s."),
        ("fmu =", "car = 'prototype'\nfmu =", "study.toml: it needs fmu or car, one of them."),
        (SOBOL, GRID, "study.toml: parameters.'spring.stiffness' needs a count, how many values of its range the grid has."),
        (RANGE, '"spring.stiffness" = { values = [] }', "study.toml: parameters.'spring.stiffness'.values is []; it must be a list of at least one value."),
        (RANGE, '"spring.stiffness" = { range = [80.0, 50.0] }', "study.toml: parameters.'spring.stiffness': its range is 80 to 50; the lower end comes first."),
        (RANGE, '"spring.stiffnes" = { range = [50.0, 80.0] }', "study.toml: parameters: the FMU has no parameter or input 'spring.stiffnes'; did you mean spring.stiffness?"),
        (RANGE, '"spring.stiffness" = { range = [5.0, 80.0] }', "study.toml: parameters.'spring.stiffness'.range: 'spring.stiffness' is 5 N/m; its range is 10 to 900 N/m."),
        (RANGE, '"spring.stiffness" = { range = [50.0, 80.0], unit = "N/mm" }', "study.toml: parameters.'spring.stiffness'.range: the unit is 'N/mm'; the FMU knows 'spring.stiffness' in N/m."),
        (RANGE, '"bob.x" = { range = [50.0, 80.0] }', "study.toml: parameters: 'bob.x' is an output of the FMU; it cannot be set."),
        ('"spring.damping" = 0.0', '"spring.damping" = 50.0', "study.toml: start: 'spring.damping' is 50 N.s/m; its range is 0 to 20 N.s/m."),
        ('"spring.damping" = 0.0', '"spring.stiffness" = 60.0', "study.toml: 'spring.stiffness' is a parameter and in [start]; give it once."),
        ('name = "fall"\nstop_time = 2.0', 'manoeuvre = "step_ster"', "study.toml: there is no manoeuvre 'step_ster'; did you mean step_steer?"),
        ("stop_time = 2.0", "stop_time = 0.001", "study.toml: manoeuvres[1]: The step is 0.01 s; it must be positive and not longer than 0.001 s."),
        ("stop_time = 2.0", "test = 'step_ster'", "study.toml: manoeuvres[1]: There is no test 'step_ster' in the catalogue; did you mean 'step_steer'?"),
        ('highest = "max(bob.y)"', 'highest = "max(bob.z)"', None),
        ('highest = "max(bob.y)"', 'status = "max(bob.y)"', "study.toml: 'status' is a column that every table of a study has; give it another name."),
        (SOBOL, 'method = "sobol"', "study.toml: sampling: the method sobol needs the number of points, runs."),
    ],
)  # fmt: skip
def test_a_wrong_file_is_one_sentence(told: Callable[..., str], old: str, new: str, sentence: str | None) -> None:
    error = told((old, new))
    if sentence is None:
        assert error.startswith("study.toml: measures.highest: ")
        assert "bob.z" in error
        assert "bob.x" in error or "bob.y" in error
    else:
        assert error == sentence


def test_unknown_signals_and_odd_intervals(told: Callable[..., str]) -> None:
    signals = '[signals]\nnames = ["bob.w"]\ninterval = 0.05\n'
    assert told(more=signals) == (
        "study.toml: signals.names: the FMU has no input or output 'bob.w'; did you mean bob.y or bob.x?"
    )
    assert told(more=signals.replace("bob.w", "bob.y").replace("0.05", "0.015")) == (
        "study.toml: manoeuvres[1]: signals.interval is 0.015 s, no whole multiple of the step of 0.01 s; take 0.02 s."
    )


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ("", "The table t.csv has no points; it needs a heading and at least one row."),
        ("spring.stiffness\n", "The table t.csv has no points; it needs a heading and at least one row."),
        ("spring.stiffness\n60\n70\n5\n", "t.csv, row 3: 'spring.stiffness' is 5 N/m; its range is 10 to 900 N/m."),
        ("spring.stiffness\n60\nx\n", "t.csv, row 2: 'spring.stiffness': 'x' is not a number."),
        ("spring.stiffness\n60\nnan\n", "t.csv, row 2: 'spring.stiffness': the value is nan; only finite numbers can be used."),
        ("spring.stiffness\n60,70\n", "t.csv, row 1: 2 values where the heading has 1 columns."),
        ("spring.x\n60\n", "t.csv, heading: the FMU has no parameter or input 'spring.x'"),
        ("spring.damping\n2\n", "study.toml: 'spring.damping' is a column of t.csv and in [start]; give it once."),
    ],
)  # fmt: skip
def test_a_wrong_row_of_a_table_is_named(told: Callable[..., str], tmp_path: Path, table: str, sentence: str) -> None:
    (tmp_path / "t.csv").write_text(table)
    free = '"spring.free_length" = { range = [0.5, 0.8] }'
    error = told((SOBOL, 'method = "table"\nfile = "t.csv"'), (RANGE, ""), (free, ""))
    assert error.startswith(sentence)


def test_what_the_command_line_asks(
    told: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(tmp_path / "none.toml")]) == 2
    assert capsys.readouterr().err == f"error: There is no file {tmp_path}/none.toml.\n"
    assert main([str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"error: {tmp_path} is a folder; a study is a TOML file.\n"
    assert main([str(tmp_path), "--workers", "0"]) == 2
    assert capsys.readouterr().err == "error: --workers is 0; at least one is needed.\n"
    assert main([str(tmp_path), "--run", "1"]) == 2
    assert "is no folder of a study: there is no study.json in it." in capsys.readouterr().err
