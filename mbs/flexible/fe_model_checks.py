"""What a finite-element model must satisfy before it is reduced, each with one sentence when it does not."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import eigsh

from ali3.columns import some_of
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.sparse import Sparse

SYMMETRY = 1e-6  # of the largest entry: matrices printed with seven digits pass
GROUNDED = 1e-5  # of the stiffness times the size: printed matrices pass, a spring to the ground does not
MECHANISM = 1e-13  # of the scaled stiffness, whose largest eigenvalue is of order 1
MASS_RANGE = (1e-6, 1e5)  # kg
SIZE_RANGE = (1e-4, 1e3)  # m
AXIS_WORDS = ("along x", "along y", "along z", "about x", "about y", "about z")
NAMED = 5  # nodes named in one sentence


def check_symmetric(matrix: Sparse, what: str) -> None:
    """Refuse a matrix that is not square, finite and symmetric."""
    if matrix.shape[0] != matrix.shape[1]:
        raise ModelError(f"The {what} matrix is {matrix.shape[0]} by {matrix.shape[1]}; it must be square.")
    entries = sp.coo_array(matrix)
    if not np.isfinite(entries.data).all():
        raise ModelError(f"The {what} matrix has entries that are not finite numbers.")
    largest = float(np.abs(entries.data).max(initial=0.0))
    if largest == 0.0:
        raise ModelError(f"The {what} matrix is zero.")
    error = sp.coo_array(matrix - matrix.T)
    if error.nnz and (worst := int(np.abs(error.data).argmax())) >= 0 and abs(error.data[worst]) > SYMMETRY * largest:
        i, j = sorted((int(error.row[worst]), int(error.col[worst])))
        gap = abs(error.data[worst])
        raise ModelError(f"The {what} matrix is not symmetric: entries ({i}, {j}) and ({j}, {i}) differ by {gap:g}.")


def check_units(model: FiniteElementModel) -> None:
    """Refuse totals that no body on wheels or benches has in kilograms and metres."""
    total, size = float(model.mass.masses.sum()), float(np.ptp(model.positions, axis=0).max())
    if not MASS_RANGE[0] <= total <= MASS_RANGE[1]:
        raise ModelError(
            f"The model weighs {total:g} kg; between {MASS_RANGE[0]:g} and {MASS_RANGE[1]:g} kg were expected: "
            "are lengths in m, stiffness in N/m and masses in kg?"
        )
    if not SIZE_RANGE[0] <= size <= SIZE_RANGE[1]:
        raise ModelError(f"The model is {size:g} m long; are its lengths in metres?")


def check_free(model: FiniteElementModel) -> None:
    """Refuse a stiffness that holds the model to the ground."""
    origin = model.positions.mean(axis=0)
    size = float(np.ptp(model.positions, axis=0).max())
    forces = np.abs(model.K @ model.rigid_motions(origin))
    forces[:, 3:] /= size
    stiffness = float(np.abs(model.K.data).max())
    worst = np.unravel_index(int(forces.argmax()), forces.shape)
    if forces[worst] > GROUNDED * stiffness:
        node = int(np.flatnonzero((model.dof == worst[0]).any(axis=1))[0])
        raise ModelError(
            f"The stiffness resists rigid motions at node {model.names[node]!r}: give the free model, without supports."
        )


def check_connected(model: FiniteElementModel, reference: Reference) -> None:
    """Refuse nodes or degrees of freedom that nothing ties to the reference node, and mechanisms."""
    held = model.reference_freedoms(reference)
    islands = _island_nodes(model, held)
    if islands.size:
        raise ModelError(f"No element ties {_named(model, islands)} to the reference node.")
    _check_mechanism(model, held)


def _island_nodes(model: FiniteElementModel, held: np.ndarray) -> np.ndarray:
    """Nodes without any path of stiffness entries to the reference."""
    node_of = np.full(model.n_dof, -1)
    rows, columns = np.nonzero(model.dof >= 0)
    node_of[model.dof[rows, columns]] = rows
    K = sp.coo_array(model.K)
    n = len(model.names)
    stiff = np.abs(K.data) > 0
    graph = sp.coo_array((np.ones(int(stiff.sum())), (node_of[K.row[stiff]], node_of[K.col[stiff]])), shape=(n, n))
    _, part = connected_components(sp.csr_array(graph), directed=False)
    return np.flatnonzero(part != part[node_of[held[0]]])


def _check_mechanism(model: FiniteElementModel, held: np.ndarray) -> None:
    free = np.setdiff1d(np.arange(model.n_dof), held)
    diagonal = model.K.diagonal()[free]
    if (diagonal <= 0).any():
        number = int(free[np.flatnonzero(diagonal <= 0)[0]])
        node, axis = (int(i) for i in np.argwhere(model.dof == number)[0])
        raise ModelError(f"Nothing resists the motion {AXIS_WORDS[axis]} of node {model.names[node]!r}.")
    scale = sp.csr_array(sp.diags(1 / np.sqrt(diagonal)))
    K = sp.csc_array(scale @ model.K[free][:, free] @ scale)
    # the shift keeps the factorisation regular where the stiffness is not
    value, vector = eigsh(K, k=1, sigma=-1e-9, which="LM", v0=np.ones(free.size))
    if value[0] < MECHANISM:
        motion = np.zeros(model.n_dof)
        motion[free] = np.abs(scale @ vector[:, 0])
        per_node = np.where(model.dof >= 0, motion[model.dof], 0.0).max(axis=1)
        moving = np.flatnonzero(per_node > 0.1 * per_node.max())
        raise ModelError(
            f"The stiffness is singular with the reference node held: {_named(model, moving)} can move without force."
        )


def _named(model: FiniteElementModel, nodes: np.ndarray) -> str:
    return f"{'node' if nodes.size == 1 else 'nodes'} {some_of((repr(model.names[i]) for i in nodes), NAMED)}"
