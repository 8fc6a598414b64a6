"""The command that writes the loads of a car's frame."""

from pathlib import Path

import pytest

import mbs
from benchmarks.frame import main
from mbs.vehicle import Fidelity, load
from tests.vehicle.frame_cars import small_frame, written

REST = {"drive.creep_torque": 0.0}


@pytest.mark.slow
def test_loads_of_the_own_manoeuvres_give_the_load_paths(tmp_path: Path) -> None:
    """The command writes the table that the car then names; few modes bend the frame like all of them."""
    folder = written(small_frame(tmp_path))
    assert main(["loads", "--car", str(folder), "--only", "launch_and_brake", "step_steer_given_throttle"]) == 0
    car = load(folder).changed({"chassis.frame.loads": "loads.csv"})
    assert Fidelity.LOAD_PATHS in car.fidelities()
    few, all_modes = (car.flexible_frame.reduced(fidelity).n_modes for fidelity in (2, 3))
    assert 10 <= few < all_modes / 2
    paths, modes = (
        mbs.Simulation(mbs.compile(car.model(fidelity=fidelity)), parameters=REST).sensors for fidelity in (2, 3)
    )
    for name, error in (("axial_force.H", 0.01), ("stress.G", 0.01), ("bending_moment.F", 0.04)):
        assert paths[name] == pytest.approx(modes[name], rel=error)
