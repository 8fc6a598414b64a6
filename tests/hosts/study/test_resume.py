"""A resumed study keeps finished runs; a changed study is refused."""

import shlex
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from fmpy.util import read_csv

from ali3.errors import UserError
from ali3.locks import locked
from hosts.common.errors import HostError
from hosts.run.command import main as drive
from hosts.study.campaign import run_study
from hosts.study.command import main
from hosts.study.repeated_run import repeater
from hosts.study.store import read_study
from tests.hosts.in_this_process import in_this_process

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def finished(tuned: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a study of its own FMU, that is done."""
    folder = tmp_path_factory.mktemp("finished")
    fmu = shutil.copy(tuned, folder / "Tuned.fmu")
    text = (Path(__file__).parent / "study.txt").read_text(encoding="utf-8").format(fmu=fmu)
    (folder / "study.toml").write_text(text)
    with in_this_process():
        assert run_study(folder / "study.toml", folder / "out", None, 1) is not None
    return folder


@pytest.fixture
def half(finished: Path, tmp_path: Path) -> Path:
    """A copy of it, whose only part has gone."""
    shutil.copytree(finished, tmp_path, dirs_exist_ok=True)
    text = (tmp_path / "study.toml").read_text().replace(str(finished), str(tmp_path))
    (tmp_path / "study.toml").write_text(text)
    (tmp_path / "out" / "runs" / "part-000001.parquet").unlink()
    return tmp_path


def refused(folder: Path) -> str:
    with pytest.raises(UserError) as caught:
        run_study(folder / "study.toml", folder / "out", "tcp://127.0.0.1:9", None)
    return str(caught.value).replace(f"{folder}/", "")


def test_another_fmu_is_refused(half):
    fmu = half / "Tuned.fmu"
    with zipfile.ZipFile(fmu) as archive:
        content = {item.filename: archive.read(item) for item in archive.infolist()}
    with zipfile.ZipFile(fmu, "a") as archive:
        archive.writestr("documentation/more.txt", "more")
    assert "rows stay as they are: the content of the FMU changed. Put it back" in refused(half)
    before = read_study(half / "out").attrs["guid"]
    with zipfile.ZipFile(fmu, "w") as archive:
        for name, data in content.items():
            archive.writestr(name, data.replace(before.encode(), b"{another}"))
    assert refused(half) == (
        f'out holds another study, whose rows stay as they are: the GUID of the FMU was "{before}" and is '
        '"{another}". Put it back as it was, or give another --out.'
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("50.0, 80.0", "50.0, 81.0", "parameters.'spring.stiffness'.high was 80.0 and is 81.0."),
        ("seed = 7", "seed = 8", "seed was 7 and is 8; sampling.seed was 7 and is 8."),
        ("stop_time = 2.0", "stop_time = 2.1", "manoeuvres[1].stop_time was 2.0 and is 2.1."),
        ("max(bob.y)", "mean(bob.y)", "the measures 'highest' changed."),
        ("runs = 16", "runs = 32", "sampling.runs was 16 and is 32."),
    ],
)
def test_a_changed_study_is_refused(half, old, new, message):
    text = (half / "study.toml").read_text()
    (half / "study.toml").write_text(text.replace(old, new))
    assert f"rows stay as they are: {message} Put it back" in refused(half)


def test_only_missing_runs_are_made(finished, half, in_process, capsys):
    before = read_study(finished / "out")
    runs = half / "out" / "runs"
    again = [str(half / "study.toml"), "--out", str(half / "out"), "--no-report"]
    shutil.copy(finished / "out" / "runs" / "part-000001.parquet", runs)
    assert main([*again, "--scheduler", "tcp://127.0.0.1:9"]) == 0  # where nobody answers: nobody is asked
    assert "16 of 16 runs are there" in capsys.readouterr().out
    table = pq.ParquetFile(runs / "part-000001.parquet").read()
    pq.write_table(table.slice(3, 9), runs / "part-000001.parquet")
    assert main(again) == 0
    output = capsys.readouterr().out
    present = 16 - len(table) + len(table.slice(3, 9))  # a slow machine writes more than one part
    assert f"{present} of 16 runs are there" in output
    now = read_study(half / "out")
    assert now.drop(columns="wall_seconds").equals(before.drop(columns="wall_seconds"))
    (half / "out" / "study.json").unlink()
    assert refused(half) == "out has rows of a study but not its study.json; give another --out."


def test_two_programs_do_not_write_to_one_folder(half):
    with locked(half / "out", "It is locked."):
        assert refused(half) == (
            f"Another program runs a study in {half / 'out'}; wait for it, or give another --out."
        ).replace(f"{half}/", "")


def test_no_scheduler_is_one_sentence(half, in_process, monkeypatch):
    monkeypatch.setattr("hosts.experiment.cluster._TIMEOUT", 0.5)
    assert refused(half).startswith("No scheduler of Dask answers at tcp://127.0.0.1:9: ")


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such limit")
@pytest.mark.slow
def test_a_full_disk_keeps_the_written_rows(half, in_process):
    (half / "study.toml").write_text((half / "study.toml").read_text().replace("runs = 16", "runs = 32"))
    start = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
from hosts.experiment import store
from hosts.study import campaign
from hosts.study.outcome_table import OutcomeTable
written = OutcomeTable.write
def write(self):
    rows = self._part.rows["index"] != []
    written(self)
    if rows:  # full from now on
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, resource.RLIM_INFINITY))
OutcomeTable.write = write
store._WRITE_INTERVAL = (0.0, 0.0)
from hosts.study.command import main
from tests.hosts.in_this_process import in_this_process
with in_this_process():
    sys.exit(main())
"""
    new = half / "new"
    command = [sys.executable, "-c", start, half / "study.toml", "--out", new]
    done = subprocess.run(map(str, command), capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 2, done.stderr
    table = read_study(new)
    assert 0 < len(table) < 32
    assert done.stderr.splitlines()[-1] == (
        f"error: {new}/runs/part-000002.parquet cannot be written: file too large. {len(table)} of 32 runs are written "
        "and stay; the same command makes the others."
    )
    assert [file.name for file in (new / "runs").iterdir()] == ["part-000001.parquet"]
    assert (new / "done").is_file()
    assert run_study(half / "study.toml", new, None, 1) is not None
    assert len(read_study(new)) == 32
    assert read_study(new).loc[table.index].equals(table)


def test_a_run_is_repeated_as_a_drive(finished, capsys):
    out = finished / "out"
    assert main([str(out), "--run", "11"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if "run-11." in line]
    (words,) = [shlex.split(line) for line in lines if " run " in line]
    assert any(" view " in line for line in lines)
    assert drive(words[words.index("run") + 1 :]) == 0
    table = read_csv(out / "repeat" / "tuned_run-11.csv")
    assert max(table["bob.y"]) == read_study(out).loc[11, "highest"]
    with pytest.raises(HostError, match="There is no run 16; the study in .* has the runs 0 to 15."):
        repeater(out)(16)
