"""Uneven surfaces with the spectrum of ISO 8608."""

import math

import numpy as np
from numpy.typing import NDArray

from mbs.roads.road_header import RoadFileError

ISO_8608 = {"A": 16e-6, "B": 64e-6, "C": 256e-6, "D": 1024e-6, "E": 4096e-6, "F": 16384e-6}
"""Displacement power spectral density Gd at 0.1 1/m, m3: geometric means of the classes (ISO 8608:2016, table C.2)."""
REFERENCE_FREQUENCY = 0.1
"""Spatial frequency of these values, 1/m."""
MAX_SQUARE = 2048
"""Largest number of points per side for which the surface is computed on a square."""
MAX_POINTS = 2**25
MIN_FREQUENCY = 0.011
"""Lowest spatial frequency, 1/m (ISO 8608:2016, 5.1.2)."""
MAX_FREQUENCY = 2.83
"""Highest spatial frequency, 1/m (ISO 8608:2016, 5.1.2)."""


def rough_heights(nx: int, ny: int, spacing: float, density: float, seed: int) -> NDArray[np.float64]:
    """Heights of an isotropic surface, m, shape (nx, ny).

    Along every straight line the one-sided density is Gd(n) = Gd(n0) (n0/n)^2, near the highest frequency N of the
    surface times sqrt(1 - (n/N)^2). A surface with the two-dimensional density A n^-3 has the two-sided density
    2 A n^-2 along a line (the integral over the other component), so A = Gd(n0) n0^2 / 4. Phases are random, amplitudes
    are not. The coherence of two tracks at a distance b is (x K1(x))^2 with x = 2 pi n b and the modified Bessel
    function K1.

    `spacing`: m; `density`: Gd(n0), m3; `seed`: seed of the phases. Raises `RoadFileError` if there are too many
    points.
    """
    longest_wave = round(1.0 / (MIN_FREQUENCY * spacing))
    sides = [max(n, longest_wave) for n in (nx, ny)]
    if max(sides) <= MAX_SQUARE:
        sides = [max(sides)] * 2  # as in earlier versions
    if math.prod(sides) > MAX_POINTS:
        raise RoadFileError(
            f"A rough road of {nx} x {ny} points is computed on {sides[0]} x {sides[1]} points, which hold its longest "
            f"wave; {MAX_POINTS} are computed at most. A larger spacing or a shorter road has fewer."
        )
    n = np.fft.fftfreq(sides[0], spacing), np.fft.fftfreq(sides[1], spacing)[: sides[1] // 2 + 1]
    frequency = np.hypot(n[0][:, None], n[1][None, :])
    cell = 1.0 / math.prod(side * spacing for side in sides)
    with np.errstate(divide="ignore"):
        spectrum = np.where(frequency > 0.0, 0.25 * density * REFERENCE_FREQUENCY**2 * frequency**-3.0, 0.0)
    spectrum[(frequency < MIN_FREQUENCY) | (frequency > MAX_FREQUENCY)] = 0.0
    phases = np.exp(2j * np.pi * np.random.default_rng(seed).random(spectrum.shape))
    surface = np.fft.irfft2(np.sqrt(spectrum * cell) * phases, s=sides) * math.prod(sides)
    return np.asarray(surface[:nx, :ny])
