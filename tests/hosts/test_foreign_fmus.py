"""`ali3 run` of FMUs that crash, print without end, start processes or take memory: reported, and nothing stays."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import psutil
import pytest

from hosts.run.command import main
from tests.hosts.odd_fmus import odd_fmu
from tests.in_process import run

resource = pytest.importorskip("resource")
LEAVE, CRASH, NOT_A_NUMBER, MOVE, PRINT, FORK, CLOSE, EAT, WRITE = range(1, 10)
pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="guards, signals, folders of Linux")]


@pytest.fixture(scope="module")
def faults(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return odd_fmu("faults", tmp_path_factory.mktemp("faults"))


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for temporary files that is to be empty at the end."""
    place = tmp_path / "temporary"
    place.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(place))
    return place


def driven(fmu: Path, out: Path, fault: int, *options: object) -> tuple[int, str, np.ndarray]:
    """Exit code, words and rows (time, u, y) of a run."""
    done = run(main, fmu, "--set", f"u={fault}", "--out", out, *options)
    rows = np.loadtxt(out / f"{fmu.stem}.csv", delimiter=",", skiprows=1)
    return done.returncode, done.stdout, rows


@pytest.mark.parametrize(
    ("fault", "message", "rows"),
    [
        (LEAVE, "The process of the FMU ended with exit code 0 in fmi2DoStep at 0.04 s; 5 rows were kept.", 5),
        (CRASH, "The process of the FMU crashed (SIGSEGV) in fmi2DoStep at 0.04 s; 5 rows were kept.", 5),
        (NOT_A_NUMBER, "The output 'y' is nan at 0.05 s.", 101),
        (CLOSE, "; 101 rows were kept.", 101),
    ],
)
def test_the_cause_of_an_early_end_is_reported_with_the_rows_until_then(
    faults, tmp_path, temporary, fault, message, rows
):
    code, output, table = driven(faults, tmp_path / "out", fault)
    assert code == 1
    assert output.count(message) == 1
    assert len(table) == rows
    good = np.where(np.isnan(table[:, 2]), table[:, 0], table[:, 2])
    assert np.allclose(good, table[:, 0], atol=1e-12)  # the output is the time
    assert json.loads((tmp_path / "out" / "faults.json").read_text())["failed_steps"] == (fault != NOT_A_NUMBER)
    assert not list(temporary.iterdir())


def test_processes_of_an_fmu_end_with_it_and_are_reported(faults, tmp_path, temporary):
    done = run(main, faults, "--set", f"u={FORK}", "--out", tmp_path / "out")
    assert done.returncode == 0
    assert done.stderr == "note: 3 processes that an FMU had started were ended with it.\n"
    places = [(p.info["environ"] or {}).get("TMPDIR", "") for p in psutil.process_iter(["environ"])]
    assert not [place for place in places if place.startswith(str(temporary))]
    assert not list(temporary.iterdir())


@pytest.mark.parametrize("fault", [MOVE, WRITE])
def test_another_folder_and_files_of_an_fmu_change_nothing_here(faults, tmp_path, temporary, monkeypatch, fault):
    monkeypatch.chdir(tmp_path)
    code, output, table = driven(Path(os.path.relpath(faults)), Path("out"), fault)
    assert code == 0
    assert "written: out/faults.csv" in output
    assert len(table) == 101
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out", "temporary"]
    assert not list(temporary.iterdir())


def test_one_that_prints_without_end_is_ended(faults, tmp_path):
    code, output, table = driven(faults, tmp_path / "out", PRINT)
    assert code == 1
    assert "was ended in fmi2DoStep at 0.04 s because it printed more than 200 MB; 5 rows were kept." in output
    assert len(table) == 5


def test_memory_has_a_limit(faults, tmp_path):
    """What it cannot have is refused to the FMU, which says so."""

    def little() -> None:
        resource.setrlimit(resource.RLIMIT_DATA, (2_000_000_000, 2_000_000_000))

    command = [sys.executable, "-m", "ali3", "run", str(faults), "--set", f"u={EAT}", "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, preexec_fn=little)
    assert done.returncode == 1, done.stderr
    assert "failed steps      1 of 5" in done.stdout
