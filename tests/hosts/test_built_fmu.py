"""FMUs of cars are built once for each content."""

import os
import shutil
import signal
import sys
from pathlib import Path

import pytest

from ali3.signals import Stopped
from ali3.temporary_folder import PREFIX
from hosts.common import commands
from hosts.common.errors import HostError
from hosts.fmu import built_fmu
from hosts.fmu.fmu_file import fmu_file

# Stands in for the builder, which needs half a minute: an FMU with the text of the car file.
BUILD = """
import pathlib, sys
car, out = sys.argv[sys.argv.index("--car") + 1], pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
text = (pathlib.Path(car) / "car.toml").read_text()
if "wrong" in text:
    sys.exit("error: The car is wrong.")
out.mkdir(exist_ok=True)
(out / "Car.fmu").write_text(text)
"""


@pytest.fixture
def car(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(commands, "module_command", lambda *words: [sys.executable, "-c", BUILD, *words])
    folder = tmp_path / "car"
    folder.mkdir()
    (tmp_path / "frame.op4").write_text("frame")
    (folder / "car.toml").write_text('name = "a"\nframe = "../frame.op4"\n')
    (folder / "tubes.csv").write_text("1\n")
    return folder


def test_a_car_is_built_once_for_each_content(car, tmp_path):
    messages: list[str] = []
    first = built_fmu.fmu_of_car(str(car), messages.append)
    assert first.read_text() == (car / "car.toml").read_text()
    assert built_fmu.fmu_of_car(str(car), messages.append) == first
    assert len(messages) == 1
    shutil.copytree(car, tmp_path / "elsewhere")
    assert built_fmu.fmu_of_car(str(tmp_path / "elsewhere"), messages.append) == first
    for file in (car / "car.toml", car / "tubes.csv", tmp_path / "frame.op4"):
        file.write_text(file.read_text() + "\n")
        assert built_fmu.fmu_of_car(str(car), messages.append) != first
    assert len(messages) == 4
    assert [f.name for f in first.parent.parent.iterdir() if f.name.startswith(PREFIX)] == []


def test_other_ports_or_another_program_build_again(car, monkeypatch):
    first = built_fmu.fmu_of_car(str(car), print)
    assert built_fmu.fmu_of_car(str(car), print, "all") != first
    assert built_fmu.fmu_of_car(str(car), print) == first
    monkeypatch.setattr(built_fmu, "program_version", lambda: "other")
    assert built_fmu.fmu_of_car(str(car), print) != first


def test_a_command_with_many_cars_keeps_all_of_them(car, monkeypatch):
    monkeypatch.setattr(built_fmu, "_MAX_FMUS", 1)
    result = [built_fmu.fmu_of_car(str(car), print, ports) for ports in ("1", "2", "3")]
    assert all(fmu.is_file() for fmu in result)
    for fmu in result:
        os.utime(fmu.parent, (0, 0))
    assert built_fmu.fmu_of_car(str(car), print, "1") == result[0]  # used again, and so kept
    built_fmu.fmu_of_car(str(car), print, "4")
    assert [fmu.is_file() for fmu in result] == [True, False, False]


def test_a_command_takes_an_fmu_or_a_car(car, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    result = fmu_file(Path("car"))
    assert result.read_text() == (car / "car.toml").read_text()
    assert "The car car is built for this machine" in capsys.readouterr().out
    assert fmu_file(Path("car", "car.toml")) == fmu_file(Path("car")) == result
    assert capsys.readouterr().out == ""
    for fmu in ("x.fmu", "dist/x", "cut", "run-1"):  # what is there, or looks like a file
        (tmp_path / "cut").write_text("")
        assert fmu_file(Path(fmu)) == Path(fmu)
    built = []
    monkeypatch.setattr("hosts.fmu.fmu_file.fmu_of_car", lambda name, tell: built.append(name) or result)
    assert fmu_file(Path("hatchback")) == fmu_file(None) == result
    assert built == ["hatchback", "prototype"]
    (tmp_path / "dist").mkdir()
    (tmp_path / "dist" / "PrototypeCar.fmu").write_text("")
    assert fmu_file(None) == Path("dist", "PrototypeCar.fmu")


def test_the_message_of_a_failed_build(car):
    (car / "car.toml").write_text("wrong")
    with pytest.raises(HostError, match=r"The FMU of the car .* cannot be built: The car is wrong\."):
        built_fmu.fmu_of_car(str(car), print)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a signal of a clock")
def test_a_stopped_build_ends_its_process_and_is_reported(car, monkeypatch):
    """A signal for the command alone: the process of the build is not waited for."""
    pid = car.parent / "pid"
    slow = f"import os, pathlib, time; pathlib.Path({str(pid)!r}).write_text(str(os.getpid())); time.sleep(600)"
    monkeypatch.setattr(commands, "module_command", lambda *words: [sys.executable, "-c", slow])

    def stop(*_: object) -> None:
        if not (pid.exists() and pid.read_text()):
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            return
        raise Stopped(signal.SIGTERM)

    before, messages = signal.signal(signal.SIGALRM, stop), list[str]()
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with pytest.raises(Stopped):
            built_fmu.fmu_of_car(str(car), messages.append)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert "was stopped and nothing was run" in messages[-1]
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid.read_text()), 0)
    assert not list((car.parent / "cache").rglob("*.fmu"))
