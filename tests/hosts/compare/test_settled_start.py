"""A log that begins in a turn: unmeasured states have settled before the comparison begins."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from hosts.compare.command import main
from hosts.compare.measured_speed import smooth_speed
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.fmu import Fmu
from hosts.measures.signal import Signal

pytestmark = pytest.mark.usefixtures("in_process")

NAMES = ("speed", "chassis.vy", "chassis.wz", "chassis.ay")
BEGIN = 3.0  # s, by then the turn is steady


@pytest.fixture(scope="module")
def log(prototype_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One second of a turn with the inputs held, in which a new run stays if it begins in it."""
    t = np.array([0.0, 1.0, 5.0])
    inputs = {"steering": np.array([0.0, 0.1, 0.1]), "throttle": 0.1 + 0.0 * t}
    with Fmu(prototype_fmu) as fmu:
        result = run(fmu, Manoeuvre("turn", t, inputs, BEGIN + 1.0, {"initial.speed": 15.0}), 0.01)
    rows = result.time >= BEGIN - 1e-9
    columns = [result.time[rows] - BEGIN, *(result[n][rows] for n in ("steering", "throttle", *NAMES))]
    path = tmp_path_factory.mktemp("log") / "turn.csv"
    header = ",".join(("time", "steering", "throttle", *NAMES))
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="", fmt="%.9g")
    return path


def compared(car: Path, log: Path, folder: Path, *options: str) -> dict:
    record = folder / "record.json"
    chosen = ["--signals", "chassis.wz,chassis.ay,chassis.vy", "--out", str(folder / "out"), "--json", str(record)]
    assert main([str(car), str(log), *chosen, *options]) == 0
    return dict(json.loads(record.read_text()))


@pytest.mark.slow
def test_the_comparison_continues_in_the_turn(prototype_fmu: Path, log: Path, tmp_path: Path) -> None:
    """Without settling it begins as measured, at the reference point, 1.3 m behind the origin of the drawing."""
    settled = compared(prototype_fmu, log, tmp_path)
    drawn = compared(prototype_fmu, log, tmp_path, "--set", "initial.settling=0")
    assert abs(drawn["start"]["initial.yaw_rate"]) > 0.1
    with (tmp_path / "out" / "turn.csv").open(encoding="utf-8") as stream:
        first = {k: float(v) for k, v in next(csv.DictReader(stream)).items() if v}
    for name, unit, near in (("chassis.wz", "rad/s", 2e-3), ("chassis.vy", "m/s", 0.01)):
        assert first[f"{name}.simulated [{unit}]"] == pytest.approx(first[f"{name}.measured [{unit}]"], abs=near)
    assert settled["start"]["initial.settling"] > 0.0
    assert any("held in this motion" in n and "initial.settling" in n for n in settled["notes"])
    assert not any("held in this motion" in n for n in drawn["notes"])
    errors = [{m["name"]: m["value"] for m in record["measures"]} for record in (settled, drawn)]
    for name in ("chassis.wz", "chassis.ay"):
        assert errors[0][f"{name}.rms"] < 0.25 * errors[1][f"{name}.rms"], name


@pytest.mark.slow
def test_a_log_from_rest_needs_no_settling(prototype_fmu: Path, log: Path, tmp_path: Path) -> None:
    header, *rows = log.read_text().splitlines()
    at_rest = tmp_path / "rest.csv"
    at_rest.write_text("\n".join([header, *(f"{row.split(',')[0]},0,0,0,0,0,0" for row in rows)]))
    assert "initial.settling" not in compared(prototype_fmu, at_rest, tmp_path)["start"]


def test_the_acceleration_that_a_driver_follows_is_without_noise() -> None:
    t = np.arange(0.0, 5.0, 0.01)
    noise = 0.03 * np.random.default_rng(1).standard_normal(len(t))
    true = Signal("speed", "speed", "m/s", t, 20.0 - 6.0 * t + 1.5 * t**2)
    result = smooth_speed(Signal("speed", "speed", "m/s", t, true.values + noise))
    assert np.gradient(result.values - true.values, t).std() < 0.2 * np.gradient(noise, t).std()
    np.testing.assert_allclose(smooth_speed(true).values, true.values, atol=1e-9)  # a parabola stays
    for some in (slice(3), slice(15)):
        short = Signal("speed", "speed", "m/s", t[some], noise[some])
        np.testing.assert_array_equal(smooth_speed(short).values, short.values)


def test_a_gap_is_no_edge_of_the_speed() -> None:
    t = np.concatenate([np.arange(0.0, 2.0, 0.01), np.arange(4.0, 6.0, 0.01)])
    actual = smooth_speed(Signal("speed", "speed", "m/s", t, 50.0 - 6.0 * t))
    np.testing.assert_allclose(actual.values, 50.0 - 6.0 * t, atol=1e-9)
