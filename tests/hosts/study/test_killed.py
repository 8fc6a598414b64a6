"""Command, scheduler and workers are killed during a study: no row is lost and none is made twice."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import islice
from pathlib import Path
from types import SimpleNamespace
from typing import TypeAlias

import numpy as np
import psutil
import pyarrow.parquet as pq
import pytest
from distributed import Client
from distributed.comm import CommClosedError

from hosts.common.errors import HostError
from hosts.experiment.cluster import send_experiment
from hosts.experiment.cluster_runs import ClusterRuns
from hosts.experiment.cluster_worker import UnpackedFmu
from hosts.experiment.store import Journal
from hosts.study.command import main
from hosts.study.outcome_table import Row
from hosts.study.parts import part_files
from hosts.study.store import read_study
from hosts.study.worker_data import Outcome, Run

ROOT = Path(__file__).parents[3]
RUNS = 140
ResultStore: TypeAlias = tuple[str, Row]
SLOW = """
import time

def value(result, parameters):
    time.sleep(0.1)
    return float(parameters["spring.stiffness"])

value.units = "N/m"
"""
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")

NOT_ENCRYPTED = (
    "note: The scheduler {} is used without TLS: whoever reaches it or its workers can run programs as their user. "
    "The page on studies of the documentation says how certificates are set."
)


@pytest.fixture
def slow_study(study_file: Callable[..., Path], tmp_path: Path) -> Path:
    """A study whose runs take a tenth of a second each."""
    (tmp_path / "slow.py").write_text(SLOW)
    runs = ("runs = 16", f"runs = {RUNS}"), ('"sobol"', '"latin_hypercube"')
    return study_file(*runs, ('"max(bob.y)"', '"max(bob.y)"\nslow = "slow.py:value"'))


def command(*arguments: object) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "ali3", "study", *map(str, arguments), "--no-report"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        start_new_session=True,
    )


def said(error: str) -> list[str]:
    """Lines but those of the progress bar."""
    return [line for line in error.splitlines() if not line.startswith("study")]


def wait_for_part(folder: Path, process: subprocess.Popen[str], parts: int) -> None:
    end = time.monotonic() + 400.0  # of a machine that others use
    while len(part_files(folder)) < parts:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.02)


def rows(folder: Path) -> dict[int, tuple[object, ...]]:
    """All rows as they are on the disk; fails if a run occurs twice."""
    results: dict[int, tuple[object, ...]] = {}
    for file in part_files(folder):
        for row in pq.ParquetFile(file).read().to_pylist():
            assert row["index"] not in results
            results[row["index"]] = tuple(row.values())
    return results


def noted(journal: Path, copy: Path) -> set[int]:
    """Runs in the journal; a copy is read, because a reader removes what is not yet whole."""
    with suppress(FileNotFoundError):
        copy.unlink(missing_ok=True)
        shutil.copy(journal, copy)
    return {int(key) for key in Journal[ResultStore](copy, ResultStore).read()}


def check_complete(folder: Path) -> None:
    assert sorted(rows(folder)) == list(range(RUNS))
    table = read_study(folder)
    assert (table["status"] == "done").all()
    assert np.array_equal(table["slow"], table["spring.stiffness"])


@pytest.mark.slow
def test_a_kill_loses_only_the_runs_in_progress(slow_study, tmp_path, in_process, capsys):
    """Of those before, some are in a part and some in the journal alone; none is made again."""
    out, journal = tmp_path / "out", tmp_path / "out" / "done"
    process = command(slow_study, "--out", out, "--jobs", 1)
    wait_for_part(out, process, 1)
    while not noted(journal, tmp_path / "copy") - rows(out).keys():
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    children = psutil.Process(process.pid).children(recursive=True)
    process.kill()
    process.communicate()
    assert psutil.wait_procs(children, timeout=30.0)[1] == []  # the workers end with the command
    before = rows(out)
    count = len({*before} | noted(journal, tmp_path / "copy"))
    assert 0 < len(before) < count < RUNS
    assert main([str(slow_study), "--out", str(out), "--no-report"]) == 0
    output = capsys.readouterr().out
    assert f"{count} of {RUNS} runs are there" in output
    assert f"{RUNS - count} runs in " in output
    assert not journal.exists()
    now = rows(out)
    assert {index: now[index] for index in before} == before
    check_complete(out)


@contextmanager
def own_scheduler(folder: Path) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """A scheduler and a worker, each a program of its own."""
    file = folder / "scheduler.json"
    start = "import sys; from distributed.cli.{0} import main; sys.argv[0] = '{0}'; main()"
    local = ("--host", "127.0.0.1", "--dashboard-address", "127.0.0.1:0")
    one = ("--nthreads", "1", "--death-timeout", "30", "--local-directory", str(folder))
    scheduler = subprocess.Popen(
        [sys.executable, "-c", start.format("dask_scheduler"), *local, "--port", "0", "--scheduler-file", str(file)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    worker = subprocess.Popen(
        [sys.executable, "-c", start.format("dask_worker"), *local, "--scheduler-file", str(file), *one],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        cwd=ROOT,
    )
    try:
        end = time.monotonic() + 60.0
        while not file.is_file():
            assert time.monotonic() < end
            time.sleep(0.05)
        with Client(scheduler_file=str(file), set_as_default=False, timeout=30) as client:
            client.wait_for_workers(1, timeout=60)
            address = client.scheduler.address
        yield address, scheduler
    finally:
        for process in (worker, scheduler):
            for child in psutil.Process(process.pid).children(recursive=True) if process.poll() is None else []:
                child.kill()
            process.kill()
            process.wait()


@pytest.mark.slow
def test_a_cluster_loses_a_worker_the_command_and_the_scheduler(slow_study, tmp_path, in_process):
    """Each in the middle of a study, whose other runs are made without a cluster at last."""
    out = tmp_path / "out"
    with own_scheduler(tmp_path) as (address, scheduler):
        process = command(slow_study, "--out", out, "--scheduler", address)
        wait_for_part(out, process, 1)
        with Client(address, set_as_default=False) as client:

            def given() -> list[str]:
                """Names of what a study has left on the scheduler and on its worker."""
                names = client.run_on_scheduler(lambda dask_scheduler: list(dask_scheduler.worker_plugins))
                names += [n for of in client.run(lambda dask_worker: list(dask_worker.plugins)).values() for n in of]
                return [name for name in names if name.startswith("ali3-")]

            os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
            wait_for_part(out, process, 2)  # by a new worker
            assert given() != []
            process.send_signal(signal.SIGINT)
            _, error = process.communicate(timeout=120.0)
            assert process.returncode == 130
            assert said(error)[0] == NOT_ENCRYPTED.format(address)
            assert given() == []
        rows(out)
        out = tmp_path / "other"
        process = command(slow_study, "--out", out, "--scheduler", address)
        wait_for_part(out, process, 1)
        scheduler.send_signal(signal.SIGKILL)
        _, error = process.communicate(timeout=120.0)
    assert process.returncode == 1
    before = rows(out)
    assert 0 < len(before) < RUNS
    assert error.splitlines()[-1] == (
        f"The scheduler at {address} has gone. {len(before)} of {RUNS} runs are written and stay; the same command "
        "makes the others."
    )
    assert main([str(slow_study), "--out", str(out), "--no-report"]) == 0
    now = rows(out)
    assert {index: now[index] for index in before} == before
    check_complete(out)


@pytest.mark.parametrize("count", [9, 16])
def test_the_exit_code_depends_on_missing_rows_and_not_on_errors_of_dask(
    count: int, study_file: Callable[..., Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, in_process: None,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """The connection breaks when so many of 16 rows have come: in the middle, or when the study is taken away."""

    @contextmanager
    def broken(*_: object) -> Iterator[SimpleNamespace]:
        yield SimpleNamespace(nthreads=lambda: {"a": 1})

    def results(_: object, runs: Iterator[Run], __: object) -> Iterator[tuple[int, Outcome]]:
        for number, _ in enumerate(islice(runs, count)):
            yield number, Outcome(measures={"lowest": 0.1, "highest": 0.2})
        raise CommClosedError("in <TCP local=...>: Stream is closed")

    monkeypatch.setattr("hosts.experiment.cluster.connected", broken)
    monkeypatch.setattr("hosts.experiment.cluster.send_experiment", lambda *_: None)
    monkeypatch.setattr(ClusterRuns, "results", results)
    code = main([str(study_file()), "--out", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:9", "--no-report"])
    assert len(read_study(tmp_path / "out")) == count
    assert code == (0 if count == 16 else 1)
    gone = "The scheduler at tcp://127.0.0.1:9 has gone. 9 of 16 runs are written and stay; the same command makes the"
    assert (gone in capsys.readouterr().err) == (count == 9)


@pytest.mark.slow
def test_ctrl_c_keeps_finished_runs(slow_study, tmp_path):
    out = tmp_path / "out"
    process = command(slow_study, "--out", out, "--jobs", 2)
    wait_for_part(out, process, 1)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, error = process.communicate(timeout=120.0)
    assert process.returncode == 130
    message = f"{len(rows(out))} of {RUNS} runs are written and stay; the same command makes the others."
    assert error.strip().splitlines()[-2:] == [message, "stopped by Ctrl-C"]
    assert 0 < len(rows(out)) < RUNS


def test_a_worker_that_ends_too_early_is_reported_as_such():
    class Lost:
        def register_plugin(self, _: object) -> None:
            raise CommClosedError("in <TCP local=...>: Stream is closed")

    brought = UnpackedFmu("a", "none.fmu", "", "", lambda path: None)  # type: ignore[arg-type, return-value]
    with pytest.raises(
        HostError, match="A worker has ended or was disconnected before it had received what to run"
    ) as caught:
        send_experiment(Lost(), brought, Path(__file__))  # type: ignore[arg-type]
    assert "version" not in str(caught.value)
