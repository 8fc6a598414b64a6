"""A measured drive as equally spaced samples, and the windows it is judged in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


Array = NDArray[np.float64]

LENGTH, EVERY = 10.0, 5.0  # s: of a window, and from one to the next
FITTED = ((0.0, 80.0), (160.0, 240.0))  # s that models are fitted on
JUDGED = ((80.0, 160.0), (240.0, 275.0))  # s that tell what they predict
CUT_OFF = 2.0  # Hz, of the accelerations that move load between the axles


@dataclass(frozen=True)
class Drive:
    """A measured drive.

    Parameters
    ----------
    time : ndarray of shape (n,)
        Equally spaced, s.
    steer : ndarray of shape (n,)
        Mean angle of both front wheels on the road, positive to the left, rad.
    vx, vy : ndarray of shape (n,)
        Of the centre of mass in axes of the car, y to the left, m/s.
    yaw_rate : ndarray of shape (n,)
        rad/s.
    ax : ndarray of shape (n,)
        Acceleration of the centre of mass along x, vx' - yaw_rate vy, below 2 Hz, m/s2.
    """

    time: Array
    steer: Array
    vx: Array
    vy: Array
    yaw_rate: Array
    ax: Array

    @property
    def interval(self) -> float:
        """Between samples, s."""
        return float(self.time[1] - self.time[0])

    def rows(self, seconds: tuple[tuple[float, float], ...]) -> NDArray[np.bool_]:
        """Which samples lie in stretches of seconds, ends included."""
        edge = 0.5 * self.interval
        return np.any([(self.time >= a - edge) & (self.time <= b + edge) for a, b in seconds], axis=0)
