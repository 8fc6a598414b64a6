"""The multibody car in the same drive, by ``ali3 compare`` as a user calls it."""

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
INTERVAL = 0.01  # s, of the samples in `Judged.predicted`
_COLUMNS = f"{LATERAL}.simulated [m/s]", f"{YAW}.simulated [rad/s]"


@dataclass(frozen=True)
class Judged:
    """A car that was driven through the measured drive."""

    fitted: float
    whole: float
    windows: float
    lateral: float
    """`fitted`, `whole`, `windows`, `lateral`: as of `benchmarks.validation.fitting.Fitted`."""
    departed: list[str]
    """Windows that were not fitted and departed: their begin, s, and the signal."""
    notes: list[str]
    time: Array
    path: Array
    """`time`, `path`, shape (n,): yaw rate of the run without restart, s and rad/s."""
    predicted: tuple[Array, Array]
    """Each of shape (w, m): lateral velocity and yaw rate in the windows that were not fitted, m/s and rad/s."""


def judge(car: str, log: Path, aliases: Path, settings: dict[str, float], brief: bool = False) -> Judged:
    """Drive a car through a log in windows and without restart.

    `car`: what ``ali3 compare`` takes: an FMU, or a car; `brief`: drive only the windows that were not fitted; `fitted`
    and `whole` are then NaN.
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
            return Judged(math.nan, math.nan, *errors, [], np.zeros(0), np.zeros(0), predicted)
        first = _rms(run("fitted", *windows, "--seconds", text_of(FITTED))[0], YAW)
        whole, signals = run("whole")
        time, path = _signal(signals, f"{YAW}.simulated [rad/s]")
        measured = _signal(signals, f"{YAW}.measured [rad/s]")[1]
    error = _rms_inside(time, path - measured, JUDGED)
    return Judged(first, error, *errors, whole["notes"] + whole["problems"], time, path, predicted)


def task_of(car: str, log: Path, aliases: Path, settings: dict[str, float], seconds: Spans) -> Task:
    """What ``ali3 compare`` drives in windows of some seconds, end to end. `car`, `settings`: as of `judge`."""
    windows = ["--windows", f"{LENGTH:g}", "--seconds", text_of(seconds)]
    options = parser_of().parse_args([*arguments_of(car, log, aliases, settings), *windows])
    options.fmu = fmu_file(options.fmu)
    return prepare(options)


def arguments_of(car: str, log: Path, aliases: Path, settings: dict[str, float]) -> list[str]:
    """Of ``ali3 compare`` for the signals that are judged. `car`, `settings`: as of `judge`."""
    options = [part for key, value in settings.items() for part in ("--set", f"{key}={value!r}")]
    signals = ["--signals", f"{YAW},{LATERAL}"]
    return [car, str(log), "--log-aliases", str(aliases), "--hold-speed", *signals, *options]


def in_windows(time: Array, values: Array, count: int) -> Array:
    """A signal of windows that stand one after the other, of shape (windows, samples).

    `time`, `values`: shape (n,), s; `count`: of the windows.
    """
    at = INTERVAL * np.arange(round(LENGTH / INTERVAL) + 1)
    return np.array([np.interp(k * (LENGTH + GAP) + at, time, values) for k in range(count)])


def _rms(record: dict[str, Any], signal: str) -> float:
    """Of all windows alike, as those of the bicycles."""
    return float(np.sqrt(np.mean([w["rms"][signal] ** 2 for w in record["windows"]])))


def _rms_inside(time: Array, error: Array, spans: Spans) -> float:
    inside = np.any([(time >= a - 1e-9) & (time <= b + 1e-9) for a, b in spans], axis=0)
    return float(np.sqrt(np.mean(error[inside] ** 2)))


def _signal(file: Path, name: str) -> tuple[Array, Array]:
    with file.open(encoding="utf-8", newline="") as stream:
        rows = [(r["time [s]"], r[name]) for r in csv.DictReader(stream) if r[name]]
    values = np.array(rows, dtype=np.float64)
    return values[:, 0], values[:, 1]
