"""Manoeuvre files: read as FMPy reads them, and refused with a sentence that names the place."""

import json
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv

import mbs
from fmu_src.build.build import build_fmu
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.manoeuvre_file import read_manoeuvre
from hosts.driving.manoeuvres import FOLDER, manoeuvre_names
from hosts.driving.run_checks import check_columns
from hosts.driving.write_manoeuvre import write_manoeuvre, write_table
from hosts.fmu.fmu import Fmu
from hosts.recordings.load_manoeuvre import load_manoeuvre

GOOD = '"time","steering","throttle"\n0,0,0\n1,0,0\n1,0.5,1\n2,0.5,0\n'


def written(folder: Path, text: str) -> str:
    (folder / "m.csv").write_text(text, encoding="utf-8")
    return str(folder / "m.csv")


def test_a_doubled_time_is_a_step_and_the_rest_is_linear(tmp_path: Path) -> None:
    manoeuvre = load_manoeuvre(written(tmp_path, GOOD))
    assert manoeuvre.stop_time == 2.0
    assert manoeuvre.at(0.5) == {"steering": 0.0, "throttle": 0.0}
    assert manoeuvre.at(1.0) == {"steering": 0.5, "throttle": pytest.approx(1.0)}
    assert manoeuvre.at(1.5) == {"steering": 0.5, "throttle": pytest.approx(0.5)}
    assert manoeuvre.at(9.0) == {"steering": 0.5, "throttle": 0.0}
    assert manoeuvre.at(1.0, before=True) == {"steering": 0.0, "throttle": 0.0}
    assert manoeuvre.at(1.5, before=True) == manoeuvre.at(1.5)


def test_held_inputs_keep_the_value_of_a_row_up_to_the_next(tmp_path: Path) -> None:
    manoeuvre = load_manoeuvre(written(tmp_path, "# held: throttle\n" + GOOD))
    assert manoeuvre.at(1.5) == {"steering": 0.5, "throttle": 1.0}
    recorded = load_manoeuvre(written(tmp_path, "# outputs from: throttle\n" + GOOD))
    assert recorded.at(0.5) == {"steering": 0.0}
    assert recorded.held == {"steering"}
    with pytest.raises(HostError, match="'brake' is listed as held but is not an input of the table"):
        load_manoeuvre(written(tmp_path, "# held: brake\n" + GOOD))


def test_a_table_names_its_step_and_one_without_its_beginning_is_refused(tmp_path: Path) -> None:
    """As a page writes them; what is written is read again."""
    head = "# outputs from: throttle\n# step: 0.02\n"
    assert load_manoeuvre(written(tmp_path, head + GOOD)).step == 0.02
    assert load_manoeuvre(written(tmp_path, GOOD)).step is None
    files = write_table(load_manoeuvre(written(tmp_path, head + GOOD)), tmp_path / "again.csv")
    assert load_manoeuvre(str(files[0])).step == 0.02
    with pytest.raises(HostError, match="the communication step is 0 s; it must be positive"):
        load_manoeuvre(written(tmp_path, "# step: 0\n" + GOOD))
    with pytest.raises(HostError, match="the first 3.5 s are not in this table, so that the run cannot be repeated"):
        load_manoeuvre(written(tmp_path, head + "# the first 3.5 s are not in this table\n" + GOOD))


def test_a_step_is_not_missed_for_rounding(tmp_path: Path) -> None:
    manoeuvre = load_manoeuvre(written(tmp_path, '"time","u"\n0,0\n0.3,0\n0.3,1\n1,1\n'))
    assert 3 * 0.1 != 0.3
    assert manoeuvre.at(0.1 + 0.2)["u"] == 1.0
    assert manoeuvre.at(np.nextafter(0.3, 0.0))["u"] == 1.0


