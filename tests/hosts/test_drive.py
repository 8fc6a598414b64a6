"""The command from FMU to table and picture: once as a program, as a user runs it, then in this process."""

import os
import re
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from fmpy import platform
from fmpy.util import read_csv
from matplotlib import image

from ali3.locks import locked
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.run_checks import communication_step
from hosts.fmu.fmu import Fmu
from hosts.run.command import main
from tests.hosts.changed_fmu import changed_fmu
from tests.in_process import run

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
TURN = '"time","steering","throttle","brake"\n0,0,0,0\n1,0,1,0\n1,0.5,1,0\n3,0,1,0.5\n'


@pytest.fixture(scope="module")
def fmus(scene_fmu: Callable[..., Path]) -> dict[str, Path]:
    scenes = {"sledge": HERE / "scenes.py", "motor_pendulum": ROOT / "examples" / "motor_pendulum.py"}
    return {function: scene_fmu(f"{file}:{function}") for function, file in scenes.items()}


@pytest.fixture
def turn(tmp_path: Path) -> Path:
    (tmp_path / "turn.csv").write_text("# start: initial.speed=10\n" + TURN)
    return tmp_path / "turn.csv"


def colours(picture: Path) -> int:
    pixels = (255 * image.imread(picture)[..., :3]).astype(int)
    return len(np.unique(pixels.reshape(-1, 3), axis=0))


def test_an_fmu_for_other_platforms_is_refused_with_their_names(fmus, tmp_path):
    binary = f"binaries/{platform}/"
    with zipfile.ZipFile(fmus["sledge"]) as archive:
        libraries = {name: archive.read(name) for name in archive.namelist() if name.startswith(binary)}
    other = {name.replace(platform, "amiga"): content for name, content in libraries.items()}
    for added, present in ((other, "it has those for amiga"), ({}, "it has none")):
        file = changed_fmu(fmus["sledge"], tmp_path / "Other.fmu", dict.fromkeys(libraries) | added)
        with (
            Fmu(file) as fmu,
            pytest.raises(
                HostError,
                match=f"no library for {platform}; {present}. .*--fmu {file} --platforms this --out {tmp_path}",
            ),
        ):
            fmu.load()


@pytest.mark.slow
def test_car_page_table_and_summary(fmus, turn, tmp_path):
    command = [sys.executable, "-m", "ali3", "run", fmus["sledge"], "--manoeuvre", turn, "--step", "0.02"]
    utf8 = os.environ | {"PYTHONIOENCODING": "utf-8"}
    command = [*map(str, command), "--out", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=utf8)
    assert done.returncode == 0, done.stderr
    for row in (
        "distance driven",
        "speed at start, top, end",
        "wheels in the air",
        "largest wheel load",
        "failed steps",
    ):
        assert row in done.stdout
    assert "0 of 150" in done.stdout
    assert "change of the energy" not in done.stdout  # the sledge does not tell its works
    assert "3.00 s simulated in" in done.stdout
    table = read_csv(tmp_path / "out" / "sledge_turn.csv")
    assert table["time"] == pytest.approx(0.02 * np.arange(151))
    assert table["chassis.x"][0] == 0.0
    assert table["speed"][0] == pytest.approx(10.0)
    # The inputs of a row are those with which the next step begins.
    assert (table["steering"][49], table["steering"][50]) == (0.0, 0.5)
    picture = tmp_path / "out" / "sledge_turn.png"
    height, width = image.imread(picture).shape[:2]
    assert width == 1760
    assert height > 900
    assert colours(picture) > 200


