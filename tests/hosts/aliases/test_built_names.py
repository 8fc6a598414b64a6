"""``ali3 build --names`` and ``--aliases`` are inverse: a car under other names drives as under ours."""

import json
from pathlib import Path

import numpy as np
import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.standard_test import TestRecord
from hosts.catalogue.task import Task, perform_task, write_runs
from hosts.common.options import FmuOptions
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.file import find_aliases
from hosts.fmu.fmu import described
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.geometry import scene_of
from hosts.fmu.variables import Variables
from hosts.run.command import main as run
from hosts.view.result_tables import read_table
from hosts.view.view_sources import ViewRunOptions, recordings_of
from tests.hosts.plant.conftest import Made
from tests.in_process import build_fmu
from tests.quick import quick

NAMES = (
    *("chassis.x", "chassis.yaw", "chassis.roll", "chassis.vx", "chassis.vy", "chassis.wz", "chassis.ay", "sideslip"),
    *("wheel_FL.Fz", "wheel_RR.omega", "wheel_FL.slip", "wheel_FR.steer", "wheel_RL.travel", "engine_speed"),
)
THEIRS = {
    "carsim": "IMP_STEER_SW",
    "chrono": "ref_frame.rot.e0",
    "osi": "host_vehicle_data.vehicle_wheels.wheel[0].slip",
}


def driven(fmu: Path, names: str | None) -> dict[str, np.ndarray]:
    aliases = Aliases() if names is None else find_aliases(names, Variables(described(fmu)))
    time = np.linspace(0.0, 3.0, 301)
    inputs = {
        "steering": 0.3 * np.sin(2.0 * time),
        "throttle": 0.1 + 0.0 * time,
        "brake": 0.2 * np.maximum(time - 2.0, 0.0),
    }
    turn = Manoeuvre("turn", time=time, inputs=inputs, start={"initial.speed": 15.0}, stop_time=3.0)
    record = TestedCar("a car", FmuSource(fmu, aliases), step=0.01).drive(turn)
    return {name: record[name] for name in NAMES}


@pytest.fixture(scope="module")
def ours(prototype_fmu: Path) -> dict[str, np.ndarray]:
    return driven(prototype_fmu, None)


@pytest.mark.slow
@pytest.mark.parametrize("names", THEIRS)
def test_a_car_under_other_names_is_driven_through_its_alias_file(names, ours, renamed_fmu):
    """All of CarMaker's are in the test with ports."""
    theirs = renamed_fmu(names)
    assert THEIRS[names] in Variables(described(theirs)).names
    one, two = ours, driven(theirs, names)
    assert np.ptp(one["chassis.yaw"]) > 0.3
    for name in NAMES:
        assert two[name] == pytest.approx(one[name], rel=1e-7, abs=1e-9 * np.max(np.abs(one[name]))), name


def ported_fmu(made_once: Made, names: str | None) -> Path:
    """The rigid prototype with ports, under the names of another program or ours."""
    options = ("--car", "prototype", "--fidelity", "0", "--ports", "torque,brakes,road,forces")
    options += () if names is None else ("--names", names)
    return next(made_once(f"ported_{names}", lambda folder: build_fmu(folder, *options)).glob("*.fmu"))


def ported(fmu: Path, names: str | None) -> Result:
    """Every port takes part."""
    aliases = Aliases() if names is None else find_aliases(names, Variables(described(fmu)))
    time = np.linspace(0.0, 2.0, 201)
    inputs = {"steering": 0.2 * np.sin(2.0 * time), "point_reference.Fy": 400.0 * np.sin(5.0 * time)}
    for k, w in enumerate(("FL", "FR", "RL", "RR")):
        inputs |= {
            f"wheel_{w}.drive_torque": 80.0 * np.sin(3.0 * time + k),
            f"wheel_{w}.brake_torque_demand": 100.0 * np.maximum(time - 1.5, 0.0),
            f"wheel_{w}.road_height": 0.01 * (1.0 - np.cos(4.0 * time + k)),
        }
    turn = Manoeuvre("turn", time=time, inputs=inputs, start={"initial.speed": 12.0}, stop_time=2.0)
    return TestedCar("a car", FmuSource(fmu, aliases), step=0.01).drive(turn)


