"""The command without a page, with a car in its process: report, manoeuvres, aliases, and refusals."""

import importlib.util
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import pytest

from ali3 import bars
from ali3.scene.scene import scene_errors
from hosts.common import commands
from hosts.common.errors import HostError
from hosts.common.options import FmuOptions
from hosts.driving.random_driver import RandomDriver
from hosts.fmu import built_fmu
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.file import read_aliases
from hosts.fmu.fmu_source import FmuSource
from hosts.recordings.load_manoeuvre import load_manoeuvre
from hosts.recordings.recorded_drive import read_recording
from hosts.recordings.written_tables import ParquetTable
from hosts.simulator.aliased_car import AliasedCar
from hosts.simulator.car import Car, CarSettings
from hosts.simulator.command import main
from hosts.simulator.headless_driving import headless_driver, run_headless
from hosts.simulator.preparation import DriveRequest, prepare
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu
from tests.hosts.simulator.pages import PATIENCE, until

TESTS = Path(__file__).parents[2]
TURN = '"time","steering","throttle","brake"\n0,0,0,0\n1,0,1,0\n1,0.5,1,0\n3,0,1,0.5\n'


@pytest.fixture
def fmus(fmu):
    return {scene: fmu(scene) for scene in ("sledge", "reach")}


@pytest.fixture
def told(capsys):
    """What the command said: run it, give exit code, lines, and the error."""

    def run(*arguments):
        code = main([str(a) for a in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err.strip().splitlines()[-1] if captured.err.strip() else ""

    return run


def test_a_run_without_a_page_ends_with_its_report(fmus, told, tmp_path):
    code, out, _ = told(
        fmus["sledge"], "--headless", "--stop-time", 0.5, "--step", 0.005, "--json", tmp_path / "r.json"
    )
    assert code == 0
    assert "100 steps of 5 ms: 0.500 s simulated in " in out
    assert "missed deadlines: " in out
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["steps"]["steps"] == 100
    assert report["steps"]["simulated"] == pytest.approx(0.5)
    assert report["steps"]["wall"] >= 0.45  # paced
    assert sum(n for _, n in report["steps"]["cost"]["bins"]) == 100
    assert report["seconds since the start"]["ready"] > 0.0
    assert "warm: the FMU was there" in out


@pytest.mark.skipif(os.name == "nt", reason="Windows ends a process without asking it")
@pytest.mark.slow
def test_a_run_without_a_page_that_is_ended_ends_with_its_report(fmus, tmp_path):
    command = [sys.executable, "-m", "ali3", "simulator", str(fmus["sledge"]), "--headless", "--stop-time", "600"]
    command += ["--step", "0.005", "--record", str(tmp_path / "drive")]
    pipe = subprocess.PIPE
    quiet = os.environ | {"TQDM_DISABLE": "1"}  # a busy machine takes more than two seconds to end a recording
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, start_new_session=True, env=quiet) as program:
        assert any(line.startswith("Ready") for line in program.stdout)
        time.sleep(0.5)
        os.killpg(program.pid, signal.SIGTERM)  # as a terminal and `timeout` do
        output, error = program.communicate(timeout=PATIENCE)
    assert (program.returncode, error) == (0, "")
    assert "Ended by Ctrl-C or a signal." in output
    steps = int(re.search(r"(\d+) steps of 5 ms: ", output)[1])
    assert sum(len(rows) for rows in read_recording(tmp_path / "drive").blocks()) > steps


@pytest.mark.skipif(os.name == "nt", reason="there are no such terminals")
@pytest.mark.slow
def test_a_terminal_that_is_closed_leaves_a_whole_recording(fmus, tmp_path):
    ours, theirs = os.openpty()
    command = [sys.executable, "-m", "ali3", "simulator", str(fmus["sledge"]), "--headless", "--stop-time", "600"]
    command += ["--step", "0.005", "--record", str(tmp_path / "drive"), "--json", str(tmp_path / "report.json")]
    take = "import fcntl, termios, os, sys; fcntl.ioctl(0, termios.TIOCSCTTY, 0); os.execv(sys.argv[1], sys.argv[1:])"
    program = subprocess.Popen(
        [sys.executable, "-c", take, *command], stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True
    )
    os.close(theirs)
    output = b""
    while b"Ready" not in output:
        output += os.read(ours, 1000)
    time.sleep(0.5)
    os.close(ours)
    assert program.wait(timeout=PATIENCE) == 0
    steps = json.loads((tmp_path / "report.json").read_text())["steps"]["steps"]
    assert sum(len(rows) for rows in read_recording(tmp_path / "drive").blocks()) > steps > 0


def test_a_recording_that_cannot_be_finished_is_reported_in_the_report(fmus, told, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(ParquetTable, "close", full)
    files = ("--record", tmp_path / "r", "--json", tmp_path / "j")
    code, out, _ = told(fmus["sledge"], "--headless", "--stop-time", 0.1, "--step", 0.005, *files)
    assert code == 1
    assert out.count("The recording could not be finished: ") == 1
    assert "make room, or record into another folder" in out
    events = json.loads((tmp_path / "j").read_text())["events"]
    assert sum("No space left on device" in event["text"] for event in events) == 1


@contextmanager
def started(fmu, aliases=None, **start):
    with Car(CarSettings(fmu, start, 0.005, priority=False)) as car:
        yield AliasedCar(car, FmuSource(fmu, aliases or Aliases()))


def value(car, name):
    return float(car.latest().values[car.names.index(name)])


def test_a_driver_at_random_and_a_manoeuvre_move_the_inputs_by_the_clock_of_the_car(fmus, tmp_path):
    (tmp_path / "turn.csv").write_text(TURN)
    manoeuvre = load_manoeuvre(str(tmp_path / "turn.csv"))
    expected = RandomDriver(5, ("steering", "throttle", "brake")).act(0.0, {})
    assert any(expected.values())
    with started(fmus["sledge"]) as car:
        assert run_headless(car, headless_driver(car, None, 5), 0.1, lambda *_: None)
        assert {name: value(car, name) for name in expected} == expected
        car.command("reset")
        until(lambda: car.latest().epoch == 1)
        car.command("speed", 0.1)  # a busy machine holds the command up for a little of the car's time then
        assert run_headless(car, headless_driver(car, manoeuvre, None), 0.3, lambda *_: None)
        moment = car.latest()
        assert (moment.count, moment.running) == (20 + 60, False)
        assert value(car, "throttle") == pytest.approx(0.3, abs=0.15)  # it is read some milliseconds before its step
        assert value(car, "speed") > 0.0
        assert value(car, "steering") == 0.0


def test_a_manoeuvre_that_needs_more_than_the_car_has(tmp_path):
    (tmp_path / "sail.csv").write_text('"time","sail"\n0,0\n1,1\n')
    car = SimpleNamespace(inputs=("pull",), names=("pull", "bob.x"), constants={})
    with pytest.raises(HostError, match="a column 'sail', which is not an input"):
        headless_driver(car, load_manoeuvre(str(tmp_path / "sail.csv")), None)
    with pytest.raises(HostError, match="does not have: steering, throttle, brake"):
        headless_driver(car, load_manoeuvre("double_lane_change"), None)


def test_a_refused_step_ends_the_run_with_the_message_of_the_fmu(fmus, told, tmp_path):
    (tmp_path / "pull.csv").write_text('"time","pull"\n0.1,0\n1.1,10\n')
    arguments = ("--headless", "-m", tmp_path / "pull.csv", "--stop-time", 5, "--step", 0.01)
    code, out, _ = told(fmus["reach"], *arguments, "--json", tmp_path / "r")
    assert code == 1
    assert "begin of the table: at 0.1 s; before, its first row holds pull at 0\n" in out
    report = json.loads((tmp_path / "r").read_text())
    assert report["event counts"]["refused"] == 1
    assert report["steps"]["simulated"] < 1.0
    assert next(e["text"] for e in report["events"] if e["kind"] == "refused") in out


NAMES = {"steering": "StrAng", "throttle": "Acc_ped", "brake": "Brk", "chassis.x": "X", "chassis.yaw": "Psi"}
ALIASES = """
steering = { name = "StrAng", factor = 0.5 }
throttle = "Acc_ped"
brake = "Brk"
"chassis.x" = { name = "X", factor = 0.001 }
"chassis.yaw" = "Psi"
"""


@pytest.fixture
def renamed(fmus, tmp_path):
    """The sledge as another program would name its variables."""

    def foreign(content: bytes) -> bytes:
        for ours, theirs in NAMES.items():
            content = content.replace(f'name="{ours}"'.encode(), f'name="{theirs}"'.encode())
        # One that is in kilometres, of which the other program says nothing.
        return re.sub(rb'(name="X"[^>]*>\s*<Real)[^>]*', rb"\1 /", content)

    changes = {DESCRIPTION: foreign, "resources/geometry.json": None}
    return changed_fmu(fmus["sledge"], tmp_path / "foreign.fmu", changes)


@pytest.mark.slow
def test_an_fmu_with_other_names_runs_and_missing_variables_are_reported(renamed, told):
    code, out, _ = told(renamed, "--headless", "--stop-time", 0.1)
    assert code == 0
    missing = "no input steering, throttle, brake and no output chassis.x, chassis.z, chassis.yaw, which"
    assert f"foreign.fmu has {missing}" in out
    assert "(--aliases FILE). Its inputs are StrAng, Acc_ped, Brk; its outputs X," in out
    assert "is not drawn" in out


@pytest.mark.slow
def test_an_alias_file_gives_it_our_names(renamed, told, tmp_path):
    (tmp_path / "names.toml").write_text(ALIASES)
    out = told(renamed, "--headless", "--stop-time", 0.1, "--aliases", tmp_path / "names.toml")[1]
    assert "foreign.fmu has no output chassis.z, which driving needs." in out
    aliases = read_aliases(tmp_path / "names.toml", [*NAMES.values(), "chassis.y", "speed"])
    with started(renamed, aliases) as car:
        assert car.inputs == ("steering", "throttle", "brake")
        assert (car.units["chassis.x"], car.units["speed"]) == ("", "m/s")
        car.want({"steering": (0.6, math.inf), "throttle": (1.0, math.inf)})
        assert run_headless(car, headless_driver(car, None, None), 1.0, lambda *_: None)
        x, y = value(car, "chassis.x"), value(car, "chassis.y")
        assert value(car, "steering") == pytest.approx(0.6)
        speed = value(car, "speed")
    with started(renamed) as plain:
        plain.want({"StrAng": (0.3, math.inf), "Acc_ped": (1.0, math.inf)})
        assert run_headless(plain, headless_driver(plain, None, None), 1.0, lambda *_: None)
        assert value(plain, "X") == pytest.approx(0.001 * x)
        assert value(plain, "chassis.y") == y
        assert value(plain, "speed") == speed


def test_a_hello_has_our_names(renamed, tmp_path):
    (tmp_path / "names.toml").write_text(ALIASES)
    requested = DriveRequest(renamed, None, None, None, FmuOptions([], []), tmp_path / "names.toml", None)
    prepared = prepare(requested, lambda text: None)
    hello = prepared.hello({}, ("steering",), 0.002, "")
    names = {v["name"] for v in hello["description"]["variables"]}
    assert names >= set(NAMES)
    assert not names & set(NAMES.values())
    assert scene_errors(hello["scene"]) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--headless"], "needs its length: --headless --stop-time T, or a --manoeuvre"),
        (["--stop-time", 3], "--stop-time is for a run without a page; add --headless"),
        (["--seed", 3], "--seed is for a run without a page"),
        (["--headless", "--stop-time", 1e7], "--stop-time is 1e+07 s; it must be at most 1e+06 s"),
        (["--headless", "--stop-time", 1, "--seed", 1, "-m", "slalom"], "give one of them"),
        (["--headless", "--stop-time", 1, "--step", 3], "--step is 3 s; it must be at most 1 s"),
        (["--headless", "-m", "waltz"], "There is no manoeuvre 'waltz'"),
        (["--headless", "--stop-time", 1, "--world", "moon"], "There is no world 'moon'"),
        (["--headless", "--stop-time", 1, "--world", "kerb"], "has no parameter 'road.file', so that the world kerb"),
        (["--headless", "--stop-time", 1, "--place", "start"], "of this FMU has no place 'start'; it has: none."),
        (["--headless", "--stop-time", 1, "--fidelity", 2], "no parameter or input 'fidelity'"),
        (["--headless", "--stop-time", 1, "--set", "steering=2"], "its range is -1 to 1"),
        (["--headless", "--stop-time", 1, "--aliases", "none.toml"], "The alias file none.toml cannot be read"),
        (["--port", 70000], "The port is 70000"),
        (["--listen", "203.0.113.1"], "cannot listen on 203.0.113.1"),
    ],
)  # fmt: skip
def test_an_impossible_request_is_refused_in_one_sentence(fmus, told, arguments, message):
    code, _, error = told(fmus["sledge"], *arguments)
    assert code == 2
    assert error.startswith("error: ")
    assert message in error