@pytest.mark.slow
@pytest.mark.parametrize("held", ["", "# held: steering, brake\n"])
def test_a_result_is_a_manoeuvre_that_repeats_the_run(fmus, turn, tmp_path, held):
    turn.write_text(held + turn.read_text())
    result = tmp_path / "out" / "sledge_turn.csv"
    for table, step in ((turn, ("--step", "0.02")), (result, ())):  # the record knows the step
        assert run(main, fmus["sledge"], "-m", table, *step, "--out", tmp_path / "out").returncode == 0
    first, again = read_csv(result), read_csv(tmp_path / "out" / "sledge_sledge_turn.csv")
    for name in first.dtype.names:
        np.testing.assert_allclose(again[name], first[name], rtol=1e-9, atol=1e-9, err_msg=name)
    assert np.ptp(first["chassis.x"]) > 10.0
    assert (first["steering"][100] in (0.0, 0.5)) == bool(held)


@pytest.mark.slow
def test_a_result_that_began_with_a_state_repeats_the_run(fmus, turn, tmp_path):
    with Fmu(fmus["sledge"]) as fmu:
        fmu.initialise({"steering": 0.2, "throttle": 0.5})
        for k in range(200):
            fmu.step(0.01 * k, 0.01)
        (tmp_path / "moving.state").write_bytes(fmu.state_bytes())
    turn.write_text("# state: moving.state at 2\n" + turn.read_text())
    for table in (turn, tmp_path / "out" / "sledge_turn.csv"):
        assert run(main, fmus["sledge"], "-m", table, "--out", tmp_path / "out").returncode == 0
    first, again = read_csv(tmp_path / "out" / "sledge_turn.csv"), read_csv(tmp_path / "out" / "sledge_sledge_turn.csv")
    assert first["chassis.x"][0] > 1e-3  # at the ordinary start it is 0
    for name in first.dtype.names:
        np.testing.assert_allclose(again[name], first[name], rtol=1e-9, atol=1e-9, err_msg=name)


