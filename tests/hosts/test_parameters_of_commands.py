"""Parameters on the command line: options, sets and manoeuvres together, and their differences."""

import json
import re
from pathlib import Path

import pytest
from fmpy.util import read_csv

from hosts.check.command import main as check
from hosts.fmu.fmu import Fmu
from hosts.run.command import main as run
from tests.hosts.parameter_files import ssv


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "set.ssv"


def test_the_command_line_wins_over_the_set_and_the_set_over_the_manoeuvre(tuned, file, tmp_path, capsys):
    file.write_text(ssv("spring.stiffness=200", "spring.damping=3", "spring.free_length=0.8"))
    table = tmp_path / "pull.csv"
    table.write_text('# start: spring.damping=5,spring.stiffness=50\n"time","pull"\n0,0\n1,10\n')
    command = [str(tuned), "--parameters", str(file), "--set", "spring.stiffness=300", "--set", "pull=4"]
    assert run([*command, "--input", str(table), "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "set.ssv           3 values, 2 of them other than in the FMU" in printed
    assert "--set replaces 200 N/m of set.ssv" in printed
    assert "set.ssv replaces 5 N·s/m of start of pull" in printed
    assert "4 N of --set has no effect: it is a column of the manoeuvre pull" in printed
    assert "100 -> 300 N/m (--set)" in printed
    record = json.loads((tmp_path / "tuned_pull.json").read_text())
    assert record["set"] == [
        {"name": "spring.stiffness", "old": 100.0, "new": 300.0, "unit": "N/m", "from": "--set"},
        {"name": "spring.damping", "old": 1.0, "new": 3.0, "unit": "N.s/m", "from": "set.ssv"},
    ]


@pytest.mark.slow
def test_parameter_sets_without_effect_are_reported(tuned, file, tmp_path, capsys):
    file.write_text(ssv("spring.damping=1"))
    assert run([str(tuned), "--parameters", str(file), "--stop-time", "0.1", "--out", str(tmp_path)]) == 0
    assert "all 1 values are those of the FMU: it changes nothing" in capsys.readouterr().out
    assert run([str(tuned), "--set", "spring.damping=1", "--stop-time", "0.1", "--out", str(tmp_path)]) == 0
    assert "1 N·s/m as in the FMU (--set)" in capsys.readouterr().out
    twice = ["--set", "spring.damping=1", "--set", "spring.damping=2"]
    assert run([str(tuned), *twice, "--out", str(tmp_path)]) == 2
    assert "--set: 'spring.damping' is given as 1 and as 2; give it once" in capsys.readouterr().err


def test_a_tunable_parameter_may_be_a_column_and_a_fixed_one_not(tuned, tmp_path, capsys):
    table = tmp_path / "softer.csv"
    table.write_text('"time","pull","spring.stiffness"\n0,0,100\n1,0,100\n1,0,50\n2,0,50\n')
    assert run([str(tuned), "--input", str(table), "--out", str(tmp_path), "--step", "0.01"]) == 0
    actual = read_csv(tmp_path / "tuned_softer.csv")
    assert (actual["spring.stiffness"][99], actual["spring.stiffness"][100]) == (100.0, 50.0)
    with Fmu(tuned) as fmu:  # the same by hand
        fmu.initialise({})
        for k in range(200):
            if k == 100:
                fmu.setter(["spring.stiffness"])([50.0])
            fmu.step(0.01 * k, 0.01)
        assert fmu.getter(["bob.y"])()[0] == actual["bob.y"][-1]
    assert actual["bob.y"][-1] < actual["bob.y"][100] - 0.05
    table.write_text('"time","spring.free_length"\n0,0.8\n1,0.7\n')
    assert run([str(tuned), "--input", str(table), "--out", str(tmp_path)]) == 2
    errors = capsys.readouterr().err
    assert (
        "a column 'spring.free_length', a fixed parameter of Tuned.fmu: it can be set before the start only" in errors
    )
    table.write_text('"time","spring.stiffness"\n0,100\n1,1e5\n')
    assert run([str(tuned), "--input", str(table), "--out", str(tmp_path)]) == 2
    errors = capsys.readouterr().err
    assert "has a column 'spring.stiffness' that reaches 100000 N/m in row 2" in errors
    assert "range of the FMU's input is 10 to 900 N/m" in errors


def test_differences_of_a_set(tuned, file, capsys):
    file.write_text(ssv("spring.stiffness=0.2[kN/m]", "spring.damping=1"))
    assert check([str(tuned), "--diff", str(file)]) == 0
    assert capsys.readouterr().out == "spring.stiffness  100 -> 200 N/m\n"
    assert check([str(tuned), "--set", "spring.stiffness=200", "--diff", str(file)]) == 0
    assert "sets nothing to another value" in capsys.readouterr().out
    assert check([str(tuned), "--show-parameters"]) == 0
    printed = capsys.readouterr().out
    rows = [re.split(r"\s{2,}", line) for line in printed.splitlines()]
    assert ["spring.free_length", "0.8", "m", "0.1 to 2", "fixed", "Of the spring: free_length"] in rows


def test_hosts_refuse_an_invalid_set_with_the_same_message(tuned, file, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file.write_text(ssv("spring.damping=200"))
    for command, more in ((run, []), (check, ["--show-parameters"])):
        assert command([str(tuned), *more, "--parameters", str(file)]) == 2
        errors = capsys.readouterr().err
        assert errors == "error: set.ssv: 'spring.damping' is 200 N·s/m; its range is 0 to 20 N·s/m.\n"
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "set.ssv").write_text(ssv("spring.damping=2"))
    two = ["--parameters", str(Path("other", "set.ssv")), "--parameters", str(file)]
    assert run([str(tuned), *two]) == 2
    assert capsys.readouterr().err.startswith(f"error: {file}: 'spring.damping' is 200")


def test_a_column_of_whole_numbers_is_held_between_its_rows(scene_fmu, tmp_path, capsys):
    fmu = scene_fmu(f"{Path(__file__).with_name('scenes.py')}:switched")
    table = tmp_path / "shift.csv"
    table.write_text('"time","pull","gear"\n0,0,1\n1,2,3\n2,2,-1\n')
    assert run([str(fmu), "--input", str(table), "--step", "0.1", "--out", str(tmp_path)]) == 0
    actual = read_csv(tmp_path / "switched_shift.csv")
    assert list(actual["gear"]) == [1.0] * 10 + [3.0] * 11  # with which the next step begins
    assert list(actual["gear_used"]) == [1.0] * 11 + [3.0] * 10
    assert actual["pull"][5] == pytest.approx(1.0)
    table.write_text('"time","gear"\n0,1\n1,1.5\n')
    assert run([str(fmu), "--input", str(table), "--out", str(tmp_path)]) == 2
    assert "a column 'gear' with the value 1.5; 'gear' is a whole number" in capsys.readouterr().err
