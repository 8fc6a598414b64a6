"""Angles that are whole turns apart are the same: in a comparison, a fit, a reference and a measure."""

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hosts.check.command import main as check
from hosts.common.angles import angle_difference, continuous
from hosts.compare.command import main as compare
from hosts.driving.co_simulation import run as drive
from hosts.driving.manoeuvre_table import read_table
from hosts.fmu.fmu import Fmu
from hosts.run.command import main as run_main
from hosts.study.measures.study_measure import parse_measure
from tests.in_process import run

TURNS = 3.0


@pytest.fixture(scope="module")
def fmu(scene_fmu: Callable[..., Path]) -> Path:
    return scene_fmu(f"{Path(__file__).with_name('scenes.py')}:turntable")


@pytest.fixture(scope="module")
def log(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The result of a run over more than three turns, which the heading shows as a saw."""
    folder = tmp_path_factory.mktemp("turns")
    (folder / "drive.csv").write_text('"time","pull"\n0,0\n1,6\n3,8\n5,-2\n6,0\n')
    done = run(run_main, fmu, "-m", folder / "drive.csv", "--step", 0.01, "--out", folder)
    assert done.returncode == 0, done.stderr
    file = folder / "turntable_drive.csv"
    yaw = column(file, "chassis.yaw")
    assert np.abs(yaw).max() <= math.pi
    assert np.unwrap(yaw)[-1] > TURNS * math.tau
    return file


def column(file: Path, name: str) -> np.ndarray:
    with file.open() as stream:
        return np.array([float(row[name]) for row in csv.DictReader(stream)])


def altered(log: Path, folder: Path, heading: Callable[[np.ndarray], np.ndarray], every: int = 1) -> Path:
    """A log with the inputs of the run and another heading."""
    time, pull, wz = (column(log, n) for n in ("time", "pull", "chassis.wz"))
    rows = np.column_stack([time, pull, heading(column(log, "chassis.yaw")), wz])[::every]
    file = folder / "log.csv"
    np.savetxt(file, rows, delimiter=",", header="time,pull,chassis.yaw,chassis.wz", comments="")
    return file


def numbers(fmu: Path, log: Path, *options: object) -> dict:
    record = log.parent / "record.json"
    done = run(compare, fmu, log, "--step", 0.01, "--json", record, "--out", log.parent / "out", *options)
    assert record.exists(), done.stdout + done.stderr
    return json.loads(record.read_text())


def of_heading(record: dict, what: str) -> float:
    return next(m["value"] for m in record["measures"] if m["name"] == f"chassis.yaw.{what}")


@pytest.mark.slow
def test_windows_in_any_turn_are_the_same(fmu: Path, log: Path, tmp_path: Path) -> None:
    """Each begins as drawn, where the log has turned on: whole turns count in each window for itself."""
    still = altered(log, tmp_path, lambda yaw: np.repeat(math.tau * np.arange(3), 201)[: len(yaw)])
    text = still.read_text().splitlines()
    still.write_text("\n".join([text[0], *(",".join([r.split(",")[0], "0", r.split(",")[2], "0"]) for r in text[1:])]))
    assert of_heading(numbers(fmu, still, "--windows", 2, "--signals", "chassis.yaw"), "rms") < 1e-9


@pytest.mark.slow
def test_an_error_of_the_heading_is_reported(fmu: Path, log: Path, tmp_path: Path) -> None:
    """By its own size, also where the simulated heading is in another turn."""
    record = numbers(fmu, altered(log, tmp_path, lambda yaw: np.mod(yaw + 0.3, math.tau)))
    assert of_heading(record, "mean") == pytest.approx(-0.3, abs=1e-9)
    assert abs(of_heading(record, "delay")) < 1e-6


@pytest.mark.slow
def test_a_fit_by_a_heading_over_three_turns(fmu: Path, log: Path, tmp_path: Path) -> None:
    wrapped = altered(log, tmp_path, lambda yaw: np.mod(yaw, math.tau))
    record = numbers(
        fmu, wrapped, "--set", "damping=1.2", "--fit", "damping=0.5:3", "--signals", "chassis.yaw", "--anyway"
    )
    (actual,) = record["fit"]["found"]
    assert actual["value"] == pytest.approx(1.0, abs=1e-5)


@pytest.mark.slow
def test_a_reference_in_another_range(fmu: Path, log: Path, tmp_path: Path) -> None:
    good = altered(log, tmp_path, lambda yaw: np.mod(yaw, math.tau), every=10)
    done = run(check, fmu, "--reference", good, "--step", 0.01)
    assert "chassis.yaw" in done.stdout
    assert done.returncode == 0, done.stdout
    off = altered(log, tmp_path, lambda yaw: np.mod(yaw + 0.3, math.tau))
    done = run(check, fmu, "--reference", off, "--step", 0.01)
    assert next(line for line in done.stdout.splitlines() if "chassis.yaw" in line).split()[2] == "0.3"


def test_a_measure_counts_turns(fmu: Path, log: Path) -> None:
    with Fmu(fmu) as opened:
        result = drive(opened, read_table(log, {"pull"}), 0.01)
    angle, units = np.unwrap(column(log, "chassis.yaw")), {"chassis.yaw": "rad", "chassis.wz": "rad/s"}
    for text, expected in (("final(chassis.yaw)", angle[-1]), ("range(chassis.yaw)", np.ptp(angle))):
        (actual,) = parse_measure(text).evaluate(result)
        assert actual.value == pytest.approx(float(expected), abs=1e-6)
        assert parse_measure(text).columns(units) == {text: "rad"}


def test_whole_turns_and_gaps() -> None:
    turn = np.linspace(0.0, 40.0, 300)
    saw = np.arctan2(np.sin(turn), np.cos(turn))
    saw[50] = math.nan
    kept = np.isfinite(saw)
    assert continuous(saw)[kept] == pytest.approx(turn[kept])
    assert angle_difference(saw, turn + 0.5 - 6.0 * math.tau)[kept] == pytest.approx(-0.5)
    assert continuous(np.array([0.0, 4.5, 0.0])) == pytest.approx([0.0, 4.5, 0.0]), "a steering wheel"
    once_more = angle_difference(turn + np.linspace(0.0, math.tau, 300), turn - 2.0 * math.tau)
    assert np.ptp(once_more) == pytest.approx(math.tau), "a turn in the meantime counts"
    assert len(angle_difference([], [])) == 0
