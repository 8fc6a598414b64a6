"""The CI job of docs/checking.md on a small repository; JUnit files by a second reader."""

import csv
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from hosts.check.command import main
from hosts.check.verdict_files import Case, write_junit
from hosts.run.command import main as run_main
from tests.in_process import run

junitparser = pytest.importorskip("junitparser")
PAGE = Path(__file__).parents[2] / "docs" / "checking.md"
PULL = '"time","pull"\n0,0\n0.4,{0}\n0.4,-20\n1,0\n'


@pytest.fixture(scope="module")
def repository(tuned: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An FMU and two references."""
    folder = tmp_path_factory.mktemp("repository")
    shutil.copyfile(tuned, folder / "model.fmu")
    for name, pull in (("swing", 30), ("rest", 0)):
        (folder / f"{name}.csv").write_text(PULL.format(pull))
        done = run(run_main, folder / "model.fmu", "-m", folder / f"{name}.csv", "--out", folder / "references")
        assert done.returncode == 0, done.stderr
    return folder


def cases(file: Path) -> dict[tuple[str, str], str]:
    """Verdict by class and name, as junitparser reads the file."""
    results = {}
    for suite in junitparser.JUnitXml.fromfile(str(file)):
        listed = list(suite)
        kinds = [type(case.result[0]).__name__.lower() if case.result else "good" for case in listed]
        assert (suite.tests, suite.failures) == (len(listed), kinds.count("failure"))
        assert (suite.errors, suite.skipped) == (kinds.count("error"), kinds.count("skipped"))
        results |= {(case.classname, case.name): kind for case, kind in zip(listed, kinds, strict=True)}
    return results


def spoil(folder: Path, name: str, signal: str, by: float) -> None:
    """A table whose signal is off by a share of its range in one row."""
    file = folder / "references" / name
    heading, *rows = csv.reader(file.read_text().splitlines())
    k = heading.index(signal)
    values = np.array([float(row[k]) for row in rows])
    rows[40][k] = repr(float(values[40] + by * np.ptp(values)))
    file.write_text("\n".join(",".join(row) for row in [heading, *rows]) + "\n")


@pytest.mark.slow
def test_the_job_as_it_is_written(repository: Path, tmp_path: Path) -> None:
    """Each `run:` of the workflow by its words, but for the installation; a spoilt table fails its step alone."""
    folder = Path(shutil.copytree(repository, tmp_path / "a repository"))
    spoil(folder, "model_swing.csv", "bob.x", 0.05)
    steps = re.findall(r"^ +- run: (.+)$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert steps[0].startswith("python -m pip install")
    codes = []
    for step in steps[1:]:
        program, *arguments = shlex.split(step)
        assert program == "ali3"
        done = subprocess.run([sys.executable, "-m", "ali3", *arguments], cwd=folder, capture_output=True, check=False)
        codes.append(done.returncode)
    assert codes == [0, 1]
    check, references = cases(folder / "reports" / "check.xml"), cases(folder / "reports" / "references.xml")
    assert set(check.values()) == {"good"}
    assert len(check) > 20
    assert {group for group, _ in references} == {"model_swing", "model_rest"}
    assert [key for key, kind in references.items() if kind != "good"] == [("model_swing", "bob.x")]
    (failure,) = (
        result
        for suite in junitparser.JUnitXml.fromfile(str(folder / "reports" / "references.xml"))
        for case in suite
        for result in case.result
    )
    assert re.fullmatch(
        r"largest error [\d.e-]+ m at 0\.4 s, 5(\.\d)? % of its range in the table of [\d.e-]+ m; the bound is 0\.1 %",
        failure.message,
    )


def test_what_is_no_reference_is_an_error_and_the_others_are_compared(repository: Path, tmp_path: Path) -> None:
    """Also columns that are gone, which are skipped."""
    folder = Path(shutil.copytree(repository, tmp_path / "r"))
    (folder / "references" / "a.csv").write_text("no table\n")
    rest = folder / "references" / "model_rest.csv"
    rest.write_text(rest.read_text().replace("bob.y", "bob.height"))
    done = run(main, folder / "model.fmu", "--reference", folder / "references", "--junit", tmp_path / "a.xml")
    assert done.returncode == 2
    error = done.stderr.splitlines()[-1]  # a slow run has shown its progress before
    assert error.startswith("error: ")
    assert "a.csv" in error
    actual = cases(tmp_path / "a.xml")
    assert {key: kind for key, kind in actual.items() if kind != "good"} == {
        ("a", "comparison"): "error",
        ("model_rest", "bob.height"): "skipped",
    }
    assert actual[("model_swing", "bob.y")] == "good"


def test_an_error_is_no_good_file(repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(repository)
    done = run(main, "model.fmu", "--reference", "nothing", "--junit", tmp_path / "a.xml")
    assert done.returncode == 2
    assert "nothing" in done.stderr
    assert "error" in cases(tmp_path / "a.xml").values()
    done = run(main, "model.fmu", "--show-parameters", "--junit", tmp_path / "b.xml")
    assert done.returncode == 2
    assert "--junit cannot be combined with --show-parameters" in done.stderr


def test_any_text_is_read_back(tmp_path: Path) -> None:
    """Characters that XML does not have are question marks."""
    message = 'a < b & "c" \x00\x1b[31m\ud800 Ω €'
    write_junit(
        tmp_path / "a.xml",
        message,
        [Case(message, message, "bad", message), *2 * [Case("b", "c", "good", message, 0.125)]],
    )
    (suite,) = junitparser.JUnitXml.fromfile(str(tmp_path / "a.xml"))
    bad, good, _ = list(suite)
    assert bad.name == bad.result[0].message == 'a < b & "c" ??[31m? Ω €'
    assert (good.time, suite.time) == (0.125, 0.25)
    assert (suite.tests, suite.failures, suite.errors, suite.skipped) == (3, 1, 0, 0)
