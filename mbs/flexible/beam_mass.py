"""Mass of beams as point masses: lumped at the ends or consistent, with or without rotary inertia."""

import numpy as np

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.flexible.beam_interpolation import section_motion
from mbs.flexible.material import Material
from mbs.flexible.section import Section

MASS_KINDS = ("lumped", "consistent")
_STATIONS, _WEIGHTS = (np.polynomial.legendre.leggauss(4) + np.array([[1.0], [0.0]])) / 2  # from 0 to 1


def beam_mass_points(
    section: Section, material: Material, length: float, shear: tuple[float, float], kind: str, rotary: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Point masses of one beam in local axes.

    "lumped" puts half the mass at each end; "consistent" puts it at the four Gauss stations, which integrate the
    products of the cubic interpolation exactly. With `rotary` each station is four points of the section at
    sqrt(2) times the radii of gyration, which carry its inertia about all three axes.

    `shear`: shear parameters for deflections along y and z.

    Returns
    -------
    positions : ndarray, shape (p, 3)
        m, from node i in local axes.
    masses : ndarray, shape (p,)
        kg.
    interpolation : ndarray, shape (p, 3, 12)
        Displacement of each point in local axes from the local displacements of the ends.
    """
    if not isinstance(kind, str) or kind not in MASS_KINDS:
        raise ModelError(f"The mass kind {shown(kind)} is unknown; one of {', '.join(MASS_KINDS)}.")
    if kind == "lumped":
        stations, weights = np.array([0.0, 1.0]), np.array([0.5, 0.5])
    else:
        stations, weights = _STATIONS, _WEIGHTS
    offsets = [(0.0, 0.0)]
    if rotary:
        y, z = np.sqrt(2 * section.Iz / section.area), np.sqrt(2 * section.Iy / section.area)
        offsets = [(y, 0.0), (-y, 0.0), (0.0, z), (0.0, -z)]
    mass = material.rho * section.area * length
    positions, masses, shapes = [], [], []
    for xi, weight in zip(stations, weights, strict=True):
        motion = section_motion(float(xi), length, *shear)
        for y, z in offsets:
            positions.append([xi * length, y, z])
            masses.append(mass * weight / len(offsets))
            cross = np.array([[0.0, z, -y], [-z, 0.0, 0.0], [y, 0.0, 0.0]])  # rotation cross (0, y, z)
            shapes.append(motion[:3] + cross @ motion[3:])
    return np.array(positions), np.array(masses), np.array(shapes)
