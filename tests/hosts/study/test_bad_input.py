"""Invalid studies are reported in one sentence before the first run."""

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from hosts.study import trial_runs as trial
from hosts.study.command import main
from hosts.study.folder import begin_study
from hosts.study.plan import make_plan
from hosts.study.study_file import read_study_file

RANGE = '"spring.stiffness" = { range = [50.0, 80.0] }'
SOBOL = 'method = "sobol"\nruns = 16\nseed = 7'
CASES = tomllib.loads((Path(__file__).parent / "bad_input.toml").read_text(encoding="utf-8"))


@pytest.fixture(autouse=True)
def _no_run(monkeypatch: pytest.MonkeyPatch) -> None:
    def run(*_: object) -> None:
        raise AssertionError("a run was made")

    monkeypatch.setattr(trial, "_outcomes_at", run)


@pytest.fixture
def told(study_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    def tell(*replaced: tuple[str, str], more: str = "") -> str:
        assert main([str(study_file(*replaced, more=more)), "--out", str(tmp_path / "out")]) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert not (tmp_path / "out").exists()
        return error.removeprefix("error: ").replace(f"{tmp_path}/", "").strip()

    return tell


@pytest.mark.parametrize("case", CASES["file"], ids=lambda case: case["new"])
def test_a_wrong_file_is_one_sentence(told, case):
    assert told((case["old"], case["new"])).startswith(case["begins"])


def test_unknown_signals_and_odd_intervals(told):
    signals = '[signals]\nnames = ["bob.w"]\ninterval = 0.05\n'
    assert told(more=signals) == (
        "study.toml: signals.names: the FMU has no input or output 'bob.w'; did you mean 'bob.y' or 'bob.x'?"
    )
    assert told(more=signals.replace("bob.w", "bob.y").replace("0.05", "0.015")) == (
        "study.toml: manoeuvres[1]: signals.interval is 0.015 s, which is not a multiple of the step of "
        "0.01 s; take 0.02 s."
    )


@pytest.mark.parametrize("case", CASES["table"], ids=lambda case: case["table"])
def test_a_wrong_row_of_a_table_is_named(told, tmp_path, case):
    (tmp_path / "t.csv").write_text(case["table"])
    free = '"spring.free_length" = { range = [0.5, 0.8] }'
    error = told((SOBOL, 'method = "table"\nfile = "t.csv"'), (RANGE, ""), (free, ""))
    assert error.startswith(case["begins"])


def test_wrong_options_and_study_files_are_refused(study_file, tuned, tmp_path, capsys):
    assert main([str(tmp_path / "none.toml")]) == 2
    assert capsys.readouterr().err == f"error: {tmp_path}/none.toml cannot be read: there is no such file.\n"
    assert main([str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"error: {tmp_path} is a folder; a study is a TOML file.\n"
    results = tmp_path / "my results"
    file = study_file(name="my study.toml")
    begin_study(results, make_plan(read_study_file(file)[0], file, tuned).record, b"", tuned)
    assert main([str(results)]) == 2
    assert f"'{file}' --out '{results}'; otherwise give --run or --report." in capsys.readouterr().err
    with pytest.raises(SystemExit) as end:
        main([str(tmp_path), "--jobs", "0"])
    assert end.value.code == 2
    assert "a whole number of at least 1" in capsys.readouterr().err
    assert main([str(tmp_path), "--run", "1"]) == 2
    assert "is not a study folder: there is no study.json in it." in capsys.readouterr().err
