"""A result of `ali3 run` as the log: the held inputs of its record drive the FMU as in the run."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from hosts.compare.command import main
from hosts.driving.manoeuvre_table import read_table
from hosts.run.command import main as run

pytestmark = pytest.mark.usefixtures("in_process")

ROWS = (
    ("time", "pull", "spring.stiffness"),
    (0.0, 0.0, 100.0),
    (0.5, 6.0, 100.0),
    (1.1, -4.0, 180.0),
    (2.0, 5.0, 90.0),
)


def test_held_inputs_and_parameters_that_change(tuned, tmp_path, capsys):
    table = tmp_path / "drive.csv"
    table.write_text("# held: pull\n" + "\n".join(",".join(map(str, row)) for row in ROWS) + "\n")
    assert run([str(tuned), "-m", str(table), "--step", "0.05", "--out", str(tmp_path)]) == 0
    log = next(tmp_path.glob("*_drive.csv"))
    capsys.readouterr()
    assert main([str(tuned), str(log), "--step", "0.05", "--out", str(tmp_path / "compared")]) == 0
    output = capsys.readouterr().out
    assert "Tunable parameters that the log drives, each held until its next row: spring.stiffness." in output
    assert _largest(tmp_path / "compared" / log.name) < 1e-9


JUMPS = ((0.0, 1.0), (0.5, 1.5), (0.5, -20.0), (1.3, -9.0), (1.3, 12.0), (2.0, 3.0))


@pytest.mark.slow
def test_a_jump_means_the_same_as_in_the_run(tuned, tmp_path, capsys):
    """Of a result, whose record tells the jumps, and of samples with two rows where the input jumps."""
    table = tmp_path / "drive.csv"
    table.write_text("time,pull\n" + "\n".join(f"{t},{x}" for t, x in JUMPS) + "\n")
    options = ["--step", "0.05", "--interval", "0.1"]
    assert run([str(tuned), "-m", str(table), *options, "--out", str(tmp_path)]) == 0
    log, manoeuvre = next(tmp_path.glob("*_drive.csv")), read_table(table)
    with log.open() as file:
        result = list(csv.DictReader(file))
    samples = [
        (row["time"], manoeuvre.at(float(row["time"]), before=before)["pull"], row["bob.x"], row["bob.y"])
        for row in result
        for before in (True, False)
    ]
    measured = tmp_path / "measured.csv"
    measured.write_text("time,pull,bob.x,bob.y\n" + "\n".join(",".join(map(str, row)) for row in samples) + "\n")
    for name in (log, measured):
        capsys.readouterr()
        assert main([str(tuned), str(name), "--step", "0.05", "--out", str(tmp_path / "compared")]) == 0
        assert "2 of pull, the first at 0.5 s." in capsys.readouterr().out
        assert _largest(tmp_path / "compared" / name.name) < 1e-9
    # between communication points it is a line in both, and told
    assert main([str(tuned), str(log), "--step", "0.04", "--out", str(tmp_path / "compared")]) == 0
    assert "2 of pull, the first at 0.5 s: each becomes a line over its step of 40 ms" in capsys.readouterr().out


def _largest(table: Path) -> float:
    """Largest deviation of the bob, which moves, m."""
    with table.open() as file:
        rows = list(csv.reader(file))
    heading, values = rows[0], np.array([[float(x or "nan") for x in row] for row in rows[1:]])
    largest = 0.0
    for name in ("bob.x", "bob.y"):
        measured, simulated = (values[:, heading.index(f"{name}.{what} [m]")] for what in ("measured", "simulated"))
        assert np.ptp(measured) > 0.005
        largest = max(largest, float(np.max(np.abs(simulated - measured))))
    return largest


def test_a_set_parameter_is_not_driven_by_the_log(tuned, tmp_path, capsys):
    log = tmp_path / "log.csv"
    rows = [f"{0.02 * k},{np.sin(0.02 * k)},{100 + k},{0.1 * np.sin(0.02 * k)}" for k in range(100)]
    log.write_text("time,pull,spring.stiffness,bob.x\n" + "\n".join(rows) + "\n")
    assert main([str(tuned), str(log), "--set", "spring.stiffness=120", "--out", str(tmp_path / "out")]) == 0
    output = capsys.readouterr().out
    assert "In the log, and set or sought instead: spring.stiffness." in output
    assert "Tunable parameters" not in output


@pytest.mark.slow
def test_a_car_starts_as_the_run_did(prototype_fmu, tmp_path, capsys):
    step = ["--step", "0.01", "--out", str(tmp_path)]
    start = ["--set", "initial.speed=12", "--set", "initial.z=0.05", "--stop-time", "1.5"]
    assert run([str(prototype_fmu), "-m", "slalom", *start, *step]) == 0
    log = next(tmp_path.glob("*_slalom.csv"))
    capsys.readouterr()
    record = tmp_path / "compared.json"
    names = ["--signals", "wheel_FL.Fz,chassis.vy", "--json", str(record)]
    assert main([str(prototype_fmu), str(log), *names, *step]) == 0
    assert "the start is that of its record: initial.speed = 12.0, initial.z = 0.05." in capsys.readouterr().out
    largest = {m["name"]: m["value"] for m in json.loads(record.read_text())["measures"]}
    assert abs(largest["wheel_FL.Fz.largest"]) < 1e-6
    assert abs(largest["chassis.vy.largest"]) < 1e-9
    # a part of it begins in motion, which the record does not tell
    main([str(prototype_fmu), str(log), "--signals", "chassis.vy", *step, "--from", "0.5"])
    assert "The start is as measured" in capsys.readouterr().out
