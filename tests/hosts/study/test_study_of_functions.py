"""A study of a real FMU with functions of the user's, from its file to the indices of its report."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from hosts.study.command import main
from hosts.study.store import read_study

STUDY = """fmu = "{fmu}"
name = "functions"
[[manoeuvres]]
name = "release"
stop_time = 0.5
[sampling]
method = "saltelli"
runs = 256
seed = 3
[parameters."spring.stiffness"]
range = [50.0, 150.0]
[parameters."spring.damping"]
range = [0.0, 4.0]
[parameters."spring.free_length"]
range = [0.6, 1.0]
[measures]
linear = "functions.py:linear"
start_force = "functions.py:start_force"
"""
FUNCTIONS = '''
def linear(result, parameters):
    """Of the three parameters as -1 to 1."""
    ranges = {"spring.stiffness": (50.0, 150.0), "spring.damping": (0.0, 4.0), "spring.free_length": (0.6, 1.0)}
    a, b, c = (2.0 * (parameters[n] - a) / (b - a) - 1.0 for n, (a, b) in ranges.items())
    return 3.0 * a - 2.0 * b + 0.5 * c

def start_force(result):
    """Upward acceleration at the start, from the motion of the FMU: k/m (free_length - length) - g."""
    y, h = result["bob.y"], result.time[1]
    return 2.0 * (y[1] - y[0]) / h**2
start_force.units = "m/s2"
'''


@pytest.mark.slow
def test_indices_are_those_of_the_functions(tuned: Path, tmp_path: Path, in_process: None) -> None:
    """Of a linear function in closed form; of the first step a mass of 2 kg makes on a spring of length 1 m."""
    (tmp_path / "study.toml").write_text(STUDY.format(fmu=tuned))
    (tmp_path / "functions.py").write_text(FUNCTIONS)
    folder = tmp_path / "out"
    assert main([str(tmp_path / "study.toml"), "--out", str(folder)]) == 0
    effects = pd.read_csv(folder / "analysis" / "effects.csv").set_index(["measure", "parameter"])
    slopes = np.array([3.0, -2.0, 0.5])
    expected = slopes**2 / (slopes**2).sum()
    linear = effects.loc["linear"]
    assert linear["first"].to_numpy() == pytest.approx(expected, abs=0.02)
    assert linear["total"].to_numpy() == pytest.approx(expected, abs=0.02)
    # Means over the outer tenths of a range of -1 to 1 are 1.8 apart.
    assert linear["main_effect_span"].to_numpy() == pytest.approx(1.8 * np.abs(slopes), abs=0.4)
    frame = read_study(folder)
    assert (frame["status"] == "done").all()
    assert frame.attrs["units"]["start_force"] == "m/s2"
    force = frame["spring.stiffness"] / 2.0 * (1.0 - frame["spring.free_length"]) - 9.81
    assert np.abs(frame["start_force"] - force).max() < 0.05 * np.abs(force).max()
    assert effects.loc[("start_force", "spring.damping"), "total"] < 0.01  # nothing at rest
    assert effects.loc[("start_force", "spring.free_length"), "total"] > 0.5
