"""Manoeuvre files: read as FMPy reads them, and refused with a sentence that names the place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmpy.util import read_csv

from hosts.common.errors import HostError
from hosts.driving.manoeuvre import FOLDER, manoeuvre_names, with_names_of
from hosts.recordings.load_manoeuvre import load_manoeuvre

GOOD = '"time","steering","throttle"\n0,0,0\n1,0,0\n1,0.5,1\n2,0.5,0\n'


def written(folder: Path, text: str, settings: str = "") -> str:
    (folder / "m.csv").write_text(text, encoding="utf-8")
    if settings:
        (folder / "m.ini").write_text(settings)
    return str(folder / "m.csv")


def test_a_doubled_time_is_a_step_and_the_rest_is_linear(tmp_path: Path) -> None:
    manoeuvre = load_manoeuvre(written(tmp_path, GOOD))
    assert manoeuvre.stop_time == 2.0
    assert manoeuvre.at(0.5) == {"steering": 0.0, "throttle": 0.0}
    assert manoeuvre.at(1.0) == {"steering": 0.5, "throttle": pytest.approx(1.0)}
    assert manoeuvre.at(1.5) == {"steering": 0.5, "throttle": pytest.approx(0.5)}
    assert manoeuvre.at(9.0) == {"steering": 0.5, "throttle": 0.0}


def test_a_step_is_not_missed_for_rounding(tmp_path: Path) -> None:
    manoeuvre = load_manoeuvre(written(tmp_path, '"time","u"\n0,0\n0.3,0\n0.3,1\n1,1\n'))
    assert 3 * 0.1 != 0.3
    assert manoeuvre.at(0.1 + 0.2)["u"] == 1.0
    assert manoeuvre.at(np.nextafter(0.3, 0.0))["u"] == 1.0


def test_start_values_from_a_comment_and_from_the_file_beside(tmp_path: Path) -> None:
    text = "# start: initial.speed=15, initial.yaw=0.1\n" + GOOD
    manoeuvre = load_manoeuvre(written(tmp_path, text, "[run]\nstop_time = 7\n[start]\ninitial.yaw = 0.2\n"))
    assert manoeuvre.start == {"initial.speed": 15.0, "initial.yaw": 0.2}
    assert manoeuvre.stop_time == 7.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('"time","u"\n0,0\n2,1\n1,1\n', r"line 4: time goes back from 2 s to 1 s"),
        ('"time","u"\n0,0\n1,nan\n', r"line 3, column 'u': the value is nan"),
        ('"time","u"\n0,0\ninf,1\n', r"line 3, column 'time': the value is inf"),
        ('"time","u"\n0,zero\n', r"line 2, column 'u': 'zero' is not a number"),
        ('"time","u"\n0,1_0\n1,1\n', r"line 2, column 'u': '1_0' is not a number"),
        ('"time","u"\n0,\uff11\n1,1\n', r"line 2, column 'u': '\uff11' is not a number"),
        ('"time","u"\n0,1e999\n1,1\n', r"line 2, column 'u': '1e999' is too large"),
        (f'"time","u"\n0,{140_000 * "1"}\n1,1\n', r"line 2: a cell has 140000 characters"),
        ('"time","u"\n0,0,0\n', r"line 2: 3 values where the heading has 2 columns"),
        ('"u","time"\n0,0\n', r"line 1: the heading is"),
        ('"time","u","u"\n0,0,0\n', r"line 1: the heading is"),
        ('"time"\n0\n', r"line 1: the heading is"),
        ('"time","u"\n', r"holds no values"),
        ("", r"holds no values"),
        ('"time","u"\n0,0\n', r"does not say how long"),
        ('# start: speed\n"time","u"\n0,0\n1,0\n', r"line 1: 'speed' is not of the form"),
    ],
)
def test_bad_tables_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(HostError, match=message):
        load_manoeuvre(written(tmp_path, text))


def test_binary_tables_are_refused(tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_bytes(bytes(range(128, 256)))
    with pytest.raises(HostError, match="cannot be read as text"):
        load_manoeuvre(str(tmp_path / "m.csv"))


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ("[begin]\nx = 1\n", r"section \[begin\]"),
        ("[start]\nx = fast\n", "'fast' is not a number"),
        ("x\n", "not understood"),
        ("[run]\nstop_tme = 7\n", r"m\.ini: \[run\] has 'stop_tme'; known is stop_time"),
        ("[run]\nstop_time = -3\n", r"stop_time is -3 s; it must be positive"),
        ("[run]\nstop_time = 1_0\n", r"m\.ini: stop_time: '1_0' is not a number"),
        ("[DEFAULT]\nstop_time = 7\n", r"section \[DEFAULT\]"),
        ("[run]\nstop_time = 7\nstop_time = 8\n", r"not understood: .*already exists"),
    ],
)
def test_bad_settings_are_refused(tmp_path: Path, settings: str, message: str) -> None:
    with pytest.raises(HostError, match=message):
        load_manoeuvre(written(tmp_path, GOOD, settings))


def test_unknown_names_and_files_are_named() -> None:
    with pytest.raises(HostError, match=r"no manoeuvre 'loop'.*slalom"):
        load_manoeuvre("loop")
    with pytest.raises(HostError, match=r"no file nowhere\.csv"):
        load_manoeuvre("nowhere.csv")


@pytest.mark.parametrize("name", manoeuvre_names())
def test_manoeuvres_of_the_host_are_whole(name: str) -> None:
    manoeuvre = load_manoeuvre(name)
    assert manoeuvre.stop_time > 1.0
    for values in manoeuvre.inputs.values():
        assert values.min() >= -1.0
        assert values.max() <= 1.0


@pytest.mark.parametrize("name", [p.stem for p in sorted(FOLDER.glob("*.csv"))])
def test_fmpy_reads_the_same_tables(name: str) -> None:
    table = read_csv(FOLDER / f"{name}.csv")
    manoeuvre = load_manoeuvre(name)
    assert np.array_equal(table["time"], manoeuvre.time)
    assert all(np.array_equal(table[n], values) for n, values in manoeuvre.inputs.items())


def test_of_several_names_the_first_that_there_is_counts(tmp_path):
    manoeuvre = load_manoeuvre(written(tmp_path, GOOD, "[start]\na | b.c = 2\nd = 1\n"))
    assert with_names_of(manoeuvre, ["b.c", "d"]).start == {"b.c": 2.0, "d": 1.0}
    assert with_names_of(manoeuvre, ["a", "b.c"]).start == {"a": 2.0, "d": 1.0}
    assert with_names_of(manoeuvre, []).start == {"a": 2.0, "d": 1.0}  # to be refused by its name
    assert "drive.creep_torque | selector" in load_manoeuvre("kerb_drop").start