@pytest.mark.slow
@pytest.mark.drawn
def test_any_fmu_gets_a_page(fmus, tmp_path):
    (tmp_path / "swing.csv").write_text('"time","torque"\n0,0\n1,0\n1,4\n2,4\n')
    done = run(main, fmus["motor_pendulum"], "-m", tmp_path / "swing.csv", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    table = read_csv(tmp_path / "motor_pendulum_swing.csv")
    assert np.ptp(table["rod.angle"]) > 0.5
    assert np.ptp(table["rod.angle"][:100]) < 1e-9
    assert colours(tmp_path / "motor_pendulum_swing.png") > 100


@pytest.mark.slow
@pytest.mark.drawn
def test_a_car_that_stands_still_gets_a_page_without_a_warning(fmus, tmp_path):
    (tmp_path / "rest.csv").write_text('"time","throttle"\n0,0\n1,0\n')
    done = run(main, fmus["sledge"], "-m", tmp_path / "rest.csv", "--out", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "distance driven            0.00 m" in done.stdout


@pytest.mark.slow
def test_messages_of_the_fmu_are_shown(fmus, tmp_path):
    """Beyond the range by rounding is driven, and the FMU speaks of it."""
    (tmp_path / "hard.csv").write_text('"time","torque"\n0,0\n1,20.00003\n1.1,20.00003\n')
    done = run(main, fmus["motor_pendulum"], "-m", tmp_path / "hard.csv", "--out", tmp_path)
    assert done.returncode == 0
    assert "FMU: 'torque' was set to" in done.stdout


def test_a_missing_fmu_is_reported_with_the_command_that_builds_it(turn, tmp_path):
    done = run(main, tmp_path / "dist" / "PrototypeCar.fmu", "-m", turn)
    assert done.returncode == 2
    assert "There is no file" in done.stderr
    assert "python build_fmu.py" in done.stderr


def test_bad_files_are_named(fmus, turn, tmp_path):
    (tmp_path / "text.fmu").write_text("no zip")
    assert "is not an FMU" in run(main, tmp_path / "text.fmu", "-m", turn).stderr
    assert "is a folder; it must be a file" in run(main, tmp_path, "-m", turn).stderr
    (tmp_path / "u.csv").write_text('"time","lever"\n0,0\n1,0\n')
    done = run(main, fmus["sledge"], "-m", tmp_path / "u.csv")
    assert done.returncode == 2
    assert "'lever', which is not an input" in done.stderr
    assert "steering, throttle, brake" in done.stderr
    assert "must be a positive, finite time" in run(main, fmus["sledge"], "-m", turn, "--step", -1).stderr
    assert "cannot be made" in run(main, fmus["sledge"], "-m", turn, "--out", tmp_path / "u.csv" / "out").stderr
    assert "driver needs variables" in run(main, fmus["motor_pendulum"], "-m", "double_lane_change").stderr


def test_runs_that_no_memory_holds_are_refused(fmus, turn, tmp_path):
    done = run(main, fmus["sledge"], "-m", turn, "--step", 1e-9, "--out", tmp_path / "out")
    assert done.returncode == 2
    assert "3 s in steps of 1e-09 s are 3e+09 rows of" in done.stderr
    assert re.search(r"take steps of at least [0-9.e-]+ s\.$", done.stderr.strip())
    done = run(main, fmus["sledge"], "--stop-time", "inf", "--out", tmp_path / "out")
    assert "argument --stop-time: 'inf' is given; it must be a positive, finite time in s" in done.stderr
    done = run(main, fmus["sledge"], "-m", turn, "--stop-time", 1e12, "--out", tmp_path / "out")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "1e+12 s in steps of" in done.stderr
    longest = re.search(r"take a stop time of at most (\S+) s\.$", done.stderr.strip())
    assert longest is not None
    with Fmu(fmus["sledge"]) as fmu:  # the remedy is taken, and little more is not; fewer rows hold a longer time

        def step_of(stop: float, interval: float | None = None) -> float:
            return communication_step(fmu, Manoeuvre("", np.zeros(0), {}, stop), None, interval)

        step = step_of(float(longest[1]))
        with pytest.raises(HostError, match="take a stop time of at most"):
            step_of(1.2 * float(longest[1]))
        assert step_of(1.2 * float(longest[1]), 2.0 * step) == step
    assert not (tmp_path / "out").exists()


def test_results_that_cannot_be_written_are_refused_before_the_drive(fmus, turn, tmp_path):
    (tmp_path / "out" / "sledge_turn.csv").mkdir(parents=True)
    done = run(main, fmus["sledge"], "-m", turn, "--out", tmp_path / "out")
    assert done.returncode == 2
    assert done.stderr == f"error: {tmp_path}/out/sledge_turn.csv is a folder; it must be a file.\n"
    if sys.platform == "linux":
        done = run(main, fmus["sledge"], "-m", turn, "--out", "/proc/out")
        assert done.returncode == 2
        assert done.stderr.startswith("error: /proc/out cannot be written: ")


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such limit")
@pytest.mark.slow
def test_a_full_disk_leaves_no_table(fmus, turn, tmp_path):
    start = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000));"
        "from hosts.run.command import main; sys.exit(main())"
    )
    out = tmp_path / "out"
    command = [sys.executable, "-c", start, fmus["sledge"], "-m", turn, "--step", "2e-4", "--out", out]
    done = subprocess.run(map(str, command), capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 2, done.stderr
    assert re.search(
        r"^error: The rows of the run take [\d.]+ MB, which cannot be kept: file too large\.$", done.stderr, re.M
    )
    assert not out.exists() or list(out.iterdir()) == []


def test_files_of_runs_into_one_folder_are_of_one_run(fmus, tmp_path):
    command = [sys.executable, "-m", "ali3", "run", fmus["sledge"], "--stop-time", "0.1", "--out", tmp_path]
    with locked(tmp_path):  # as another run that writes its files
        other = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL)
        with pytest.raises(subprocess.TimeoutExpired):
            other.wait(8.0)
        assert not [*tmp_path.glob("[!.]*")]
    assert other.wait() == 0
    assert {path.suffix for path in tmp_path.glob("[!.]*")} == {".csv", ".png", ".json"}
