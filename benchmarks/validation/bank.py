"""Bank of the road from the accelerometer, as a function of the position in the lap.

An accelerometer measures specific force: on a road that falls to the left by an angle b its lateral signal is the
acceleration minus g sin b. Roll of the body adds a part of the acceleration to the signal.
"""

import gzip
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from benchmarks.validation.drive import FITTED, Array, Drive, Spans

PORT = "point_reference.Fy"
"""Input of an FMU with the ports ``forces=vehicle`` for the bank as a force."""
CUT_OFF = 1.0  # Hz, of the low-pass that leaves the bank
PIECE = 10.0  # m, length of the track pieces over which the bank is averaged
_MIN_LAP = 1000.0  # m, shortest lap
_MAX_LAP = 6000.0  # m, longest lap
_MIN_SPEED = 5.0  # m/s, least speed in the curvature of the path
_MIN_CORRELATION = 0.9  # of the curvatures of two laps
_NEARLY = 0.02  # largest difference from the best correlation


def bank_of(drive: Drive, seconds: Spans = FITTED) -> Array:
    """Lateral acceleration by the weight on the banked road at each sample, m/s2, positive to the left, shape (n,).

    The bank is a function of the position in the lap, from the samples in the spans `seconds`. Raises `ValueError` if
    the log has no accelerometer, or the drive has no laps.
    """
    if not drive.ay.size:
        raise ValueError("The log has no lateral acceleration, 'chassis.ay'.")
    sections = butter(2, CUT_OFF, fs=1.0 / drive.interval, output="sos")
    acceleration, sensed = (
        sosfiltfilt(sections, a) for a in (np.gradient(drive.vy, drive.interval) + drive.yaw_rate * drive.vx, drive.ay)
    )
    in_seconds = drive.inside(seconds)
    columns = np.column_stack([acceleration, np.ones_like(acceleration)])
    share = np.linalg.lstsq(columns[in_seconds], (sensed - acceleration)[in_seconds], rcond=None)[0]
    bank = -(sensed - acceleration - columns @ share)
    distance, lap = distance_and_lap(drive)
    count = round(lap / PIECE)
    piece = pieces(distance, lap)
    passed = np.bincount(piece[in_seconds], minlength=count)
    seen = np.flatnonzero(passed)
    means = np.bincount(piece[in_seconds], bank[in_seconds], count)[seen] / passed[seen]
    middle = (seen + 0.5) * lap / count
    return np.interp(distance % lap, middle, means, period=lap)


def distance_and_lap(drive: Drive) -> tuple[Array, float]:
    """Distance along the track at each sample, shape (n,), and lap length, m. Raises `ValueError` without laps."""
    distance = drive.interval * np.concatenate([[0.0], np.cumsum(0.5 * (drive.vx[1:] + drive.vx[:-1]))])
    return distance, _lap(distance, drive.yaw_rate / np.maximum(drive.vx, _MIN_SPEED))


def pieces(distance: Array, lap: float) -> NDArray[np.intp]:
    """Number of the lap piece of each sample, shape (n,). `distance`, `lap`: see `distance_and_lap`."""
    count = round(lap / PIECE)
    return np.asarray(((distance % lap) / lap * count).astype(np.intp) % count)


def _lap(distance: Array, curvature: Array) -> float:
    """Length of a lap, m: the shift with the largest autocorrelation of the path's curvature."""
    even = np.interp(np.arange(0.0, distance[-1]), distance, curvature)
    shifts = np.arange(int(_MIN_LAP), int(min(_MAX_LAP, distance[-1] - _MIN_LAP)))
    correlations = np.array([np.corrcoef(even[:-k], even[k:])[0, 1] for k in shifts])
    if not correlations.max() > _MIN_CORRELATION:
        raise ValueError(
            f"The drive does not repeat its path: the best correlation of its curvature is {correlations.max():.2f}."
        )
    near = np.flatnonzero(correlations > correlations.max() - _NEARLY)
    first = near[near <= near[0] + _MIN_LAP / 2.0]  # one lap, not several
    return float(shifts[first[np.argmax(correlations[first])]])


def write_banked(folder: Path, log: Path, aliases: Path, bank: Array, mass: float) -> tuple[Path, Path]:
    """Write a log and its alias file with a further column: mass times bank, a lateral force at the reference point, N.

    `bank`: bank at each row of the log, m/s2, positive to the left, shape (n,); `mass`: mass of the car, kg. Returns
    both files. The force does not have the effect of the bank on the wheel loads.
    """
    packed = log.suffix == ".gz"
    text = gzip.decompress(log.read_bytes()).decode() if packed else log.read_text(encoding="utf-8")
    head, *rows = text.splitlines()
    lines = [f"{row},{mass * a!r}" for row, a in zip(rows, bank.tolist(), strict=True)]
    file, names = folder / "banked.csv", folder / "banked.toml"
    file.write_text("\n".join([f"{head},bank_force [N]", *lines, ""]), encoding="utf-8")
    line = f'"{PORT}" = {{ name = "bank_force", unit = "N" }}\n'
    names.write_text(aliases.read_text(encoding="utf-8") + line, encoding="utf-8")
    return file, names
