"""The command of cars: its rows, its verdict, its files; frames."""

import json

import pytest

from benchmarks import frame
from benchmarks.car import __main__ as car
from benchmarks.car.accuracy import STEPS
from benchmarks.paper.kerb import residual_moments
from mbs.vehicle import Fidelity

KEYS = {
    "car", "manoeuvre", "h_s", "path_error_m", "path_error_rel", "wheel_load_error_rel", "iterations_mean",
    "iterations_max", "halvings", "us_per_step", "realtime_factor",
    "path_error_rel_fmpy_held", "path_error_rel_fmpy_followed", "wheel_load_error_rel_fmpy_held",
    "wheel_load_error_rel_fmpy_followed",
}  # fmt: skip


@pytest.mark.slow
def test_rows_and_files(tmp_path, capsys):
    file = tmp_path / "car.json"
    arguments = ["--no-fmu", "--repeats", "1", "--only", "kerb_drop", "--json", str(file)]
    assert car.main(["accuracy", *arguments]) == 0
    written = json.loads(file.read_text(encoding="utf-8"))
    assert set(written) == {"meta", "rows"}
    assert [row["h_s"] for row in written["rows"]] == list(STEPS)
    for row in written["rows"]:
        assert set(row) == KEYS
        assert row["path_error_rel_fmpy_held"] is None
        assert row["realtime_factor"] * row["us_per_step"] == pytest.approx(1e6 * row["h_s"])
        assert 0.0 < row["path_error_rel"] < row["path_error_m"] < 0.01
    errors = [row["wheel_load_error_rel"] for row in written["rows"]]
    assert errors == sorted(errors, reverse=True)
    assert "| 8 cm kerb at 5 m/s | 5 |" in capsys.readouterr().out


def test_a_car_without_references_is_reported(capsys):
    assert car.main(["references", "--car", "bus"]) == 2
    assert "There are no references of a car 'bus'; there are: prototype" in capsys.readouterr().err


def test_the_stiffness_of_a_frame_is_measured_and_written(tmp_path):
    file = tmp_path / "stiffness.json"
    assert frame.main(["stiffness", "--cars", "prototype", "--json", str(file)]) == 0
    (row,) = json.loads(file.read_text())["rows"]
    assert row["between"] == "TFL and TRL"
    # with the rear towers held against all motion it is 2.37 kN m/deg
    assert row["kN m/deg"] == pytest.approx(2.07, abs=0.01)
    assert row["f1, Hz"] == pytest.approx(15.20, abs=0.01)


@pytest.mark.slow
def test_moments_that_friction_holds_go_with_it_and_nothing_is_warned_of():
    """The tyres hold the car sideways on the kerb; what is left without friction is 11 times less."""
    held, free = residual_moments(Fidelity(2), 0.02)
    assert 0.05 < held < 0.1
    assert free < 0.01
