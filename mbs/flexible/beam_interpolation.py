"""Displacements inside a beam from those of its ends, by cubic interdependent Timoshenko shape functions."""

import numpy as np


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