def test_a_table_that_begins_late_holds_its_first_row_and_is_reported(tmp_path: Path) -> None:
    late = load_manoeuvre(written(tmp_path, '"time","u","v"\n0.5,3,-1\n1,0,0\n'))
    assert late.at(0.0) == {"u": 3.0, "v": -1.0}
    assert late.late_begin() == ("begin of the table", "at 0.5 s; before, its first row holds u at 3, v at -1")
    assert late.late_begin(("u",)) == ("begin of the table", "at 0.5 s; before, its first row holds v at -1")
    assert late.late_begin(("u", "v")) is load_manoeuvre(written(tmp_path, GOOD)).late_begin() is None
    assert load_manoeuvre("double_lane_change").late_begin() is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('"time","u"\n0,0\n1,1\n1,2\n1,3\n2,0\n', r"more than two rows at 1 s; a jump has two"),
        ('"time","u"\n0,0\n2,1\n1,1\n', r"line 4: time goes back from 2 s to 1 s"),
        ('"time","u"\n0,0\n1,nan\n', r"line 3, column 'u': 'nan' is not a finite number"),
        ('"time","u"\n0,zero\n', r"line 2, column 'u': 'zero' is not a number"),
        ('"u","time"\n0,0\n', r"the heading is 'u, time'; it must be"),
        ('"time","u","u"\n0,0,0\n', r"has the column 'u' twice"),
        ('"time [s]","u"\n0,0\n1,1\n', r"the heading 'time \[s\]' has a unit; here it is 'time' alone"),
        ('"time","u"\n1.7e9,0\n1700000003,1\n', r"goes from 1700000000 to 1700000003 s; a run begins at 0 and ends"),
        ('"time","u"\n-1,0\n1,1\n', r"begins at -1 s; a run begins at 0: add 1 s to all its times"),
        ('# hold: u\n"time","u"\n0,0\n1,0\n', r"line 1: 'hold:' is not a key of a table; did you mean 'held:'"),
        ('# start: speed\n"time","u"\n0,0\n1,0\n', r"line 1: 'speed' is not of the form"),
        ('# start: v=1\n# start: v=2\n"time","u"\n0,0\n1,0\n', r"line 2: the start value 'v' is given twice"),
    ],
)
def test_bad_tables_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(HostError, match=message):
        load_manoeuvre(written(tmp_path, text))


def test_files_that_are_no_tables_are_refused(tmp_path: Path) -> None:
    for name, message in (
        ("loop", r"no manoeuvre 'loop'.*slalom"),
        ("nowhere.csv", r"no file nowhere\.csv"),
    ):
        with pytest.raises(HostError, match=message):
            load_manoeuvre(name)


def test_a_table_whose_record_does_not_fit_is_refused(tmp_path: Path) -> None:
    record = {"outputs_from": "v", "start": {}, "held": [], "state": None, "step_s": 0.1, "jumps": {"1": [1.0, 0.5]}}
    good = '"time","u","v"\n0,0,0\n1,1,0\n2,1,0\n'

    def read(text: str, **changed: object) -> Manoeuvre:
        (tmp_path / "m.json").write_text(json.dumps(record | changed))
        return load_manoeuvre(written(tmp_path, text))

    actual = read(good)
    assert actual.time.tolist() == [0.0, 1.0, 1.0, 2.0]
    assert actual.inputs["u"].tolist() == [0.0, 0.5, 1.0, 1.0]
    assert (actual.step, actual.held) == (0.1, frozenset())
    cut = '"time","u","v"\n1,1,0\n2,1,0\n'
    for text, jumps in ((good, {"3": [1.0, 0.5]}), (good, {"1": [1.0]}), (cut, record["jumps"])):
        with pytest.raises(HostError, match=r"m\.csv is not the table that m\.json beside it was written with"):
            read(text, jumps=jumps)
    for changed in (
        {"start": ["ab"]},
        {"held": "u"},
        {"jumps": {"1": [1.0, float("nan")]}},
        {"step_s": -1},
        {"lost": "u"},
    ):
        with pytest.raises(HostError, match="is not a whole record of the run"):
            read(good, **changed)
    (tmp_path / "m.json").write_text('{"mine": NaN} of another kind')
    assert list(load_manoeuvre(written(tmp_path, GOOD)).inputs) == ["steering", "throttle"]


def test_manoeuvres_of_the_host_are_whole() -> None:
    for name in manoeuvre_names():
        manoeuvre = load_manoeuvre(name)
        assert manoeuvre.stop_time > 1.0, name
        assert all(np.abs(values).max() <= 1.0 for values in manoeuvre.inputs.values()), name