@pytest.mark.slow
@pytest.mark.parametrize("names", quick(("carmaker",), ("carmaker", "chrono"), "proof"))
def test_all_outputs_of_a_car_with_ports_are_the_same_under_other_names(names, made_once):
    one, theirs = ported(ported_fmu(made_once, None), None), ported_fmu(made_once, names)
    two = ported(theirs, names)
    assert two.failed_steps == one.failed_steps == 0
    assert set(one.names) <= set(two.names)
    moved = 0
    for name in one.names:
        if name.startswith("solver."):  # round-off itself, or near it
            continue
        scale = np.max(np.abs(one[name]))
        moved += np.ptp(one[name]) > 1e-3 * scale
        assert two[name] == pytest.approx(one[name], rel=1e-7, abs=1e-9 * scale), name
    assert moved > 150


@pytest.mark.slow
def test_run_drives_a_car_under_other_names(prototype_fmu, renamed_fmu, tmp_path, capsys):
    """A manoeuvre with a driver, values of --set in the FMU's names, and a table that repeats the run."""
    theirs = str(renamed_fmu("carsim"))
    drive = ["-m", "double_lane_change", "--stop-time", "4", "--step", "0.01", "--set", "road.friction=0.8"]
    alias = ["--aliases", "carsim"]
    assert run([str(prototype_fmu), *drive, "--out", str(tmp_path / "plain")]) == 0
    assert run([theirs, *alias, *drive, "--out", str(tmp_path / "theirs")]) == 0
    (again,) = (tmp_path / "theirs").glob("*.csv")
    assert run([theirs, *alias, "-m", str(again), "--out", str(tmp_path / "again")]) == 0
    one, two, three = (read_table(next((tmp_path / n).glob("*.csv"))).columns for n in ("plain", "theirs", "again"))
    assert np.ptp(one["steering"]) > 0.1
    for name in NAMES:
        bound = 1e-7 * float(np.max(np.abs(one[name])))
        assert two[name] == pytest.approx(one[name], abs=bound), name
        assert three[name] == pytest.approx(one[name], abs=bound), name
    (shown,), _, _ = recordings_of([again], None, ViewRunOptions(None, None, None, FmuOptions([], [])))
    assert [item["name"] for item in shown.missing] == ["steering wheel"], "which is in degrees there"
    capsys.readouterr()
    assert run([theirs, *drive, "--out", str(tmp_path / "none")]) != 0
    assert "steering" in (errors := capsys.readouterr().err)
    assert "--aliases" in errors


@pytest.mark.slow
def test_runs_of_the_catalogue_are_drawn_as_those_of_other_names(renamed_fmu, tmp_path):
    theirs = renamed_fmu("carsim")
    aliases = find_aliases("carsim", Variables(described(theirs)))
    car = TestedCar("a car", FmuSource(theirs, aliases), start={"initial.speed": 0.0, "steering": 0.5})
    task = Task("drop", car, {}, tmp_path)
    record = perform_task(task, lambda part: None)
    assert isinstance(record, TestRecord)
    write_runs(task, record)
    (table,) = tmp_path.rglob("*.csv")
    (shown,), _, _ = recordings_of([table], None, ViewRunOptions(None, None, None, FmuOptions([], [])))
    assert shown.scene is not None
    assert shown.scene["shapes"]
    assert [item["name"] for item in shown.missing] == ["steering wheel"], "which is in degrees there"
    start = {entry["name"]: entry["new"] for entry in json.loads(table.with_suffix(".json").read_text("utf-8"))["set"]}
    assert set(start) <= set(Variables(described(theirs)).names)
    assert start["IMP_STEER_SW"] == pytest.approx(aliases.fmu_values({"steering": 0.5})["IMP_STEER_SW"])


@pytest.mark.slow
def test_marks_of_tyres_know_the_slips_of_a_car_under_other_names(renamed_fmu):
    theirs = renamed_fmu("carmaker")
    names = Variables(described(theirs)).names
    scene = scene_of(theirs)
    assert scene is not None
    tyres = [arrow for arrow in scene["arrows"] if "tyre" in arrow]
    assert len(tyres) == 4
    for arrow in tyres:
        wheel = arrow["name"][-2:]
        assert arrow["slips"]["slip"] == f"Car.LongSlip{wheel}"
        assert arrow["slips"]["slip_angle"] == f"Car.SlipAngle{wheel}"
        assert set(arrow["slips"].values()) <= set(names)
