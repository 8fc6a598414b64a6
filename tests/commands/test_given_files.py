"""Files that options name are checked before a car is built for the command."""

import importlib
import os

import pytest

from ali3.commands import COMMANDS

FILES = {
    "run": ("--aliases", "--road", "--parameters", "--manoeuvre", "--out"),
    "check": ("--reference", "--diff", "--parameters", "--junit", "--sarif", "--save-parameters"),
    "view": ("--road", "--parameters", "--geometry", "--png", "--mp4", "--gltf"),
    "catalogue": ("--aliases", "--variant", "--limits"),
    "compare": ("--aliases", "--log-aliases", "--road", "--parameters", "--json"),
    "simulator": ("--aliases", "--parameters", "--json", "--record"),
}
WRITTEN = ("--out", "--record", "--json", "--png", "--mp4", "--gltf", "--junit", "--sarif", "--save-parameters")


@pytest.fixture
def command(monkeypatch, tmp_path):
    def build(*_):
        raise AssertionError("the car is built")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("hosts.fmu.fmu_file.fmu_of_car", build)
    (tmp_path / "log.csv").write_text("time,u\n0,0\n1,0\n")
    (tmp_path / "file").write_text("x")
    os.mkfifo(tmp_path / "pipe")

    def run(name, *words):
        main = importlib.import_module(next(c.module for c in COMMANDS if c.name == name)).main
        return main(["hatchback", *(["log.csv"] if name == "compare" else []), *words])

    return run


@pytest.mark.parametrize(("name", "option"), [(name, option) for name, options in FILES.items() for option in options])
@pytest.mark.parametrize("file", ["file/x", "pipe", "-1"])
def test_a_wrong_file_is_one_sentence(command, capsys, name, option, file):
    if option in WRITTEN:
        file = "file/x"
    assert command(name, f"{option}={file}") == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert error.count("\n") == 1
    assert file.removesuffix("/x") in error


NUMBERS = {
    "run": ("--step", "--interval", "--stop-time", "--fidelity"),
    "check": ("--step", "--stop-time", "--fidelity", "--time-limit"),
    "view": ("--step", "--stop-time", "--most"),
    "catalogue": ("--step",),
    "compare": ("--step", "--windows", "--window-every", "--fit-step"),
    "simulator": ("--step", "--interval", "--stop-time", "--fidelity"),
}


@pytest.mark.parametrize(
    ("name", "option"), [(name, option) for name, options in NUMBERS.items() for option in options]
)
@pytest.mark.parametrize("value", ["-1", "1e400", "nan", "inf", ""])
def test_a_wrong_number_is_refused_with_the_name_of_its_option(command, capsys, name, option, value):
    with pytest.raises(SystemExit) as end:
        command(name, f"{option}={value}")
    assert end.value.code == 2
    last_line = capsys.readouterr().err.splitlines()[-1]
    assert f"error: argument {option}: {value!r} is" in last_line or f"the value is {value}" in last_line


@pytest.mark.parametrize(
    ("name", "option"), [("run", "--out"), ("run", "--aliases"), ("simulator", "--record"), ("check", "--junit")]
)
def test_an_empty_path_is_not_the_current_folder(command, capsys, name, option):
    with pytest.raises(SystemExit):
        command(name, f"{option}=")
    assert f"argument {option}: '' is given; it must be a path" in capsys.readouterr().err


def test_the_folder_of_a_recording_is_not_made_before_the_car_is_built(command, tmp_path):
    with pytest.raises(AssertionError, match="the car is built"):
        command("simulator", "--headless", "--stop-time=1", "--record=drive")
    assert not (tmp_path / "drive").exists()


@pytest.mark.parametrize("words", [["--aliases=carsim"], ["--road=plane.road"], ["--manoeuvre=log.csv"]])
def test_a_right_one_is_not(command, words):
    with pytest.raises(AssertionError, match="the car is built"):
        command("run", *words)


def test_words_in_place_of_files(command):
    with pytest.raises(AssertionError, match="the car is built"):
        command("catalogue", "--aliases=none", "--variant=as-is")


def test_the_alias_file_of_a_log_has_tables(command, tmp_path):
    (tmp_path / "names.toml").write_text('[signals]\nspeed = "v"\n')
    with pytest.raises(AssertionError, match="the car is built"):
        command("compare", "--log-aliases=names.toml")