def test_fmpy_reads_the_same_tables() -> None:
    table = read_csv(FOLDER / "launch_and_brake.csv")
    manoeuvre = load_manoeuvre("launch_and_brake")
    assert np.array_equal(table["time"], manoeuvre.time)
    assert all(np.array_equal(table[n], values) for n, values in manoeuvre.inputs.items())


TOML = """
stop_time = 7
[start]
initial.speed = 15
"initial.yaw" = 0.2
"road.file" = "kerb.road"
flag = true
[driver]
course = "iso_3888_1"
speed = 20
[inputs]
time = [0, 1, 1, 2]
hand_brake = [0, -0.0, 0.5, 0.1]
front.damper.damping = [1000, 1000, 2e3, 2e3]
[state]
file = "m.state"
time = 0.5
"""


def same(one: Manoeuvre, other: Manoeuvre) -> bool:
    arrays = [(one.time, other.time), *((one.inputs[name], other.inputs[name]) for name in one.inputs)]
    return (
        list(one.inputs) == list(other.inputs)
        and all(a.tobytes() == b.tobytes() for a, b in arrays)
        and (one.name, one.stop_time, one.start, one.state, one.state_time)
        == (other.name, other.stop_time, other.start, other.state, other.state_time)
        and {name: word_or_number(text) for name, text in one.driver.items()}
        == {name: word_or_number(text) for name, text in other.driver.items()}
    )


def word_or_number(text: str) -> str | float:
    return float(text) if text[0].isdigit() else text


def test_one_toml_file_has_all_of_a_manoeuvre_and_is_written_as_it_is_read(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(TOML)
    (tmp_path / "m.state").write_bytes(b"state")
    manoeuvre = load_manoeuvre(str(tmp_path / "m.toml"))
    assert manoeuvre.stop_time == 7.0
    assert manoeuvre.start == {"initial.speed": 15, "initial.yaw": 0.2, "road.file": "kerb.road", "flag": True}
    assert manoeuvre.driver == {"course": "iso_3888_1", "speed": "20"}
    assert manoeuvre.at(1.5) == {"hand_brake": pytest.approx(0.3), "front.damper.damping": 2000.0}
    assert (manoeuvre.state, manoeuvre.state_time) == (b"state", 0.5)
    again = tmp_path / "again" / "m.toml"
    write_manoeuvre(manoeuvre, again, "What it is.")
    assert again.read_text().startswith("# What it is.\n")
    assert same(read_manoeuvre(str(again)), manoeuvre)


def test_many_numbers_come_back_to_the_bit(tmp_path: Path) -> None:
    values = np.array([-0.0, 0.1 + 0.2, 1e-300, -1e22, 123456.0, 1234567.0, *np.random.default_rng(1).normal(size=500)])
    manoeuvre = Manoeuvre("m", np.arange(len(values)) / 3.0, {"a b": values, 'ä."q': -values}, 9.0)
    write_manoeuvre(manoeuvre, tmp_path / "m.toml")
    assert max(map(len, (tmp_path / "m.toml").read_text(encoding="utf-8").splitlines())) <= 120
    assert same(read_manoeuvre(str(tmp_path / "m.toml")), manoeuvre)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("stop_tme = 7\n", r"m\.toml: stop_tme is not known; did you mean 'stop_time'\?"),
        ("stop_time = -3\n", r"stop_time is -3; it must be a positive number, s"),
        ("start = 3\n", r"start is 3; it must be a table"),
        ("stop_time = 1\n[start]\nx = [1]\n", r"start.x is \[1\]; it must be a number or"),
        ("[inputs]\nsteering = [1]\n", r"\[inputs\] has steering; it must have time and inputs"),
        ("[inputs]\ntime = [0, 1]\nu = 3\n", r"inputs.u is 3; it must be a list of numbers"),
        ("[inputs]\ntime = [0, 1]\nu = [0, 'a']\n", r"inputs.u.1 is 'a'; it must be a number"),
        ("[inputs]\ntime = [0, 1]\nu = [0]\n", r"'u' has 1 values where time has 2"),
        ("[inputs]\ntime = [0, 2, 1]\nu = [0, 0, 0]\n", r"time goes back from 2 s to 1 s"),
        ("stop_time = 1\n[state]\nfile = 'a'\n", r"state.time is missing; it must be a number, s"),
        ("stop_time = 1\n[state]\nfile = 'a.state'\ntime = 0\n", r"the state: 'a\.state' cannot be read"),
        ('held = [["u"]]\n[inputs]\ntime = [0, 1]\nu = [0, 1]\n', r"m\.toml"),
        ("[inputs]\nu = [0, 1]\ntime = 5\n", r"m\.toml"),
        ("[inputs]\ntime = [-2, 1]\nu = [0, 1]\n", r"m\.toml begins at -2 s; a run begins at 0: add 2 s"),
        (
            "[driver]\nspeed = 9\n[inputs]\ntime = [0, 1]\nsteering = [0, 1]\nbrake = [0, 1]\nu = [0, 1]\n",
            r"\[inputs\] has steering, brake, which the driver sets; remove them, or \[driver\]",
        ),
        ("stop_time = 1\n[start]\na.b = 1\n'a.b' = 2\n", r"m\.toml, \[start\]: 'a\.b' is given twice"),
    ],
)
def test_bad_toml_files_are_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "m.toml").write_text(text)
    with pytest.raises(HostError, match=message):
        load_manoeuvre(str(tmp_path / "m.toml"))