def test_a_folder_that_cannot_be_written_is_refused_before_the_run(fmus, told, tmp_path):
    (tmp_path / "file").write_text("")
    for option in ("--record", "--json"):
        code, out, error = told(fmus["sledge"], "--headless", "--stop-time", 1, option, tmp_path / "file" / "x")
        assert code == 2
        assert "file" in error
        assert "simulated" not in out


def test_an_impossible_interval_is_refused_before_the_folder_is_made(fmus, told, tmp_path):
    arguments = ("--headless", "--stop-time", 1, "--record", tmp_path / "drive", "--interval", 0.003)
    code, _, error = told(fmus["sledge"], *arguments)
    assert (code, error) == (
        2,
        "error: The interval is 0.003 s, which is not a multiple of the step of 0.002 s; take 0.004 s.",
    )
    assert not (tmp_path / "drive").exists()


def test_a_recording_is_joined_with_a_bar_and_not_written_over_another(fmus, told, tmp_path, monkeypatch):
    """A bar is shown after two seconds; here at once."""
    monkeypatch.setattr(bars, "DELAY", 0.0)
    run = (fmus["sledge"], "--headless", "--stop-time", 0.1, "--seed", 7, "--record", tmp_path / "rec")
    code, _, bar = told(*run)
    assert code == 0
    assert re.search(r"recording: +100 %", bar)
    assert json.loads((tmp_path / "rec" / "recording.json").read_text())["seed"] == 7
    code, out, error = told(*run)
    assert (code, out) == (2, "")
    assert error.endswith("holds a recording already, or another program is recording there; name another folder.")
    (tmp_path / "rec" / "recording.json").unlink()  # as while it is being made
    assert "another program is recording there" in told(*run)[2]


