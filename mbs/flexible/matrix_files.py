"""Finite-element models of other programs from their stiffness matrix, mass matrix and nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from ali3.tables import TextTable
from mbs.common.checks import numbers, positive
from mbs.common.errors import ModelError
from mbs.flexible.beam_frame import node_labels
from mbs.flexible.body_plausibility import FlexibleWarning, model_plausibility
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fe_model_checks import SYMMETRY, asymmetry, check_definite, check_free, check_symmetric
from mbs.flexible.foreign_file import read_foreign
from mbs.flexible.mass_lumping import lumped_masses
from mbs.flexible.mass_points import check_masses, nodal_mass_points
from mbs.flexible.matrix_market import read_matrix_market, read_sparse_arrays
from mbs.flexible.sparse_matrices import Sparse


def external_model(
    stiffness: np.ndarray | Sparse,
    mass: np.ndarray | Sparse,
    positions: ArrayLike,
    names: Sequence[str] | None = None,
    dof: ArrayLike | None = None,
    total_mass: float | None = None,
    what: str = "",
) -> FiniteElementModel:
    """Model from matrices in SI units, free of supports.

    Parameters
    ----------
    stiffness : ndarray or sparse array, shape (n_dof, n_dof)
        Symmetric.
    mass : ndarray or sparse array, shape (n_dof, n_dof) or (n,)
        Mass matrix, lumped at the nodes by `lumped_masses`; or one mass per node, kg.
    positions : array_like, shape (n, 3)
        Nodes, m.
    names : sequence of str, optional
        By default the node numbers from 0.
    dof : array_like of int, shape (n, 6), optional
        Number of each freedom, -1 for none. By default node after node with the six freedoms x, y, z, rx, ry, rz, or
        with x, y, z when the matrices have three freedoms per node.
    total_mass : float, optional
        Mass of the body known from another source, kg; a model with another mass gives a warning.
    what : str
        Name of the file, for messages.

    Raises
    ------
    ModelError
        A matrix is not symmetric, has the wrong sign or size, the stiffness has a negative eigenvalue or supports the
        model on the ground, or a mass is negative; the message names a mistake that explains it, if one does.

    Warns
    -----
    FlexibleWarning
        Mass, size or first free natural frequency are implausible in SI units, or the mass matrix does not belong to
        the stiffness.
    """
    expected_mass = 0.0 if total_mass is None else positive(total_mass, "The total_mass of a flexible body")
    x = numbers(positions, "the node positions", ModelError, "finite numbers of shape (n, 3)")
    if x.ndim != 2 or x.shape[1] != 3 or not np.isfinite(x).all():
        raise ModelError(f"Node positions have shape {x.shape}; finite numbers of shape (n, 3) are needed.")
    n = len(x)
    labels = node_labels(names, n)
    K = sp.csc_array(stiffness)
    check_symmetric(K, "stiffness")
    measured = {"asymmetry": {"stiffness": asymmetry(K)}, "negative": {"stiffness": 0.0}}
    table = _freedom_table(dof, n, int(K.shape[0]))
    K = sp.csc_array((K + K.T) / 2)
    if negative := check_definite(K, "stiffness"):
        raise ModelError(f"The stiffness matrix has {negative} negative eigenvalues; a deformation takes energy.")
    no_mass = nodal_mass_points(x, np.zeros(n), table[:, :3], int(K.shape[0]))
    model = FiniteElementModel(x, labels, table, K, no_mass, given=measured)
    check_free(model)
    if sp.issparse(mass) or np.ndim(mass) == 2:
        M = sp.csc_array(mass)
        check_symmetric(M, "mass")
        if M.shape != K.shape:
            raise ModelError(f"The mass matrix is {M.shape[0]} and the stiffness matrix {K.shape[0]} wide.")
        measured["asymmetry"]["mass"] = asymmetry(M)
        M = sp.csc_array((M + M.T) / 2)
        measured["negative"]["mass"] = check_definite(M, "mass")
        measured |= {
            "apart": {"mass": _count_uncoupled_pairs(M, model)},
            "rigid": {"mass": _rigid_inertia_error(M, model)},
        }
        points = lumped_masses(M, x, table)
    else:
        masses = np.array(mass, float)
        if masses.shape != (n,):
            raise ModelError(f"Node masses have shape {masses.shape}; one number for each of {n} nodes is needed.")
        check_masses(masses, labels)
        points = nodal_mass_points(x, masses, table[:, :3], int(K.shape[0]))
    model = replace(model, mass=points)
    for plausibility in model_plausibility(model, what, beside=expected_mass):
        plausibility.warn(FlexibleWarning)
    return model


def _rigid_inertia_error(M: Sparse, model: FiniteElementModel) -> float:
    """Deviation of the inertia of rigid unit motions from a rigid body's, relative to mass and size."""
    R = model.rigid_motions(model.positions.mean(axis=0))
    inertia = R.T @ (M @ R)
    totals, moments = inertia[:3, :3], inertia[:3, 3:]
    mass, size = np.trace(totals) / 3.0, np.ptp(model.positions, axis=0).max()
    error = max(np.abs(totals - mass * np.eye(3)).max(), np.abs(moments + moments.T).max() / size)
    return float(error / abs(mass)) if mass else np.inf


