"""Quasi-static recovery: the frame deforms at once under interface forces, weight and the inertia of rigid motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.fixed_interface import FixedInterface
from mbs.flexible.relief_matrices import InertiaRelief
from mbs.flexible.sparse import Sparse


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
