"""Ports that a program in C++ sets at every communication point: the bits and the warnings that FMPy gets."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from hosts.fmu.fmu import Fmu
from tests.fmu.native import unpack
from tests.hosts.c.test_fmu_header import compiled
from tests.hosts.systems.weak_coupling import car_fmu
from tests.vehicle.cars_with_ports import WHEELS
from tests.vehicle.test_road_port import WAVES

STEP = 0.002  # s
SPEED = 10.0  # m/s
ROWS = 600
SILENT = 200


def table() -> dict[str, np.ndarray]:
    """Torques, answers of a wavy road under a car that rolls on at its speed, and a force that pushes it aside."""
    t = STEP * np.arange(SILENT)
    columns = {"steering": 0.1 * np.sin(3.0 * t), "point_reference.Fy": 800.0 * np.sin(5.0 * t)}
    for k, w in enumerate(WHEELS):
        x, y = SPEED * t - 2.5 * (k > 1), (0.7, -0.7)[k % 2] + 0.0 * t
        slope = np.array([WAVES.slope(v) for v in x])
        columns |= {f"wheel_{w}.drive_torque": 150.0 * np.sin(4.0 * t + k) if k < 2 else 0.0 * t}
        columns |= {f"wheel_{w}.road_x": x, f"wheel_{w}.road_y": y}
        columns[f"wheel_{w}.road_height"] = np.array([WAVES.height(v) for v in x])
        columns[f"wheel_{w}.road_normal_x"] = -slope / np.hypot(1.0, slope)
        columns[f"wheel_{w}.road_normal_z"] = 1.0 / np.hypot(1.0, slope)
    return columns


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("c++") is None, reason="there is no c++")
def test_outputs_and_warnings_of_silent_ports_are_those_of_fmpy(tmp_path: Path) -> None:
    """From the 200th of 600 steps on nobody sets anything, which is told after half a second."""
    path, columns = car_fmu("hatchback", "torque,road,forces"), table()
    rows = np.column_stack(list(columns.values()))
    with Fmu(path) as car:
        names = sorted(n for n in car.names("output") if car.variables[n].type == "Real")
        car.initialise({"initial.speed": SPEED})
        give, read, expected = car.setter(list(columns)), car.getter(names), []
        for k in range(ROWS):
            if k < SILENT:
                give(rows[k].tolist())
            car.step(STEP * k, STEP)
            expected.append(read())
        messages = list(car.messages)
    lines = [" ".join(columns), *(" ".join(map(float.hex, row)) for row in rows.tolist()), *[""] * (ROWS - SILENT)]
    program = compiled(["c++"], Path(__file__).with_name("ports.cpp"), tmp_path)
    command = [str(program), str(unpack(path, tmp_path / "car")), str(STEP), str(SPEED)]
    done = subprocess.run(command, input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    values = np.array([[float.fromhex(word) for word in line.split()] for line in done.stdout.splitlines()])
    assert values.shape == (ROWS, len(names))
    assert (np.ptp(values, axis=0) > 0.0).mean() > 0.6
    assert values.tobytes() == np.array(expected).tobytes()
    assert done.stderr.splitlines() == messages
    (silent,) = (text for text in messages if "received numbers" in text)
    assert "get none any more" in silent
