"""Inertia relief: quasi-static deformation under interface forces, weight and the inertia of rigid motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.common.one_thread import in_one_thread
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.fixed_interface import FixedInterface
from mbs.flexible.relief_matrices import InertiaRelief
from mbs.flexible.sparse_matrices import Sparse


@in_one_thread
def inertia_relief(
    model: FiniteElementModel, reference: Reference, interfaces: Sequence[str | int], rows: np.ndarray | Sparse
) -> InertiaRelief:
    """Solve the model once per interface force and per unit acceleration.

    Outputs must not depend on rigid motions, as stresses and section forces; then the held node does not affect them
    under balanced loads.

    Parameters
    ----------
    model : FiniteElementModel
        The body.
    reference : str, int or three of them
        Origin of the body axes; held while the deformation is computed.
    interfaces : sequence of str or int
        Nodes where forces act.
    rows : ndarray or sparse array, shape (n_outputs, n_dof) or (n_outputs, n_dof + 3 n)
        Outputs per unit nodal displacement, e.g. of `recovery.gauge_rows`; n nodes.

    Returns
    -------
    InertiaRelief
        Matrices from loads and accelerations to the outputs.

    Raises
    ------
    ModelError
        The rows have not one column for each freedom, or a node does not exist.
    """
    fixed = FixedInterface(model, reference, ())
    if not isinstance(interfaces, (list, tuple)):
        raise ModelError(f"The interfaces must be a list of nodes, not {shown(interfaces)}.")
    if rows.shape[1] not in (model.n_dof, model.n_dof + 3 * len(model.positions)):
        raise ModelError(f"The output rows have {rows.shape[1]} columns; the model has {model.n_dof} freedoms.")
    loads = np.zeros((model.n_dof, 3 * len(interfaces)))
    numbers = np.concatenate([model.freedoms(node) for node in interfaces]) if interfaces else np.zeros(0, int)
    loads[numbers, np.arange(numbers.size)] = 1.0

    origin = model.origin(reference)
    points, x = model.mass, model.mass.positions - origin
    field = np.zeros((len(x), 3, 12))  # accelerations of the mass points per unit of s and W
    for i in range(3):
        field[:, i, i] = 1.0
        field[:, i, 3 + 3 * i : 6 + 3 * i] = x
    inertia = -np.asarray(points.interpolation.T @ (points.masses[:, None, None] * field).reshape(-1, 12))

    nodes = np.zeros((len(model.positions), 3, 12))  # the same for nodes, for the beams between them
    if model.mass_along_beams:
        nodes[:, range(3), range(3)] = -1.0
        for i in range(3):
            nodes[:, i, 3 + 3 * i : 6 + 3 * i] = origin - model.positions

    def outputs(forces: np.ndarray, accelerations: np.ndarray) -> np.ndarray:
        return np.asarray(rows @ np.vstack([fixed.solve(forces), accelerations])[: rows.shape[1]])

    to_forces = outputs(loads, np.zeros((nodes.shape[0] * 3, loads.shape[1])))
    to_motion = outputs(inertia, nodes.reshape(-1, 12))
    R = model.rigid_motions(origin)
    # unit angular accelerations as columns of W
    rigid_to_motion = np.zeros((12, 6))
    rigid_to_motion[:3, :3] = np.eye(3)
    for axis in range(3):
        e = np.zeros(3)
        e[axis] = 1.0
        rigid_to_motion[3:, 3 + axis] = np.cross(e, np.eye(3)).T.ravel()
    rigid_mass = -R.T @ (inertia @ rigid_to_motion)
    balance = np.linalg.solve(rigid_mass, R.T @ loads)
    balanced = to_forces + to_motion @ rigid_to_motion @ balance
    return InertiaRelief(to_forces, to_motion[:, :3], to_motion[:, 3:], balanced, balance)