def test_of_several_names_the_first_that_there_is_counts(tmp_path):
    manoeuvre = load_manoeuvre(written(tmp_path, "# start: a | b.c=2, d=1\n" + GOOD))
    assert with_names_of(manoeuvre, ["b.c", "d"]).start == {"b.c": 2.0, "d": 1.0}
    assert with_names_of(manoeuvre, ["a", "b.c"]).start == {"a": 2.0, "d": 1.0}
    assert with_names_of(manoeuvre, []).start == {"a": 2.0, "d": 1.0}  # to be refused by its name
    assert "drive.creep_torque | selector" in load_manoeuvre("kerb_drop").start


def test_columns_beyond_their_range_values_that_overflow_and_late_tables_are_refused(tmp_path: Path) -> None:
    model = mbs.Model("bob", dimension=2)
    bob = model.point_mass("bob", mass=2.0, position=(0.0, 0.0))
    model.force("pull", bob, inputs=(model.input("pull", unit="1", min=-1.0, max=1.0), model.input("push", unit="N")))

    def drive(name: str, values: list[float], begin: float = 0.0) -> Manoeuvre:
        return Manoeuvre("far", begin + np.array([0.0, 1.0, 2.0]), {name: np.array(values)}, 2.0)

    with Fmu(build_fmu(mbs.compile(model), "bob", tmp_path, [fmpy.platform])) as fmu:
        check_columns(fmu, drive("pull", [0.0, 1.0 + 1e-7, -1.0], 2.0))
        check_columns(fmu, drive("push", [0.0, 9e99, 0.0]))
        for far, message in (
            (drive("pull", [0.0, 45.0, 20.0]), "'pull' that reaches 45 in row 2 .*; it looks like % or deg"),
            (drive("pull", [0.0, 1.0, 0.0], 100.0), "begins at 100 s, and the run ends at 2 s"),
            (drive("push", [0.0, -2e100, 0.0]), r"'push' with the value -2e\+100; it must be within 1e\+100"),
        ):
            with pytest.raises(HostError, match=message):
                check_columns(fmu, far)


def test_values_whose_difference_is_no_number_go_straight_too() -> None:
    manoeuvre = Manoeuvre("far", np.array([0.0, 1.0]), {"force": np.array([1e308, -1e308])}, 1.0)
    assert [manoeuvre.at(t)["force"] for t in (0.0, 0.25, 1.0)] == [1e308, pytest.approx(5e307), -1e308]


def test_a_stop_time_that_is_asked_for_is_that_of_a_table_without_one(tmp_path: Path) -> None:
    file = tmp_path / "one.csv"
    file.write_text("time,steering\n0,0.1\n")
    with pytest.raises(HostError, match="does not say how long it lasts"):
        read_manoeuvre(str(file))
    assert read_manoeuvre(str(file), 0.3).stop_time == 0.3
