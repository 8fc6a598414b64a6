"""The cheapest level of a car within tolerances: drives, measured rows, the choice, and the command."""

import json
import re

import numpy as np
import pytest

from ali3.command import main
from ali3.errors import FileError
from mbs import compile, simulate
from mbs.common.errors import ModelError
from mbs.vehicle import Fidelity, load
from mbs.vehicle.levels.drives import ACCELERATION, Drive, default_drives, read_drive
from mbs.vehicle.levels.errors import error_of_change, load_error, path_error
from mbs.vehicle.levels.level_choice import cheapest, levels
from mbs.vehicle.levels.measure import compile_fidelities, measure


@pytest.fixture(scope="module")
def saloon():
    return compile_fidelities(load("saloon"))


def test_a_car_by_links_has_tables_too(saloon):
    assert list(saloon) == [Fidelity.TABLE, Fidelity.RIGID]


def test_its_own_drives_reach_their_accelerations_and_speeds(saloon):
    system = saloon[Fidelity.TABLE]
    slalom, braking, kerb = default_drives(saloon[Fidelity.RIGID])
    run = simulate(system, slalom.duration, 0.01, slalom.inputs, pose=slalom.pose, estimate_error=False)
    late = run.t > 3.0
    assert np.abs(run["chassis.ay"][late]).max() == pytest.approx(ACCELERATION, rel=0.35)
    run = simulate(system, braking.duration, 0.01, braking.inputs, pose=braking.pose, estimate_error=False)
    assert run["chassis.vx"][0] == pytest.approx(20.0)
    assert run["chassis.vx"][-1] < 15.0
    run = simulate(
        system, kerb.duration, 0.01, kerb.inputs, parameters=kerb.parameters, pose=kerb.pose, estimate_error=False
    )
    assert run["chassis.z"][-1] - run["chassis.z"][0] == pytest.approx(-0.05, abs=0.01)


def test_rows_are_errors_and_cost(saloon):
    drive = Drive("roll", 0.3, {}, speed=5.0)
    shares = []
    rows = measure(saloon, [drive], steps=(0.01, 0.001), repeats=1, tell=shares.append)
    assert [(row["fidelity"], row["h_s"]) for row in rows] == [
        (name, h) for name in ("table", "rigid") for h in (0.01, 0.001)
    ]
    assert all(row["failed"] == "" and row["moment"] is None and row["us_per_step"] > 0.0 for row in rows)
    assert all(0.0 <= row["path"] < 1e-3 and 0.0 <= row["load"] < 0.01 for row in rows)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    fine = measure({Fidelity.RIGID: saloon[Fidelity.RIGID]}, [drive], steps=(0.0005,), repeats=1)
    assert (fine[0]["path"], fine[0]["load"]) == (0.0, 0.0)  # the reference itself


def test_levels_take_turns_and_the_least_time_counts(saloon, monkeypatch):
    seconds = iter((9.0, 2.0, 3.0, 8.0))  # a busy machine in the first run of one and in the second of the other
    results = []

    def step_time(system, *args, **kwargs):
        results.append(system)
        return next(seconds)

    monkeypatch.setattr("mbs.vehicle.levels.measure.step_time", step_time)
    rows = measure(saloon, [Drive("roll", 0.1, {}, speed=5.0)], steps=(0.01,), repeats=2)
    table, rigid = saloon[Fidelity.TABLE], saloon[Fidelity.RIGID]
    assert results == [table, rigid, table, rigid]
    assert [row["us_per_step"] for row in rows] == pytest.approx([3e5, 2e5])


def test_errors_are_those_of_their_definitions():
    t = np.linspace(0.0, 1.0, 5)
    names = ("chassis.x", "chassis.y", "chassis.z", *(f"wheel_{w}.Fz" for w in ("FL", "FR", "RL", "RR")))
    reference = dict.fromkeys(names, 100.0 * t)
    actual = {name: values.copy() for name, values in reference.items()}
    actual["chassis.x"][2] += 3.0
    actual["chassis.y"][2] -= 4.0
    actual["wheel_RL.Fz"][4] += 10.0
    assert path_error(actual, reference) == pytest.approx(5.0)
    assert load_error(actual, reference) == pytest.approx(0.1)
    assert error_of_change(actual, {n: v + 50.0 for n, v in reference.items()}, ["wheel_RL.Fz"]) == pytest.approx(0.5)


def rows_of(*lines: tuple[str, str, float, float | None, float | None]) -> list[dict[str, object]]:
    keys = ("manoeuvre", "fidelity", "us_per_step", "path", "load")
    return [dict(zip(keys, line, strict=True)) | {"h_s": 0.01} for line in lines]


