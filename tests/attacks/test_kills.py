"""Commands that are killed at random times: complete files stay; the same command resumes and removes the rest."""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest

from ali3.temporary_folder import PREFIX
from hosts.fmu.fmu import described
from hosts.recordings.recorded_drive import read_recording
from hosts.study.store import read_study
from tests.attacks.bounds import kills
from tests.hosts.odd_fmus import odd_fmu

pytestmark = [
    pytest.mark.proof,
    pytest.mark.attack,
    pytest.mark.skipif(sys.platform != "linux", reason="signals, and FMUs for Linux"),
]
_SETTLED = 20.0  # s in which what was started by a command that was killed has ended


def started(folder: Path, *arguments: object) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "ali3", *map(str, arguments)]
    places = {"TMPDIR": str(folder / "temporary"), "ALI3_CACHE": str(folder / "cache")}
    for place in places.values():
        Path(place).mkdir(exist_ok=True)
    quiet = subprocess.DEVNULL
    return subprocess.Popen(command, stdout=quiet, stderr=quiet, env=os.environ | places, start_new_session=True)


def killed(process: subprocess.Popen[bytes], after: float) -> bool:
    """Whether a command was killed after so many seconds; nothing that it has started lives on."""
    time.sleep(after)
    if process.poll() is not None:
        return False
    below = psutil.Process(process.pid).children(recursive=True)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert psutil.wait_procs(below, timeout=_SETTLED)[1] == []
    return True


def attack(what: str, longest: float, folder: Path, command: Callable[[int], tuple[object, ...]]) -> list[int]:
    """Kill commands at moments by chance; each is then run to its end. Numbers of those that were killed."""
    seed = random.SystemRandom().randrange(2**40)
    print(f"{what}: {kills()} kills, seed {seed}")
    chance, results = random.Random(seed), []
    for number in range(kills()):
        if killed(started(folder, *command(number)), chance.uniform(0.2, longest)):
            results.append(number)
        again = started(folder, *command(number))
        assert again.wait(timeout=300.0) == 0, f"{what} {number} after its kill"
    assert left(folder / "temporary") == left(folder / "cache") == []
    return results


def left(folder: Path) -> list[Path]:
    """What a command that was killed has left where the same command has been again."""
    return [place for place in folder.rglob(f"{PREFIX}*") if place.is_dir()]


def test_studies(tmp_path: Path) -> None:
    fmu = odd_fmu("long_steps", tmp_path)
    file = tmp_path / "study.toml"
    file.write_text(
        f'fmu = "{fmu}"\nstep = 0.001\n[[manoeuvres]]\nname = "stand"\nstop_time = 5.0\n[sampling]\n'
        'method = "latin_hypercube"\nruns = 60\nseed = 1\n[parameters]\nu = { range = [1.0, 2.0] }\n'
        '[measures]\ntop = "max(y)"\n'
    )
    out = {k: tmp_path / f"out_{k}" for k in range(kills())}
    attack("study", 8.0, tmp_path, lambda k: ("study", file, "--out", out[k], "--no-report", "--jobs", 1))
    for folder in out.values():
        assert left(folder) == []
        table = read_study(folder)
        assert sorted(table.index) == list(range(60))
        assert (table["status"] == "done").all()
        assert abs(table["top"] / table["u"] - 5.0).max() < 1e-9


def test_builds(tmp_path: Path) -> None:
    out = tmp_path / "dist"
    options = ("--scene", "slider_crank", "--kind", "native", "--platforms", "this")
    attack("build", 6.0, tmp_path, lambda k: ("build", *options, "--out", out))
    assert left(out) == []
    (fmu,) = out.glob("*.fmu")
    assert described(fmu).modelVariables


def test_recordings(tmp_path: Path) -> None:
    fmu = odd_fmu("long_steps", tmp_path)
    paths = {k: tmp_path / f"drive_{k}" for k in range(2 * kills())}
    used = iter(paths)

    def command(number: int) -> tuple[object, ...]:
        how = ("--headless", "--stop-time", 3, "--step", 0.01, "--interval", 0.01)
        return ("simulator", fmu, *how, "--record", paths[next(used)])

    lost = attack("recording", 4.0, tmp_path, command)
    for number in range(kills()):
        whole = read_recording(paths[2 * number + 1])
        assert whole.notes == []
        assert sum(len(rows) for rows in whole.blocks()) == 301
    for number in lost:
        if (paths[2 * number] / "recording.json").is_file():
            cut = read_recording(paths[2 * number])
            counts = [int(k) for rows in cut.unbroken() for k in rows.steps]
            assert counts == list(range(len(counts)))
            assert len(counts) <= 301