def _count_uncoupled_pairs(M: Sparse, model: FiniteElementModel) -> int:
    """Number of pairs of nodes that are coupled by the mass matrix but not by the stiffness."""
    node_of, pairs = model.node_of, []
    for matrix in (model.K, M):
        entries = sp.coo_array(matrix)
        nonzero = np.abs(entries.data) > SYMMETRY * np.abs(entries.data).max()
        rows, columns = node_of[entries.row[nonzero]].tolist(), node_of[entries.col[nonzero]].tolist()
        pairs.append(set(zip(rows, columns, strict=True)))

    return sum(i < j for i, j in pairs[1] - pairs[0])


def read_matrix(path: str | Path) -> sp.csc_array:
    """Sparse matrix from Matrix Market (``.mtx``, ``.mtx.gz``) or SciPy's ``.npz``.

    Raises
    ------
    ModelError
        There is no such file, or it is of neither kind.
    """
    path = Path(path)
    if path.suffix == ".npz":
        return sp.csc_array(read_foreign(path, read_sparse_arrays))
    if path.name.endswith((".mtx", ".mtx.gz")):
        return sp.csc_array(read_foreign(path, read_matrix_market))
    raise ModelError(f"{path.name} is neither Matrix Market (.mtx, .mtx.gz) nor a SciPy matrix (.npz).")


def read_model(
    stiffness: str | Path, mass: str | Path, nodes: str | Path, *, total_mass: float | None = None
) -> FiniteElementModel:
    """Model from two matrix files and a file of nodes.

    Parameters
    ----------
    stiffness, mass : str or Path
        Files for `read_matrix`.
    nodes : str or Path
        CSV file with the columns ``name,x,y,z`` (m) and a header line.
    total_mass : float, optional
        Mass of the body known from another source, kg; see `external_model`.

    Returns
    -------
    FiniteElementModel
        Checked as in `external_model`, with the same warnings.

    Raises
    ------
    ModelError
        A file is missing or has another form, or the matrices do not describe a free model.
    """
    names, positions = [], []
    table = TextTable(nodes, ModelError, known=("x", "y", "z"))
    if table.width != 4:
        raise ModelError(f"{Path(nodes).name} has the columns {', '.join(table.names)}; they must be name, x, y, z.")
    for row in table.rows():
        names.append(row.cells[0])
        positions.append(table.numbers(row, first=1))
    K, M = read_matrix(stiffness), read_matrix(mass)
    return external_model(K, M, positions, names, total_mass=total_mass, what=Path(stiffness).name)


def _freedom_table(dof: ArrayLike | None, n: int, size: int) -> np.ndarray:
    """Numbers of the degrees of freedom of each node, shape (n, 6), checked; -1 for none. `size`: number of rows of the
    matrices."""
    if dof is None:
        if size not in (3 * n, 6 * n):
            raise ModelError(f"The stiffness matrix has {size} rows; {n} nodes have {3 * n} or {6 * n} freedoms.")
        table = np.full((n, 6), -1)
        per_node = size // n
        table[:, :per_node] = np.arange(size).reshape(n, per_node)
        return table
    table = np.array(dof, int)
    if table.shape != (n, 6) or (table[:, :3] < 0).any():
        raise ModelError(f"The freedoms have shape {table.shape}; ({n}, 6) with all translations is needed.")
    numbers = np.sort(table[table >= 0])
    if not np.array_equal(numbers, np.arange(size)):
        raise ModelError(f"The freedoms must number each of the {size} rows of the matrices once.")
    return table