def test_it_chooses_the_level_that_meets_all_tolerances_in_all_drives():
    rows = rows_of(
        ("a", "table", 10.0, 0.001, 0.02), ("b", "table", 20.0, 0.001, 0.05),
        ("a", "rigid", 40.0, 0.002, 0.02), ("b", "rigid", 30.0, 0.001, 0.02),
        ("a", "dynamic", 300.0, 0.0, None), ("b", "dynamic", 300.0, 0.0, 0.0),
    )  # fmt: skip
    assert cheapest(rows, {"path": 0.01}).fidelity is Fidelity.TABLE
    both = cheapest(rows, {"path": 0.01, "load": 0.03})
    assert (both.fidelity, both.errors, both.ms_per_second) == (Fidelity.RIGID, {"path": 0.002, "load": 0.02}, 4.0)
    assert [c.fidelity for c in levels(rows, ["load"])] == [Fidelity.TABLE, Fidelity.RIGID]  # one run failed
    message = "path right to 0.0015 and load right to 0.025; the best is path 0.002 and load 0.02 away"
    with pytest.raises(ValueError, match=re.escape(message)):
        cheapest(rows, {"path": 0.0015, "load": 0.025})


def test_tyres_at_ports_are_refused():
    with pytest.raises(ModelError, match=r"ports\.tyre"):
        compile_fidelities(load("saloon").changed({"ports.tyre": "hub"}))


def drive_file(tmp_path):
    file = tmp_path / "turn.csv"
    file.write_text("time,steering,brake\n0,0,0\n0.2,0.1,0\n0.4,0.1,0.2\n")
    return file


@pytest.mark.slow
def test_the_command_names_the_cheapest_for_a_drive_of_ones_own(tmp_path, capsys):
    result = tmp_path / "levels.json"
    arguments = ["car", "saloon", "--cheapest", f"drive={drive_file(tmp_path)}", "speed=10"]
    assert main([*arguments, "loads=5", "--json", str(result)]) == 0
    printed = capsys.readouterr().out
    assert "saloon: errors against fidelity 0 with steps of 0.5 ms, the largest of: turn" in printed
    assert "Cheapest within 1 % of the path and 5 % of the wheel loads: fidelity " in printed
    content = json.loads(result.read_text())
    assert content["reference"] == {"fidelity": 0, "h_s": 0.0005}
    assert content["tolerances"] == {"path": 0.01, "load": pytest.approx(0.05)}
    assert content["cheapest"]["fidelity"] in (0, 10)
    assert {row["manoeuvre"] for row in content["rows"]} == {"turn"}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (["--cheapest", "path=0"], "path of --cheapest is 0; it is in percent and must be positive."),
        (["--cheapest", "path=nan"], "path of --cheapest: the value is nan"),
        (["--cheapest", "loads=x"], "loads of --cheapest: 'x' is not a number."),
        (["--cheapest", "load=5"], "--cheapest takes path, loads, moments, drive and speed, each as NAME=VALUE"),
        (["--cheapest", "pth=5"], "each as NAME=VALUE, not 'pth'; did you mean 'path'?"),
        (["--cheapest", "moments=5"], "The car 'saloon' has no moments in a frame"),
        (["--cheapest", "speed=5"], "give drive=FILE too"),
        (["--cheapest", "speed=72km/h", "path=2%"], "give drive=FILE too"),
        (["--cheapest", "speed=72km"], "speed of --cheapest: '72km' is not a number; write one in m/s"),
        (["--cheapest", "--travel", "-3cm", "2.5e1mm"], "--travel needs --kinematics."),
        (["--cheapest", "--travel", "-1", "1"], "--travel needs --kinematics."),
        (["--kinematics", "--cheapest"], "--cheapest needs a call without --kinematics."),
        (["folder", "--json", "x.json"], "--json needs a CAR alone, --kinematics or --cheapest."),
        (["folder", "--cheapest"], "A car is copied to a FOLDER, or its levels are compared"),
        (["--cheapest", "drive=none.csv"], "none.csv"),
    ],
)
def test_invalid_values_are_refused(given, message, capsys):
    assert main(["car", "saloon", *given]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time,stering\n0,0\n1,0\n", "the car has no input 'stering'; it has brake, steering"),
        ("steering\n0\n", "has no column 'time'"),
        ("time,steering\n1,0\n2,0\n", "times go from 1 to 2 s"),
    ],
)
def test_tables_that_are_no_drive(text, message, tmp_path):
    file = tmp_path / "drive.csv"
    file.write_text(text)
    with pytest.raises(FileError, match=re.escape(message)):
        read_drive(file, 0.0, ["steering", "brake"])


def test_a_car_without_steering_needs_a_drive_of_its_own():
    system = compile(load("saloon").changed({"ports.steering": "rack_position"}).model())
    assert "slalom" not in [drive.name for drive in default_drives(system)]
