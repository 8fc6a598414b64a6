"""Option ``--confined``: an FMU reaches nothing of the host, gives the same bits, and is reported as without it."""

import socket
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from ali3.confinement import _bubblewrap, confine
from ali3.errors import UserError
from hosts.catalogue.command import main as catalogue
from hosts.fmu.instance import Instance
from hosts.recordings.recorded_drive import read_recording
from hosts.run.command import main as drive
from hosts.simulator.command import main as simulator
from hosts.study.command import main as study
from hosts.study.store import read_study
from tests.hosts.odd_fmus import odd_fmu
from tests.hosts.test_foreign_fmus import CRASH, driven
from tests.in_process import run

pytestmark = pytest.mark.slow
_ALL = 63.0  # what `reaching.c` reaches of a host


@pytest.fixture(autouse=True)
def confining(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ALI3_CONFINED", "")  # put back at the end
    monkeypatch.delenv("ALI3_CONFINED")
    try:
        confine()
    except UserError as error:
        pytest.skip(str(error))
    monkeypatch.delenv("ALI3_CONFINED")


@dataclass
class Host:
    """What an FMU tries to reach; `port`: of an address."""

    fmu: Path
    home: Path
    port: int


@pytest.fixture
def host(tmp_path: Path) -> Iterator[Host]:
    home = tmp_path / "home"
    home.mkdir()
    (home / "letter").write_text("private")
    with ExitStack() as stack:
        name = str(Path(stack.enter_context(tempfile.TemporaryDirectory(dir="/tmp")), "s"))
        for place in (name, f"\0{name}"):
            bound = stack.enter_context(socket.socket(socket.AF_UNIX))
            bound.bind(place)
            bound.listen(100)
        port = stack.enter_context(socket.create_server(("127.0.0.1", 0))).getsockname()[1]
        yield Host(odd_fmu("reaching", tmp_path, f'TRIED_FOLDER="{home}"', f'TRIED_SOCKET="{name}"'), home, port)


def by_run(host: Host, out: Path, *options: str) -> set[float]:
    code, output, rows = driven(host.fmu, out, host.port, *options)
    assert code == 0, output
    return set(rows[1:, 2])


def by_simulator(host: Host, out: Path, *options: str) -> set[float]:
    steps = ("--stop-time", 0.05, "--step", 0.01, "--interval", 0.01)
    done = run(simulator, host.fmu, "--headless", *steps, "--set", f"u={host.port}", "--record", out, *options)
    assert done.returncode == 0, done.stderr
    return set(np.concatenate([rows.values[1:, 1] for rows in read_recording(out).blocks()]))


def by_replay(host: Host, out: Path, *options: str) -> set[float]:
    """Of a drive that was recorded without limits: it reaches nothing when it is repeated."""
    by_simulator(host, out)
    (host.home / "written").unlink()
    done = run(simulator, "--recording", out, "--replay", *options)
    return {0.0} if f"y at 0.01 s, after 1 steps: recorded {_ALL}, repeated 0.0" in done.stdout else set()


def by_study(host: Host, out: Path, *options: str) -> set[float]:
    file = out.parent / "reached.toml"
    file.write_text(
        f'fmu = "{host.fmu}"\n[[manoeuvres]]\nname = "stand"\nstop_time = 0.05\n[sampling]\nmethod = "grid"\n'
        f'[parameters]\nu = {{ values = [{host.port}.0] }}\n[measures]\ntop = "max(y)"\n'
    )
    done = run(study, file, "--out", out, "--no-report", "--jobs", 1, *options)
    assert done.returncode == 0, done.stdout + done.stderr
    return set(read_study(out)["top"])


@pytest.mark.parametrize("reached", [by_run, by_simulator, by_replay, by_study])
def test_an_fmu_reaches_nothing_of_the_host(host, tmp_path, reached):
    if reached == by_run:
        assert by_run(host, tmp_path / "free") == {_ALL}
        (host.home / "written").unlink()
    assert reached(host, tmp_path / "bound", "--confined") == {0.0}
    assert sorted(p.name for p in host.home.iterdir()) == ["letter"]


@pytest.mark.parametrize("what", ["prototype", "faults"])
def test_the_same_bits_come_out(what, prototype_fmu, tmp_path):
    options: tuple[object, ...] = ()
    if what == "prototype":
        fmu, options = prototype_fmu, ("-m", "double_lane_change", "--stop-time", 0.5)
    else:
        fmu = odd_fmu(what, tmp_path)
    tables = []
    for name, more in (("free", ()), ("bound", ("--confined",))):
        done = run(drive, fmu, *options, "--out", tmp_path / name, *more)
        assert done.returncode == 0, done.stderr
        (table,) = (tmp_path / name).glob("*.csv")
        tables.append(table.read_bytes())
    assert tables[0] == tables[1]


def test_the_catalogue_drives_in_another_process(prototype_fmu, tmp_path, monkeypatch):
    def never(*_: object) -> None:
        raise AssertionError("the library of an FMU is loaded in the process of the command")

    monkeypatch.setattr(Instance, "__init__", never)
    done = run(catalogue, prototype_fmu, "--tests", "drop", "--jobs", 1, "--out", tmp_path, "--confined")
    assert done.returncode == 0, done.stdout + done.stderr
    assert len(list(tmp_path.glob("runs/*/*.csv"))) > 0


def test_a_crash_is_reported_as_without_confinement(tmp_path):
    code, output, table = driven(odd_fmu("faults", tmp_path), tmp_path / "out", CRASH, "--confined")
    assert code == 1
    assert "The process of the FMU crashed (SIGSEGV) in fmi2DoStep at 0.04 s; 5 rows were kept." in output
    assert len(table) == 5


def test_without_bubblewrap_nothing_is_run(tmp_path, monkeypatch):
    fmu = odd_fmu("faults", tmp_path)
    _bubblewrap.cache_clear()
    monkeypatch.setenv("PATH", str(tmp_path))
    for main in (drive, simulator, catalogue):
        done = run(main, fmu, "--confined", "--out" if main != simulator else "--record", tmp_path / "out")
        message = "error: --confined is not possible here, and nothing was run: install bubblewrap (bwrap).\n"
        assert (done.returncode, done.stderr) == (2, message)
    _bubblewrap.cache_clear()
    assert not (tmp_path / "out").exists()
