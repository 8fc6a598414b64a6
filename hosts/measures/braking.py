"""Measures of braking: stopping distance, mean fully developed deceleration, response time of the deceleration."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, trapezoid

STANDING = 0.1
"""Speed below which a car is taken to stand, m/s; the remaining distance is extrapolated at constant deceleration."""


def travelled(time: NDArray[np.float64], speed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance since the first sample by the trapezoidal rule, m; exact for a constant acceleration in each step."""
    return np.asarray(cumulative_trapezoid(speed, time, initial=0))


def time_below(time: NDArray[np.float64], speed: NDArray[np.float64], threshold: float, after: float) -> float:
    """First time at which a speed falls to a threshold, s, by linear interpolation; NaN if it does not.

    `time`, `speed`: s, m/s, shape (n,); `threshold`: m/s; `after`: earlier times do not count, s.
    """
    below = np.flatnonzero((speed <= threshold) & (time >= after - 1e-9))
    if not len(below):
        return math.nan
    k = int(below[0])
    if k == 0 or time[k - 1] < after - 1e-9:
        return float(time[k])
    return float(np.interp(-threshold, -speed[k - 1 : k + 1], time[k - 1 : k + 1]))


def distance_between(time: NDArray[np.float64], speed: NDArray[np.float64], begin: float, end: float) -> float:
    """Distance between two times, m; NaN if one of them is NaN."""
    if math.isnan(begin) or math.isnan(end):
        return math.nan
    within = (time > begin) & (time < end)
    times = np.concatenate([[begin], time[within], [end]])
    return float(trapezoid(np.interp(times, time, speed), times))


def mean_fully_developed_deceleration(
    time: NDArray[np.float64], speed: NDArray[np.float64], onset: float, initial: float
) -> float:
    """Deceleration averaged over the distance from 80 % to 10 % of the initial speed, m/s2; NaN if 10 % is not reached.

    `time`, `speed`: s, m/s, shape (n,); `onset`: time of the first pedal motion, s; `initial`: speed at the onset,
    m/s.

    Notes
    -----
    (vb2 - ve2) / (2 (se - sb)) with vb = 0.8 v0, ve = 0.1 v0, which with speeds in km/h is the formula of UN Regulation
    No. 13-H, (vb2 - ve2) / (25.92 (se - sb)).
    """
    fast, slow = 0.8 * initial, 0.1 * initial
    distance = distance_between(time, speed, time_below(time, speed, fast, onset), time_below(time, speed, slow, onset))
    return (fast**2 - slow**2) / (2.0 * distance) if distance > 0.0 else math.nan


def stopping_distance(
    time: NDArray[np.float64], speed: NDArray[np.float64], onset: float, deceleration: float
) -> float:
    """Distance from the onset of braking to rest, m; NaN if the car does not stop.

    `time`, `speed`: s, m/s, shape (n,); `onset`: s; `deceleration`: below the speed `STANDING`, m/s2.
    """
    last_distance = STANDING**2 / (2.0 * deceleration) if deceleration > 0.0 else math.nan
    return distance_between(time, speed, onset, time_below(time, speed, STANDING, onset)) + last_distance


def corrected_to(nominal: float, distance: float, initial: float) -> float:
    """Stopping distance from the nominal speed, m: proportional to the square of the speed."""
    return distance * (nominal / initial) ** 2


def time_to_reach(
    time: NDArray[np.float64], deceleration: NDArray[np.float64], threshold: float, onset: float
) -> float:
    """Time from the onset until the deceleration first reaches a threshold, s; NaN if it does not.

    `time`, `deceleration`: s, m/s2, shape (n,); `threshold`: m/s2; `onset`: s.
    """
    return time_below(time, -deceleration, -threshold, onset) - onset


def locked(slip: NDArray[np.float64], speed: NDArray[np.float64], slowest: float = 3.0) -> NDArray[np.bool_]:
    """Whether wheels are locked while the car moves, shape (n, m).

    `slip`: longitudinal slips, -1 for a locked wheel, shape (n, m); `speed`: m/s, shape (n,); `slowest`: speed up to
    which a locked wheel does not count, m/s.
    """
    return np.asarray((slip < -0.9) & (speed > slowest)[:, None])