@pytest.mark.slow
def test_files_that_are_no_fmu_and_an_fmu_of_fmi_3(told, scene_fmu, tmp_path):
    assert "There is no file none.fmu" in told("none.fmu", "--headless", "--stop-time", 1)[2]
    (tmp_path / "text.fmu").write_text("text")
    assert "is not an FMU" in told(tmp_path / "text.fmu", "--headless", "--stop-time", 1)[2]
    result = scene_fmu(f"{TESTS / 'hosts' / 'scenes.py'}:sledge", "fmi3")
    code, out, error = told(result, "--headless", "--stop-time", 1)
    assert (code, error) == (0, "")
    assert "simulated" in out


@pytest.mark.slow
def test_without_an_fmu_one_is_built_and_kept(fmus, told, tmp_path, monkeypatch):
    """The build itself is tested elsewhere; here it takes an FMU that is there."""
    monkeypatch.setattr(built_fmu, "cache_folder", lambda *parts: tmp_path.joinpath("cache", *parts))
    monkeypatch.setattr("hosts.simulator.preparation.DEFAULT_WORLD", "plane")
    monkeypatch.chdir(tmp_path)
    built = []

    def build(_, options, folder):
        built.append(options)
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(fmus["sledge"], folder)

    monkeypatch.setattr(built_fmu, "build_fmu", build)
    out = told("--headless", "--stop-time", 0.1)[1]
    assert "The car prototype is built for this machine" in out
    assert re.search(r"\(cold: the FMU was built in \d+\.\d s of it\)", out)
    assert "(warm: the FMU was there)" in told("--headless", "--stop-time", 0.1)[1]
    assert built == [("--car", "prototype")]
    monkeypatch.setattr(built_fmu, "program_version", lambda: "other")
    assert "(cold: " in told("--headless", "--stop-time", 0.1)[1]
    (tmp_path / "dist").mkdir()
    shutil.copy(fmus["reach"], tmp_path / "dist" / "PrototypeCar.fmu")
    assert "Its inputs are pull" in told("--headless", "--stop-time", 0.1)[1]


def test_a_build_that_fails_is_one_sentence(told, tmp_path, monkeypatch):
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(
        commands, "module_command", lambda *_: [sys.executable, "-c", "import sys; sys.exit('error: No.')"]
    )
    code, _, error = told("--headless", "--stop-time", 1)
    assert (code, error) == (2, "error: The FMU of the car prototype cannot be built: No.")


def test_packages_that_are_missing_are_named_with_their_extra(fmus, told, monkeypatch):
    present = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "websockets" else present(name))
    code, _, error = told(fmus["sledge"])
    assert (code, error) == (
        2,
        'error: The package websockets is not installed; run: python -m pip install "ali3[simulator]"',
    )
