"""Quasi-static recovery: the frame deforms at once under interface forces, weight and the inertia of rigid motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.fixed_interface import FixedInterface
from mbs.flexible.sparse import Sparse


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


def inertia_relief(
    model: FiniteElementModel, reference: Reference, interfaces: Sequence[str | int], rows: np.ndarray | Sparse
) -> InertiaRelief:
    """Solve the model once per interface force and per unit acceleration.

    Outputs must not see rigid motions (stresses and section forces do not); then the node that is held does not
    matter where loads are in balance.

    Parameters
    ----------
    reference : str, int or three of them
        Origin of the body axes; held while the deformation is computed.
    interfaces : sequence of str or int
        Nodes where forces act.
    rows : ndarray or sparse array, shape (n_outputs, n_dof)
        Outputs per unit nodal displacement, e.g. of `recovery.gauge_rows`.

    Returns
    -------
    InertiaRelief
        Its matrices.

    Raises
    ------
    ModelError
        The rows have not one column for each freedom, or a node does not exist.
    """
    fixed = FixedInterface(model, reference, ())
    if not isinstance(interfaces, (list, tuple)):
        raise ModelError(f"The interfaces must be a list of nodes, not {shown(interfaces)}.")
    if rows.shape[1] != model.n_dof:
        raise ModelError(f"The output rows have {rows.shape[1]} columns; the model has {model.n_dof} freedoms.")
    loads = np.zeros((model.n_dof, 3 * len(interfaces)))
    numbers = np.concatenate([model.freedoms(node) for node in interfaces]) if interfaces else np.zeros(0, int)
    loads[numbers, np.arange(numbers.size)] = 1.0

    origin = model.origin(reference)
    points, x = model.mass, model.mass.positions - origin
    field = np.zeros((len(x), 3, 12))  # accelerations of the mass points per unit s and W
    for i in range(3):
        field[:, i, i] = 1.0
        field[:, i, 3 + 3 * i : 6 + 3 * i] = x
    inertia = -np.asarray(points.interpolation.T @ (points.masses[:, None, None] * field).reshape(-1, 12))

    to_forces = np.asarray(rows @ fixed.solve(loads))
    to_motion = np.asarray(rows @ fixed.solve(inertia))
    R = model.rigid_motions(origin)
    # unit angular accelerations as columns of W
    turn = np.zeros((12, 6))
    turn[:3, :3] = np.eye(3)
    for axis in range(3):
        e = np.zeros(3)
        e[axis] = 1.0
        turn[3:, 3 + axis] = np.cross(e, np.eye(3)).T.ravel()
    rigid_mass = -R.T @ (inertia @ turn)
    balance = np.linalg.solve(rigid_mass, R.T @ loads)
    balanced = to_forces + to_motion @ turn @ balance
    return InertiaRelief(to_forces, to_motion[:, :3], to_motion[:, 3:], balanced, balance)
