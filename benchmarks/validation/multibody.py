"""The multibody car in the measured drive, by the command ``ali3 compare``."""

import csv
import json
import math
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.validation.drive import EVERY, FITTED, JUDGED, LENGTH, Array, Spans, text_of
from hosts.compare.command import main as compare
from hosts.compare.command import parser_of
from hosts.compare.segments import GAP
from hosts.compare.task import Task, prepare
from hosts.fmu.fmu_file import fmu_file

YAW = "chassis.wz"
LATERAL = "chassis.vy"
INTERVAL = 0.01  # s, of the samples in `DriveComparison.predicted`
_COLUMNS = f"{LATERAL}.simulated [m/s]", f"{YAW}.simulated [rad/s]"


@dataclass(frozen=True)
class DriveComparison:
    """Errors of a car in the measured drive."""

    fitted: float
    whole: float
    windows: float
    lateral: float
    """`fitted`, `whole`, `windows`, `lateral`: errors as in `benchmarks.validation.fitting.Fitted`."""
    departed: list[str]
    """Departed windows that were not fitted: begin, s, and signal."""
    notes: list[str]
    time: Array
    path: Array
    """`time`, s, and `path`: yaw rate of the run without restart, rad/s, shape (n,) each."""
    predicted: tuple[Array, Array]
    """Lateral velocity, m/s, and yaw rate, rad/s, in the windows that were not fitted, shape (w, m) each."""


def compare_drive(
    car: str, log: Path, aliases: Path, settings: dict[str, float], brief: bool = False
) -> DriveComparison:
    """Simulate a car in a measured drive, in windows and without restart.

    `car`: argument of ``ali3 compare``: an FMU or a car; `settings`: start values; `brief`: only the windows that were
    not fitted, with NaN for `fitted` and `whole`.
    """
    windows = ["--windows", f"{LENGTH:g}", "--window-every", f"{EVERY:g}"]
    with tempfile.TemporaryDirectory() as folder:

        def run(name: str, *options: str) -> tuple[dict[str, Any], Path]:
            out = Path(folder, name)
            record = out / "record.json"
            arguments = arguments_of(car, log, aliases, settings)
            status = compare([*arguments, *options, "--out", str(out), "--json", str(record)])
            assert status in (0, 1), "the command has said why"
            return json.loads(record.read_text(encoding="utf-8")), out / f"{log.stem}.csv"

        others, file = run("others", *windows, "--seconds", text_of(JUDGED))
        across, turning = (in_windows(*_signal(file, name), len(others["windows"])) for name in _COLUMNS)
        predicted = across, turning
        departed = [f"{w['begin']:g} s ({w['departed']})" for w in others["windows"] if w["departed"]]
        errors = _rms(others, YAW), _rms(others, LATERAL), departed
        if brief:
            return DriveComparison(math.nan, math.nan, *errors, [], np.zeros(0), np.zeros(0), predicted)
        first = _rms(run("fitted", *windows, "--seconds", text_of(FITTED))[0], YAW)
        whole, signals = run("whole")
        time, path = _signal(signals, f"{YAW}.simulated [rad/s]")
        measured = _signal(signals, f"{YAW}.measured [rad/s]")[1]
    error = _rms_inside(time, path - measured, JUDGED)
    return DriveComparison(first, error, *errors, whole["notes"] + whole["problems"], time, path, predicted)


def task_of(car: str, log: Path, aliases: Path, settings: dict[str, float], seconds: Spans) -> Task:
    """Task of ``ali3 compare`` for adjacent windows in some seconds. `car`, `settings`: see `compare_drive`."""
    windows = ["--windows", f"{LENGTH:g}", "--seconds", text_of(seconds)]
    options = parser_of().parse_args([*arguments_of(car, log, aliases, settings), *windows])
    options.fmu = fmu_file(options.fmu)
    return prepare(options)


def arguments_of(car: str, log: Path, aliases: Path, settings: dict[str, float]) -> list[str]:
    """Arguments of ``ali3 compare`` for the compared signals. `car`, `settings`: see `compare_drive`."""
    options = [part for key, value in settings.items() for part in ("--set", f"{key}={value!r}")]
    signals = ["--signals", f"{YAW},{LATERAL}"]
    return [car, str(log), "--log-aliases", str(aliases), "--hold-speed", *signals, *options]


def in_windows(time: Array, values: Array, count: int) -> Array:
    """A signal of successive windows, shape (windows, samples).

    `time`, s, and `values`: shape (n,); `count`: number of windows.
    """
    at = INTERVAL * np.arange(round(LENGTH / INTERVAL) + 1)
    return np.array([np.interp(k * (LENGTH + GAP) + at, time, values) for k in range(count)])


def _rms(record: dict[str, Any], signal: str) -> float:
    """Root mean square error of a signal over all windows, each with the same weight."""
    return float(np.sqrt(np.mean([w["rms"][signal] ** 2 for w in record["windows"]])))


def _rms_inside(time: Array, error: Array, spans: Spans) -> float:
    inside = np.any([(time >= a - 1e-9) & (time <= b + 1e-9) for a, b in spans], axis=0)
    return float(np.sqrt(np.mean(error[inside] ** 2)))


def _signal(file: Path, name: str) -> tuple[Array, Array]:
    with file.open(encoding="utf-8", newline="") as stream:
        rows = [(r["time [s]"], r[name]) for r in csv.DictReader(stream) if r[name]]
    values = np.array(rows, dtype=np.float64)
    return values[:, 0], values[:, 1]
