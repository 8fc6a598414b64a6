"""The command `ali3 car`: lists, copies and checks cars."""

import re

import pytest

from ali3.command import main
from mbs.vehicle import car_names, load


def test_it_lists_the_cars(capsys):
    assert main(["car", "--list"]) == 0
    printed = capsys.readouterr().out
    assert [line.split()[0] for line in printed.splitlines()] == car_names()


@pytest.mark.parametrize("name", ["prototype", "commonroad_320i"])
def test_a_copy_is_the_same_car(name, tmp_path, capsys):
    folder = tmp_path / "new" / "own"
    assert main(["car", name, str(folder)]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert str(folder / "car.toml") in printed
    assert sorted(printed) == sorted(map(str, folder.iterdir()))
    copy, car = load(folder), load(name)
    assert copy.model_dump() == car.model_dump()
    assert [p.name for p in (tmp_path / "new").iterdir()] == ["own"]
    assert main(["car", name, str(folder)]) == 2
    assert capsys.readouterr().err == f"error: {folder} exists; the copy of a car needs a folder that does not.\n"


@pytest.mark.parametrize("name", ["hatchback", "ferrari_250_lm"])
def test_it_prints_a_summary_of_a_car(name, capsys):
    assert main(["car", name, "--show-parameters"]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    for path in load(name).values():
        assert f"\n{path} " in printed.out
    assert re.search(r"^wheels from the drawing +[+-]0\.\d mm +[+-]0\.\d mm$", printed.out, re.M)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["car", "protoype"], "There is no car 'protoype': no file protoype; did you mean 'prototype'?"),
        (["car", "protoype", "x"], "There is no car 'protoype' to copy; did you mean 'prototype'?"),
        (["car", "/nowhere"], "There is no car '/nowhere'"),
    ],
)
def test_a_car_that_is_not_there(arguments, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert capsys.readouterr().err.startswith(f"error: {message}")
    assert list(tmp_path.iterdir()) == []


def test_it_needs_a_car(capsys):
    with pytest.raises(SystemExit) as end:
        main(["car"])
    assert end.value.code == 2
    assert "a CAR is needed, or --list" in capsys.readouterr().err
