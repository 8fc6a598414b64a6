"""Stiffness by axial forces in the beams of a reduced body, which linear modes leave out."""

from __future__ import annotations

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
    forces, stiffness = np.zeros((n_beams, n)), np.zeros((n_beams, n, n))
    if frame is None:
        return AxialStiffening(forces, stiffness, np.zeros(0))
    energy_root = cholesky(body.K)
    for k, beam in enumerate(frame.beams):
        length, R = frame.element_axes(k)
        ends = np.kron(np.eye(4), R) @ body.modes[frame.element_freedoms(k)]
        forces[k] = beam.material.E * beam.section.area / length * (ends[6] - ends[0])
        scaled = solve_triangular(energy_root, ends.T, trans="T")
        stiffness[k] = scaled @ _stiffness_of_tension(length) @ scaled.T
    return AxialStiffening(forces, stiffness, np.asarray(np.linalg.eigvalsh(stiffness)[:, -1]))


def _stiffness_of_tension(length: float) -> Array:
    """Integral of the squares of both slopes of a beam with cubic deflections (Przemieniecki 1968, equation 15.24).

    Returns an array of shape (12, 12) in local axes, 1/m and m per m and rad.
    """
    k = np.zeros((12, 12))
    for dof, s in (((1, 5, 7, 11), length), ((2, 4, 8, 10), -length)):
        k[np.ix_(dof, dof)] = [
            [36, 3 * s, -36, 3 * s],
            [3 * s, 4 * s * s, -3 * s, -s * s],
            [-36, -3 * s, 36, -3 * s],
            [3 * s, -s * s, -3 * s, 4 * s * s],
        ]
    return k / (30 * length)
