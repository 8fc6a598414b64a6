"""Mass of beams as point masses: lumped at the ends or consistent, with or without rotary inertia."""

import numpy as np

from mbs.common.checks import shown
from mbs.common.errors import ModelError
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


def bending_functions(xi: float, length: float, phi: float) -> tuple[np.ndarray, np.ndarray]:
    """Deflection and rotation at ``x = xi * length`` from (v1, theta1, v2, theta2) with theta = +dv/dx.

    `phi` = 12 E I / (k G A L2) is the shear parameter; 0 gives Hermite's cubics of Euler and Bernoulli. These functions
    solve the unloaded Timoshenko beam exactly (Przemieniecki 1968, section 5.6; Friedman and Kosmatka 1993). Returns
    `deflection` and `rotation`, shape (4,).
    """
    mu, x, L = 1.0 / (1.0 + phi), xi, length
    deflection = mu * np.array(
        [
            1 - 3 * x**2 + 2 * x**3 + phi * (1 - x),
            L * (x - 2 * x**2 + x**3 + phi / 2 * (x - x**2)),
            3 * x**2 - 2 * x**3 + phi * x,
            L * (-(x**2) + x**3 - phi / 2 * (x - x**2)),
        ]
    )
    slope = 6 / L * (x**2 - x)
    rotation = mu * np.array([slope, 1 - 4 * x + 3 * x**2 + phi * (1 - x), -slope, -2 * x + 3 * x**2 + phi * x])
    return deflection, rotation


def section_motion(xi: float, length: float, phi_y: float, phi_z: float) -> np.ndarray:
    """Displacement and rotation of the section at ``xi`` in local axes from the twelve of the ends.

    Ends are (u, v, w, rx, ry, rz) of node i, then of node j. `phi_y` belongs to deflections along y, `phi_z` along z.
    Returns an array of shape (6, 12).
    """
    N = np.zeros((6, 12))
    for row in (0, 3):  # axial displacement and twist are linear
        N[row, [row, row + 6]] = 1 - xi, xi
    v, rz = bending_functions(xi, length, phi_y)
    w, ry = bending_functions(xi, length, phi_z)
    N[1, [1, 5, 7, 11]], N[5, [1, 5, 7, 11]] = v, rz
    signs = np.array([1.0, -1.0, 1.0, -1.0])  # dw/dx = -ry
    N[2, [2, 4, 8, 10]], N[4, [2, 4, 8, 10]] = w * signs, -ry * signs
    return N
