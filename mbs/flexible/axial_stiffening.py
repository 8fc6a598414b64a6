"""Stiffness by axial forces in the beams of a reduced body, which linear modes leave out."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular

from mbs.common.frames import AxialStiffening
from mbs.flexible.modal_body import ModalBody

Array = NDArray[np.float64]


def axial_stiffening(body: ModalBody) -> AxialStiffening:
    """Of a reduced body; without beams if its finite-element model was given as matrices."""
    n, frame = body.n_modes, getattr(body, "frame", None)
    n_beams = 0 if frame is None else len(frame.beams)
    forces, roots = np.zeros((n_beams, n)), np.zeros((n_beams, n, 6))
    if frame is None:
        return AxialStiffening(forces, roots, np.zeros(0))
    energy_root = cholesky(body.K)
    for k, beam in enumerate(frame.beams):
        length, R = frame.element_axes(k)
        ends = np.kron(np.eye(4), R) @ body.modes[frame.element_freedoms(k)]
        forces[k] = beam.material.E * beam.section.area / length * (ends[6] - ends[0])
        roots[k] = solve_triangular(energy_root, ends.T @ _weighted_slopes(length), trans="T")
    bounds = np.linalg.eigvalsh(roots.transpose(0, 2, 1) @ roots)[:, -1]
    return AxialStiffening(forces, roots, np.asarray(bounds))


def _weighted_slopes(length: float) -> Array:
    """Slopes of a beam with cubic deflections in its three Gauss points and two planes, times roots of their weights.

    The sum of their squares is the integral of the squares of both slopes: the energy per half of the tension
    (Przemieniecki 1968, equation 15.24).

    Returns
    -------
    ndarray, shape (12, 6)
        Per local displacement and rotation of the ends, m^0.5 per m and rad.
    """
    points, weights = np.polynomial.legendre.leggauss(3)
    x = (1 + points) / 2
    slopes = np.array([6 * x * (x - 1) / length, (1 - x) * (1 - 3 * x), 6 * x * (1 - x) / length, x * (3 * x - 2)])
    slopes *= np.sqrt(length * weights / 2)
    result = np.zeros((12, 6))
    result[[1, 5, 7, 11], :3] = slopes
    result[[2, 4, 8, 10], 3:] = slopes * np.array([[1], [-1], [1], [-1]])
    return result
