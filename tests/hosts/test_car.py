"""The FMU of the prototype car in the manoeuvres of the host, by the command."""

from dataclasses import replace
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv

import mbs
from fmu_src.build.scene_registry import load_scene
from hosts.driving.write_manoeuvre import write_manoeuvre
from hosts.recordings.load_manoeuvre import load_manoeuvre
from hosts.run.command import main
from mbs.simulation.state import Pose
from tests.in_process import run

STEP = 0.01


@pytest.fixture(scope="module")
def car(prototype_fmu: Path) -> tuple[mbs.System, Path]:
    return load_scene("prototype_car")[1], prototype_fmu


def drive(car: tuple[mbs.System, Path], manoeuvre: str, folder: Path, step: float = STEP) -> tuple[np.ndarray, str]:
    """Results and what the command printed; every step must have been accepted, without a word from the FMU."""
    done = run(main, car[1], "--manoeuvre", manoeuvre, "--step", step, "--out", folder)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "FMU:" not in done.stdout
    return read_csv(folder / f"prototype_car_{Path(manoeuvre).stem}.csv"), done.stdout


def test_the_constants_agree_with_the_motion_of_the_car(car: tuple[mbs.System, Path]) -> None:
    variables = {v.name: v for v in fmpy.read_model_description(str(car[1])).modelVariables}
    constants = {n.removeprefix("vehicle."): float(v.start) for n, v in variables.items() if n.startswith("vehicle.")}
    names = ["wheel_FL.steer", "wheel_FR.steer", "steering_wheel_angle"]
    start = {"steering": 1.0, "brake": 1.0}
    driven = fmpy.simulate_fmu(str(car[1]), stop_time=2.0, start_values=start, output=names)
    left, right, turned = (float(driven[n][-1]) for n in names)
    assert left > right > 0.0
    assert constants["front_wheel_angle_max"] == pytest.approx(0.5 * (left + right), rel=2e-3)
    assert constants["steering_wheel_angle_max"] == pytest.approx(turned, rel=1e-9)
    assert constants["steering_ratio"] == constants["steering_wheel_angle_max"] / constants["front_wheel_angle_max"]
    # Ackermann: the cotangents of the angles differ by track over wheelbase, of this car by a little less
    ideal = constants["track_front"] / constants["wheelbase"]
    assert 0.5 * ideal < 1.0 / np.tan(right) - 1.0 / np.tan(left) < 1.5 * ideal


@pytest.mark.slow
def test_launch_and_brake(car: tuple[mbs.System, Path], tmp_path: Path) -> None:
    r, output = drive(car, "launch_and_brake", tmp_path)
    t, speed = r["time"], r["speed"]
    assert 20.0 < speed.max() < 35.0
    assert np.all(np.diff(speed[(t > 1.5) & (t < 9.0)]) > 0.0)
    assert speed[t > 14.0].max() < 1e-2
    assert np.ptp(r["chassis.x"][t > 14.0]) < 1e-3
    assert np.abs(r["chassis.y"]).max() < 1e-3
    works = [r[f"energy.{n}"][-1] for n in ("drive", "brakes", "tyres", "dampers", "drag", "ground")]
    stored = sum(r[f"energy.{n}"][-1] - r[f"energy.{n}"][0] for n in ("kinetic", "gravity", "elastic"))
    assert works[0] > 2e5  # J
    assert stored - sum(works) - r["solver.energy_error"][-1] == pytest.approx(0.0, abs=1e-6 * works[0])
    energies = {row.split("  ")[0]: row.split()[-2:] for row in output.splitlines() if " kJ" in row}
    assert float(energies["- work of drive"][0]) == pytest.approx(1e-3 * works[0], abs=1e-4)
    assert float(energies["change of the energy"][0]) == pytest.approx(1e-3 * stored, abs=1e-4)
    assert abs(float(energies["- structure, rest"][0])) < 1e-6 * works[0]


def test_double_lane_change_is_passed(car: tuple[mbs.System, Path], tmp_path: Path) -> None:
    r, output = drive(car, "double_lane_change", tmp_path)
    assert "ISO 3888-1                 passed" in output
    assert r["speed"].min() > 18.5
    assert np.abs(r["chassis.ay"]).max() > 4.0


def test_fmu_is_the_engine_bit_for_bit(car: tuple[mbs.System, Path], tmp_path: Path) -> None:
    """The slalom with one inner step per communication step, against the engine stepped by hand."""
    system, _ = car
    h = float(system.meta["experiment"]["step_s"])
    slalom = load_manoeuvre("slalom")
    manoeuvre = replace(slalom, held=frozenset(slalom.inputs))
    write_manoeuvre(manoeuvre, tmp_path / "held.toml")
    r, _ = drive(car, str(tmp_path / "held.toml"), tmp_path, h)
    simulation = mbs.Simulation(system, inputs=manoeuvre.at(0.0), pose=Pose(speed=15.0))
    outputs = [s["name"] for s in system.meta["sensors"] if s.get("computed", True)]
    for k in range(round(2.0 / h)):
        for name, value in manoeuvre.at(k * h).items():
            simulation.set_input(name, value)
        simulation.step(h)
        if k % 100 == 99:
            assert [float(r[name][k + 1]) for name in outputs] == [simulation.sensors[n] for n in outputs]
