"""Linear stability of the bicycle in straight running: published eigenvalues, and eigenvalues of the System.

Published: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, "Linearized dynamics equations for the balance
and steer of a bicycle: a benchmark and review", Proceedings of the Royal Society A 463, 2007, 1955-1982.
"""

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray
from scipy.optimize import brentq

import mbs
from mbs.scenes import bicycle

# m/s: self-stable between both speeds
WEAVE = 4.29238253634111
CAPSIZE = 6.02426201538837
AT_FIVE = (-14.07838969, -0.77534188 + 4.46486771j, -0.77534188 - 4.46486771j, -0.32286643)  # 1/s, at 5 m/s
ZERO = 1e-4  # 1/s: the zero eigenvalues of position, heading and speed are computed to the root of round-off
REAL = 1e-9  # 1/s: largest imaginary part of a real eigenvalue
OFFSETS = (-0.06, -0.03, 0.03, 0.06)  # m/s: at the capsize speed its eigenvalue is one of several zeros


def eigenvalues(speed: float) -> NDArray[np.complex128]:
    """Non-zero eigenvalues of the System in straight running, 1/s."""
    model = mbs.linearise(mbs.Simulation(mbs.compile(bicycle.build(speed, 0.0))))
    values = np.linalg.eigvals(model.A).astype(complex)
    return values[np.abs(values) > ZERO]


def weave(speed: float) -> float:
    """Largest real part of the complex eigenvalues, 1/s."""
    return float(max(v.real for v in eigenvalues(speed) if abs(v.imag) > REAL))


def capsize(speed: float) -> float:
    """Largest real eigenvalue, 1/s."""
    return float(max(v.real for v in eigenvalues(speed) if abs(v.imag) <= REAL))


def stable_speeds() -> tuple[float, float]:
    """Speeds, m/s, between which all eigenvalues of the System have negative real parts."""
    values = [capsize(CAPSIZE + d) for d in OFFSETS]
    cubic = Polynomial.fit(OFFSETS, values, len(OFFSETS) - 1)
    return float(brentq(weave, 4.2, 4.4, xtol=1e-12)), CAPSIZE + float(brentq(cubic, OFFSETS[0], OFFSETS[-1]))
