"""Cross-sections of beams: closed-form constants of tubes, round and rectangular bars."""

from dataclasses import dataclass

import numpy as np

from mbs.common.checks import LARGEST, is_finite, shown
from mbs.common.errors import ModelError


@dataclass(frozen=True)
class Section:
    """Constants of a cross-section in its principal axes y, z (x runs along the beam)."""

    area: float
    """Area, m2."""
    Iy: float
    """Second moment of area about y, m4, for bending in the x-z plane."""
    Iz: float
    """Second moment of area about z, m4, for bending in the x-y plane."""
    J: float
    """Torsion constant, m4."""
    shear_y: tuple[float, float, float, float]
    """Coefficients ``(a, b, c, d)`` of the shear factor ``(a + b nu) / (c + d nu)`` along y (Cowper 1966)."""
    shear_z: tuple[float, float, float, float]
    """Likewise along z."""
    fibres: tuple[tuple[float, float], ...]
    """Points (y, z) of the outline, m, at which stresses are computed; the first two are the highest and the lowest."""

    def shear_factors(self, nu: float) -> tuple[float, float]:
        """Shear factors along y and z.

        Parameters
        ----------
        nu : float
            Poisson ratio.
        """
        ky, kz = ((a + b * nu) / (c + d * nu) for a, b, c, d in (self.shear_y, self.shear_z))
        return ky, kz


def tube(outer_diameter: float, wall: float) -> Section:
    """Round tube; shear factor of the hollow circle (Cowper 1966), exact for thin and full walls.

    Parameters
    ----------
    outer_diameter, wall : float
        m.

    Raises
    ------
    ModelError
        A length is not positive and finite, or the wall is more than half the diameter.
    """
    _check_positive("tube", outer_diameter=outer_diameter, wall=wall)
    if wall > outer_diameter / 2:
        raise ModelError(f"A tube of {outer_diameter} m cannot have a wall of {wall} m: at most half the diameter.")
    D, d = outer_diameter, outer_diameter - 2 * wall
    second = np.pi / 64 * (D**4 - d**4)
    ratio = (d / D) ** 2
    a = 6 * (1 + ratio) ** 2
    shear = (a, a, 7 * (1 + ratio) ** 2 + 20 * ratio, 6 * (1 + ratio) ** 2 + 12 * ratio)
    return Section(np.pi / 4 * (D**2 - d**2), second, second, 2 * second, shear, shear, _round_fibres(D / 2))


def round_bar(diameter: float) -> Section:
    """Solid round bar.

    Parameters
    ----------
    diameter : float
        m.
    """
    _check_positive("round bar", diameter=diameter)
    return tube(diameter, diameter / 2)


def rectangle(width: float, height: float) -> Section:
    """Solid rectangle; torsion constant from Saint-Venant's series.

    Parameters
    ----------
    width, height : float
        Along y and along z, m.
    """
    _check_positive("rectangle", width=width, height=height)
    a, b = max(width, height), min(width, height)
    n = np.arange(1, 200, 2)
    series = float(np.sum(np.tanh(n * np.pi * a / (2 * b)) / n**5))
    J = a * b**3 / 3 * (1 - 192 * b / (np.pi**5 * a) * series)
    shear = (10.0, 10.0, 12.0, 11.0)
    y, z = width / 2, height / 2
    fibres = ((0.0, z), (0.0, -z), (y, z), (-y, z), (-y, -z), (y, -z))
    return Section(width * height, width * height**3 / 12, height * width**3 / 12, J, shear, shear, fibres)


def _round_fibres(radius: float) -> tuple[tuple[float, float], ...]:
    """Top and bottom first, then round the circle in steps of 45 degrees."""
    s = radius / np.sqrt(2.0)
    top_and_bottom = ((0.0, radius), (0.0, -radius))
    return (*top_and_bottom, (radius, 0.0), (-radius, 0.0), (s, s), (-s, s), (-s, -s), (s, -s))


def _check_positive(label: str, **lengths: float) -> None:
    for name, value in lengths.items():
        if not (is_finite(value) and 0.0 < value < LARGEST):
            raise ModelError(f"The {name} of a {label} is {shown(value)} m; it must be positive.")
