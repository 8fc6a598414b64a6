"""Stiffness of the two-node spatial beam."""

import numpy as np

from mbs.flexible.material import Material
from mbs.flexible.section import Section

THEORIES = ("euler_bernoulli", "timoshenko")


def shear_parameters(section: Section, material: Material, length: float, theory: str) -> tuple[float, float]:
    """Shear parameters 12 E I / (k G A L2) for deflections along y and z; zero for Euler and Bernoulli."""
    if theory == "euler_bernoulli":
        return 0.0, 0.0
    ky, kz = section.shear_factors(material.nu)
    scale = 12 * material.E / (material.G * section.area * length**2)
    return scale * section.Iz / ky, scale * section.Iy / kz


def beam_stiffness(section: Section, material: Material, length: float, theory: str) -> np.ndarray:
    """Stiffness in local axes, exact for loads at the ends (Przemieniecki 1968, equation 5.116).

    Order of the rows: (u, v, w, rx, ry, rz) of node i, then of node j. Returns an array of shape (12, 12).
    """
    E, L = material.E, length
    k = np.zeros((12, 12))
    for row, value in ((0, E * section.area / L), (3, material.G * section.J / L)):
        k[np.ix_([row, row + 6], [row, row + 6])] = value * np.array([[1.0, -1.0], [-1.0, 1.0]])
    phi_y, phi_z = shear_parameters(section, material, L, theory)
    # a rotation about y turns x towards -z: the signs of the couplings change
    for dof, second, phi, s in (((1, 5, 7, 11), section.Iz, phi_y, 1.0), ((2, 4, 8, 10), section.Iy, phi_z, -1.0)):
        a, b = 12.0, 6.0 * L * s
        c, d = (4 + phi) * L**2, (2 - phi) * L**2
        k[np.ix_(dof, dof)] = (E * second / ((1 + phi) * L**3)) * np.array(
            [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]]
        )
    return k
