"""Matrices of inertia relief: outputs of a frame per interface force, weight and rigid acceleration."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class InertiaRelief:
    """Constant matrices from loads to outputs.

    Interface forces F are in body axes, stacked x, y, z per interface in the order given. The motion of the frame
    enters as ``s = A' (rdd_o - g)`` (3, origin of the body axes) and ``W = A' Add`` (3 by 3, row by row): the mass
    point at x has the specific acceleration ``s + W x``. For a rigid motion W = [alpha x] + [omega x][omega x].
    """

    forces: np.ndarray
    """Shape (n_outputs, 3 n_interfaces): outputs per newton with the reference node held."""
    acceleration: np.ndarray
    """Shape (n_outputs, 3): outputs per m/s2 of s."""
    rotation: np.ndarray
    """Shape (n_outputs, 9): outputs per 1/s2 of W, row by row."""
    balanced: np.ndarray
    """Shape (n_outputs, 3 n_interfaces): outputs per newton when the frame accelerates freely from small speeds of
    rotation: weight and inertia are already in them (weight acts like an acceleration and cancels out)."""
    acceleration_of_forces: np.ndarray
    """Shape (6, 3 n_interfaces): the s and the angular acceleration that balance unit forces, m/s2 and rad/s2."""

    def outputs(self, forces: np.ndarray, specific_acceleration: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Outputs under forces and a motion.

        Parameters
        ----------
        forces : ndarray, shape (3 n_interfaces,)
            F, N.
        specific_acceleration : ndarray, shape (3,)
            s, m/s2.
        rotation : ndarray, shape (3, 3)
            W, 1/s2.

        Returns
        -------
        ndarray, shape (n_outputs,)
            In the units of the outputs.
        """
        return np.asarray(
            self.forces @ forces + self.acceleration @ specific_acceleration + self.rotation @ np.ravel(rotation)
        )
