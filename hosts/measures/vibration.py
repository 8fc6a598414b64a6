"""Perceived vertical vibration: frequency weighting Wk of ISO 2631-1 and its measures."""

import math
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid
from scipy.signal import bilinear_zpk, sosfilt, tf2zpk, zpk2sos

# Corner frequencies in Hz and quality factors of Wk: band limits, acceleration-velocity transition, upward step.
_HIGH_PASS = 0.4
_LOW_PASS = 100.0
_TRANSITION = 12.5
_TRANSITION_Q = 0.63
_STEP_LOW = 2.37
_STEP_LOW_Q = 0.91
_STEP_HIGH = 3.35
_STEP_HIGH_Q = 0.91
MAX_STEP = 0.005
"""Longest interval of samples, s: the error of the weighting is below 3 % up to 20 Hz, with 2 ms up to 45 Hz."""


def weighting_wk() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Numerator and denominator of the transfer function of Wk: coefficients of s, rad/s, in descending powers."""

    def w(frequency: float) -> float:
        return 2.0 * math.pi * frequency

    def second_order(frequency: float, q: float) -> list[float]:
        return [1.0, w(frequency) / q, w(frequency) ** 2]

    high_pass = ([1.0, 0.0, 0.0], second_order(_HIGH_PASS, math.sqrt(0.5)))
    low_pass = ([w(_LOW_PASS) ** 2], second_order(_LOW_PASS, math.sqrt(0.5)))
    transition = ([w(_TRANSITION), w(_TRANSITION) ** 2], second_order(_TRANSITION, _TRANSITION_Q))
    # The gain of the upward step is 1 at high frequencies.
    step = (second_order(_STEP_LOW, _STEP_LOW_Q), second_order(_STEP_HIGH, _STEP_HIGH_Q))
    factors = (high_pass, low_pass, transition, step)
    numerator, denominator = (reduce(np.polymul, [np.array(factor[k]) for factor in factors]) for k in (0, 1))
    return np.asarray(numerator, float), np.asarray(denominator, float)


def weighted(acceleration: NDArray[np.float64], interval: float) -> NDArray[np.float64]:
    """Vertical acceleration weighted with Wk, m/s2, shape (n,); the filter starts at rest.

    `acceleration`: m/s2, zero at rest, shape (n,); `interval`: between samples, s.
    """
    # In factors, since the coefficients of degree 8 have large rounding errors at short intervals.
    factors: Any = bilinear_zpk(*tf2zpk(*weighting_wk()), fs=1.0 / interval)
    return np.asarray(sosfilt(zpk2sos(*factors), acceleration))


def largest_running_rms(values: NDArray[np.float64], interval: float) -> float:
    """Largest root mean square in a moving window of 1 s (MTVV of ISO 2631-1), in the unit of `values`.

    `values`: zero before the first sample, shape (n,); `interval`: s.
    """
    samples = max(1, round(1.0 / interval))
    summed_squares = np.cumsum(np.concatenate([np.zeros(samples), np.square(values)]))
    return math.sqrt(max(0.0, float((summed_squares[samples:] - summed_squares[:-samples]).max())) / samples)


def vibration_dose(values: NDArray[np.float64], interval: float) -> float:
    """Fourth root of the integral of the fourth power over time (VDV), m/s^1.75 of an acceleration in m/s2."""
    dose: float = float(trapezoid(values**4, dx=interval)) ** 0.25
    return dose
