"""Measures of braking: stopping distance, mean fully developed deceleration, build-up of the deceleration."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, trapezoid

STANDING = 0.1
"""Speed at which a car is taken to stand, m/s; what is left of the way is added as if its deceleration stayed."""


def travelled(time: NDArray[np.float64], speed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Way since the first sample by trapezoids, m; exact where the acceleration is constant within a step."""
    return np.asarray(cumulative_trapezoid(speed, time, initial=0))


def time_below(time: NDArray[np.float64], speed: NDArray[np.float64], value: float, after: float) -> float:
    """When a speed first falls to a value.

    `time`, `speed`: in s, m/s, shape (n,); `value`: in m/s; `after`: in s; what was before does not count. Result: in
    s, linear between samples; NaN if it does not.
    """
    below = np.flatnonzero((speed <= value) & (time >= after - 1e-9))
    if not len(below):
        return math.nan
    k = int(below[0])
    if k == 0 or time[k - 1] < after - 1e-9:
        return float(time[k])
    return float(np.interp(-value, -speed[k - 1 : k + 1], time[k - 1 : k + 1]))


def way_between(time: NDArray[np.float64], speed: NDArray[np.float64], begin: float, end: float) -> float:
    """Way between two times, m; NaN if one of them is NaN."""
    if math.isnan(begin) or math.isnan(end):
        return math.nan
    within = (time > begin) & (time < end)
    times = np.concatenate([[begin], time[within], [end]])
    return float(trapezoid(np.interp(times, time, speed), times))


def mean_fully_developed_deceleration(
    time: NDArray[np.float64], speed: NDArray[np.float64], onset: float, initial: float
) -> float:
    """Deceleration averaged over the way from 80 % to 10 % of the initial speed.

    `time`, `speed`: in s, m/s, shape (n,); `onset`: when the pedal is first moved, s; `initial`: speed then, m/s.
    Result: in m/s2; NaN if the car does not come down to 10 %.

    Notes
    -----
    (vb2 - ve2) / (2 (se - sb)) with vb = 0.8 v0, ve = 0.1 v0, which with speeds in km/h is the formula of UN Regulation
    No. 13-H, (vb2 - ve2) / (25.92 (se - sb)).
    """
    fast, slow = 0.8 * initial, 0.1 * initial
    distance = way_between(time, speed, time_below(time, speed, fast, onset), time_below(time, speed, slow, onset))
    return (fast**2 - slow**2) / (2.0 * distance) if distance > 0.0 else math.nan


def stopping_distance(
    time: NDArray[np.float64], speed: NDArray[np.float64], onset: float, deceleration: float
) -> float:
    """Way from the onset of braking to rest.

    `time`, `speed`: in s, m/s, shape (n,); `onset`: in s; `deceleration`: with which the rest of the way below
    `STANDING` is covered, m/s2. Result: in m; NaN if the car does not come to stand.
    """
    final_way = STANDING**2 / (2.0 * deceleration) if deceleration > 0.0 else math.nan
    return way_between(time, speed, onset, time_below(time, speed, STANDING, onset)) + final_way


def corrected_to(nominal: float, distance: float, initial: float) -> float:
    """Stopping distance as it would be from the nominal speed, which grows with the square of the speed, m."""
    return distance * (nominal / initial) ** 2


def time_to_reach(time: NDArray[np.float64], deceleration: NDArray[np.float64], value: float, onset: float) -> float:
    """Time from the onset until the deceleration first reaches a value, s; NaN if it does not.

    `time`, `deceleration`: in s, m/s2, shape (n,); `value`: in m/s2; `onset`: in s.
    """
    return time_below(time, -deceleration, -value, onset) - onset


def locked(slip: NDArray[np.float64], speed: NDArray[np.float64], slowest: float = 3.0) -> NDArray[np.bool_]:
    """Where braked wheels stand while the car moves, shape (n, m).

    `slip`: longitudinal slips, shape (n, m); -1 of a wheel that stands; `speed`: in m/s, shape (n,); `slowest`: in m/s;
    slower, wheels may lock.
    """
    return np.asarray((slip < -0.9) & (speed > slowest)[:, None])
