"""A study of a real FMU, run on workers, analysed, and its worst runs repeated."""

import html
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import fmpy
import numpy as np
import pandas as pd
import pytest
from fmpy.util import read_csv

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from hosts.study.command import main
from hosts.study.store import read_study
from tests.in_process import run

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
STUDY = """fmu = "{fmu}"
name = "functions"
[[manoeuvres]]
name = "release"
stop_time = 0.5
[sampling]
method = "saltelli"
runs = 512
seed = 3
[parameters."spring.stiffness"]
range = [50.0, 150.0]
[parameters."spring.damping"]
range = [0.0, 4.0]
[parameters."spring.free_length"]
range = [0.6, 1.0]
[measures]
lowest = "min(bob.y)"
linear = "functions.py:linear"
ishigami = "functions.py:ishigami"
start_force = "functions.py:start_force"
"""
FUNCTIONS = '''
import math

def scaled(parameters):
    """The three parameters as -1 to 1."""
    ranges = {"spring.stiffness": (50.0, 150.0), "spring.damping": (0.0, 4.0), "spring.free_length": (0.6, 1.0)}
    return [2.0 * (parameters[n] - a) / (b - a) - 1.0 for n, (a, b) in ranges.items()]

def linear(result, parameters):
    a, b, c = scaled(parameters)
    return 3.0 * a - 2.0 * b + 0.5 * c

def ishigami(result, parameters):
    a, b, c = (math.pi * x for x in scaled(parameters))
    return math.sin(a) + 7.0 * math.sin(b) ** 2 + 0.1 * c**4 * math.sin(a)

def start_force(result):
    """Upward acceleration at the start, from the motion of the FMU: k/m (free_length - length) - g."""
    y, h = result["bob.y"], result.time[1]
    return 2.0 * (y[1] - y[0]) / h**2
start_force.units = "m/s2"
'''


def command(*arguments: object) -> str:
    done = subprocess.run(
        [sys.executable, "-m", *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
        env=os.environ | {"PYTHONIOENCODING": "utf-8"},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of the study, with its report."""
    place = tmp_path_factory.mktemp("functions")
    name, system = load_scene(f"{ROOT / 'tests' / 'hosts' / 'scenes.py'}:tuned")
    fmu = build_fmu(system, name, place, [fmpy.platform])
    (place / "study.toml").write_text(STUDY.format(fmu=fmu.name))
    (place / "functions.py").write_text(FUNCTIONS)
    done = run(main, place / "study.toml", "--out", place / "out", "--jobs", 2)
    assert done.returncode == 0, done.stderr
    return place / "out"


@pytest.fixture(scope="module")
def effects(folder: Path) -> pd.DataFrame:
    return pd.read_csv(folder / "analysis" / "effects.csv").set_index(["measure", "parameter"])


def test_sobol_indices_of_a_linear_model_and_of_ishigami(effects: pd.DataFrame) -> None:
    slopes = np.array([3.0, -2.0, 0.5])
    expected = slopes**2 / (slopes**2).sum()
    linear = effects.loc["linear"]
    assert linear["first"].to_numpy() == pytest.approx(expected, abs=0.02)
    assert linear["total"].to_numpy() == pytest.approx(expected, abs=0.02)
    # Means over the outer tenths of a range of -1 to 1 are 1.8 apart.
    assert linear["main_effect_span"].to_numpy() == pytest.approx(1.8 * np.abs(slopes), abs=0.4)
    v1, v2, v13 = 0.5 * (1 + 0.1 * np.pi**4 / 5) ** 2, 49 / 8, 0.01 * np.pi**8 * 8 / 225
    result = effects.loc["ishigami"]
    variance = v1 + v2 + v13
    for column, values in (("first", (v1, v2, 0.0)), ("total", (v1 + v13, v2, v13))):
        # How often the interval of 95 % holds the truth over many seeds is in test_analysis.py; this is one.
        assert (np.abs(result[column] - np.array(values) / variance) < 2.0 * result[f"{column}_conf"]).all()
        assert (result[f"{column}_conf"] < 0.2).all()


def test_what_the_fmu_has_done_is_in_the_table(folder: Path, effects: pd.DataFrame) -> None:
    """The first step of a mass of 2 kg on a spring of length 1 m, whose damper does nothing at rest."""
    frame = read_study(folder)
    assert (frame["status"] == "done").all()
    assert frame.attrs["units"]["start_force"] == "m/s2"
    expected = frame["spring.stiffness"] / 2.0 * (frame["spring.free_length"] - 1.0) * -1.0 - 9.81
    assert np.abs(frame["start_force"] - expected).max() < 0.05 * np.abs(expected).max()
    assert effects.loc[("start_force", "spring.damping"), "total"] < 0.01
    assert effects.loc[("start_force", "spring.free_length"), "total"] > 0.5


def test_the_worst_run_is_repeated_to_the_bit(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    frame = read_study(folder)
    worst = int(frame["lowest"].idxmin())
    text = (folder / "report.html").read_text(encoding="utf-8")
    lines = [html.unescape(line) for line in re.findall(r"<code>(.*?)</code>", text)]
    (requested,) = {line for line in lines if line.endswith(f"--run {worst}")}
    capsys.readouterr()
    words = shlex.split(requested)
    assert main(words[words.index("study") + 1 :]) == 0
    lines = capsys.readouterr().out.splitlines()
    drives = [line for line in lines if f"run-{worst}." in line and " run " in line]
    assert any(f"run-{worst}." in line and " view " in line for line in lines)
    words = shlex.split(drives[0])
    command(*words[words.index("-m") + 1 :])
    (table,) = (folder / "repeat").glob(f"*run-{worst}.csv")
    assert read_csv(table)["bob.y"].min() == frame.loc[worst, "lowest"]
