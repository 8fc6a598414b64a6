"""Lateral acceleration, understeer angle and sideslip, of models and of the measurement."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import butter, sosfiltfilt

from benchmarks.validation.drive import JUDGED, LENGTH, Array, Drive
from benchmarks.validation.fitting import begins
from mbs.vehicle.environment import GRAVITY

BIN_WIDTH = 0.1  # g, of a bin: 0.05 g to either side of its middle
BIN_CUT_OFF = 1.0  # Hz, of the acceleration that assigns samples to bins
ERROR_CUT_OFF = 2.0  # Hz, of the accelerations that are compared
MIN_SECONDS = 2.0  # s, in a compared bin
SETTLING_TIME = 0.5  # s at the beginning of a window that are left out


@dataclass(frozen=True)
class Curve:
    """A quantity in a bin of the measured lateral acceleration."""

    quantity: str
    acceleration: float
    """Middle of the bin, g, positive to the left."""
    seconds: float
    """Time of the drive in the bin, s; time in two windows counts once."""
    measured: float
    """Mean of the measured values, deg."""
    spread: float
    """Standard deviation of the measured values, deg."""
    difference: float
    """Mean difference of simulated minus measured values, deg."""


def low_passed(values: Array, cut_off: float, interval: float) -> Array:
    """Values (..., n) after a Butterworth low-pass forward and back. `cut_off`: Hz; `interval`: s."""
    return np.asarray(sosfiltfilt(butter(2, cut_off, fs=1.0 / interval, output="sos"), values, axis=-1))


def lateral_acceleration(vx: Array, vy: Array, rate: Array, interval: float) -> Array:
    """Lateral acceleration of the centre of mass along the road, vy' + rate vx, m/s2, shape (..., n)."""
    return np.asarray(np.gradient(vy, interval, axis=-1) + rate * vx)


def window_rows(drive: Drive) -> Array:
    """Indices of the samples in the windows that were not fitted, shape (w, m)."""
    return begins(drive, JUDGED)[:, None] + np.arange(round(LENGTH / drive.interval) + 1)


def acceleration_error(drive: Drive, vy: Array, rate: Array) -> float:
    """Root mean square error of the lateral acceleration in the windows that were not fitted, m/s2.

    `vy`, `rate`: results of a model in these windows, shape (w, m).

    Notes
    -----
    Both accelerations are computed from velocities, so that they do not include slope, bank and roll; below 2 Hz.
    """
    rows = window_rows(drive)
    exact = lateral_acceleration(drive.vx[rows], drive.vy[rows], drive.yaw_rate[rows], drive.interval)
    error = low_passed(
        lateral_acceleration(drive.vx[rows], vy, rate, drive.interval) - exact, ERROR_CUT_OFF, drive.interval
    )
    return float(np.sqrt(np.mean(error[:, round(SETTLING_TIME / drive.interval) :] ** 2)))


def curves(drive: Drive, wheelbase: float, vy: Array, rate: Array) -> list[Curve]:
    """Understeer angle and sideslip over the measured lateral acceleration below 1 Hz.

    `wheelbase`: m; `vy`, `rate`: results of a model in the windows that were not fitted, shape (w, m).

    Notes
    -----
    The understeer angle is the mean angle of the front wheels minus wheelbase times yaw rate divided by speed, times
    the sign of the lateral acceleration: positive if the car understeers.
    """
    rows = window_rows(drive)[:, round(SETTLING_TIME / drive.interval) :]
    vy, rate = (values[:, round(SETTLING_TIME / drive.interval) :] for values in (vy, rate))
    whole = low_passed(
        lateral_acceleration(drive.vx, drive.vy, drive.yaw_rate, drive.interval), BIN_CUT_OFF, drive.interval
    )
    number = np.round(whole[rows] / GRAVITY / BIN_WIDTH)
    side = np.where(number < 0.0, -1.0, 1.0)

    def understeer(turning: Array) -> Array:
        return np.degrees(side * (drive.steer[rows] - wheelbase * turning / drive.vx[rows]))

    def sideslip(across: Array) -> Array:
        return np.degrees(np.arctan2(across, drive.vx[rows]))

    pairs = {
        "understeer angle": (understeer(drive.yaw_rate[rows]), understeer(rate)),
        "sideslip": (sideslip(drive.vy[rows]), sideslip(vy)),
    }
    bins = [(float(k * BIN_WIDTH), number == k) for k in np.unique(number)]
    return [
        Curve(
            quantity,
            acceleration,
            len(np.unique(rows[in_bin])) * drive.interval,
            float(measured[in_bin].mean()),
            float(measured[in_bin].std()),
            float((simulated - measured)[in_bin].mean()),
        )
        for quantity, (measured, simulated) in pairs.items()
        for acceleration, in_bin in bins
    ]


def within(curves: list[Curve], quantity: str, aim: float) -> tuple[int, int]:
    """Of the bins with `MIN_SECONDS`, the number whose mean difference is within `aim`, deg, and the number of all."""
    judged = [c for c in curves if c.quantity == quantity and c.seconds >= MIN_SECONDS]
    return sum(abs(c.difference) <= aim for c in judged), len(judged)
