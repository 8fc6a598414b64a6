"""Checks of a finite-element model before its reduction; each function raises `ModelError`."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import permutations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import eigsh, splu

from ali3.columns import some_of
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.sparse_matrices import Sparse

SYMMETRY = 1e-6  # fraction of the largest entry: round-off of matrices printed with seven digits
GROUNDED = 1e-5  # force of a rigid motion / (stiffness size): above round-off, below a spring to the ground
MECHANISM = 1e-13  # eigenvalue of the scaled stiffness, whose largest one is of order 1
AXES = ("x", "y", "z")
AXIS_WORDS = ("along x", "along y", "along z", "about x", "about y", "about z")
MAX_NAMES = 5  # largest number of nodes in a message


def check_symmetric(matrix: Sparse, label: str) -> None:
    """Refuse a matrix that is not square, finite and symmetric. `label`: its name in the message."""
    if matrix.shape[0] != matrix.shape[1]:
        raise ModelError(f"The {label} matrix is {matrix.shape[0]} by {matrix.shape[1]}; it must be square.")
    entries = sp.coo_array(matrix)
    if not np.isfinite(entries.data).all():
        raise ModelError(f"The {label} matrix has entries that are not finite numbers.")
    largest = float(np.abs(entries.data).max(initial=0.0))
    if largest == 0.0:
        raise ModelError(f"The {label} matrix is zero.")
    error = sp.coo_array(matrix - matrix.T)
    if error.nnz and (worst := int(np.abs(error.data).argmax())) >= 0 and abs(error.data[worst]) > SYMMETRY * largest:
        i, j = sorted((int(error.row[worst]), int(error.col[worst])))
        difference = abs(error.data[worst])
        raise ModelError(
            f"The {label} matrix is not symmetric: entries ({i}, {j}) and ({j}, {i}) differ by {difference:g}."
        )


def asymmetry(matrix: Sparse) -> float:
    """Largest difference of a matrix from its transpose, relative to its largest entry."""
    differences = sp.coo_array(matrix - matrix.T).data
    return float(np.abs(differences).max(initial=0.0) / np.abs(sp.coo_array(matrix).data).max())


def negative_eigenvalues(matrix: Sparse) -> int:
    """Number of eigenvalues below `-SYMMETRY` of a symmetric matrix scaled to a diagonal of ones.

    By Sylvester's law of inertia: the signs of the pivots of its factors.
    """
    diagonal = matrix.diagonal()
    entries = sp.coo_array(matrix)
    columns = np.unique(entries.col[entries.data != 0.0])
    if (diagonal[columns] <= 0.0).any():
        return max(int((diagonal[columns] <= 0.0).sum()), 1)
    scale = sp.diags_array(1.0 / np.sqrt(diagonal[columns]))
    shifted = sp.csc_array(scale @ matrix[columns][:, columns] @ scale + SYMMETRY * sp.eye_array(columns.size))
    factors = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return int((factors.U.diagonal() < 0.0).sum())


def check_definite(matrix: Sparse, label: str) -> int:
    """Refuse a negative matrix; return the number of negative eigenvalues. `label`: its name in the message."""
    negative = negative_eigenvalues(matrix)
    if negative and not negative_eigenvalues(-matrix):
        raise ModelError(f"The {label} matrix is negative; it must be positive: its sign is reversed.")
    return negative


def check_free(model: FiniteElementModel) -> None:
    """Refuse a stiffness that supports the model on the ground or is not in the order of the nodes."""
    forces = _rigid_motion_forces(model, model.positions, model.dof)
    worst = np.unravel_index(int(forces.argmax()), forces.shape)
    if forces[worst] <= GROUNDED:
        return
    node, axis = (int(k[0]) for k in np.nonzero(model.dof == worst[0]))
    subject = f"The stiffness resists rigid motions at node {model.names[node]!r}"
    for mistake, x, dof in _mistakes(model):
        if _rigid_motion_forces(model, x, dof).max() <= GROUNDED:
            raise ModelError(f"{subject}: {mistake} would explain it.")
    if (entry := _reversed_entry(model)) is not None:
        raise ModelError(f"{subject}: the sign of its entries {entry} and {entry[::-1]} would explain it.")
    translation_forces = forces[:, :3]
    if translation_forces.max() <= GROUNDED:
        raise ModelError(
            f"{subject} for rotations, not for translations: the positions of the nodes do not belong to the "
            "stiffness, by their order, axes or unit."
        )
    transverse_forces = translation_forces.copy()
    for k in range(3):
        transverse_forces[model.dof[:, k], k] = 0.0
    if transverse_forces.max() > GROUNDED:
        raise ModelError(
            f"{subject}, with forces {AXIS_WORDS[axis]} across the motion, which no support has: the degrees of "
            "freedom are not in the order of the nodes, or an entry is wrong."
        )
    raise ModelError(f"{subject}: give the free model, without supports.")


def _rigid_motion_forces(model: FiniteElementModel, x: np.ndarray, dof: np.ndarray) -> np.ndarray:
    """Forces at unit rigid motions / largest stiffness, shape (n_dof, 6), for node positions and freedoms."""
    corrected = replace(model, positions=x, dof=dof)
    forces = np.asarray(np.abs(model.K @ corrected.rigid_motions(x.mean(axis=0))))
    forces[:, 3:] /= float(np.ptp(x, axis=0).max())
    return forces / float(np.abs(model.K.data).max())


def _mistakes(model: FiniteElementModel) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Description of each common mistake, with the corrected node positions and freedoms."""
    x, dof, n = model.positions, model.dof, len(model.positions)
    per_node = model.n_dof // n if model.n_dof in (3 * n, 6 * n) else 0
    if per_node:
        axis_major = dof.copy()
        axis_major[:, :per_node] = np.arange(per_node * n).reshape(per_node, n).T
        yield "one axis after the other instead of node after node in the order of the freedoms", x, axis_major
    if per_node == 6:
        separated = np.hstack([np.arange(3 * n).reshape(n, 3), 3 * n + np.arange(3 * n).reshape(n, 3)])
        yield "all translations before all rotations instead of node after node", x, separated
        yield "rotations before translations of each node", x, dof[:, [3, 4, 5, 0, 1, 2]]
        yield "mm instead of m in the places of the nodes", 1e-3 * x, dof
        yield "N mm instead of N m in the stiffness", 1e3 * x, dof
    numbers = [(len(name), name) if name.isdigit() else (0, name) for name in model.names]
    for text, node_order in (
        ("by their names", sorted(range(n), key=lambda k: numbers[k])),
        ("by their names as words", sorted(range(n), key=lambda k: model.names[k])),
        ("backwards", list(range(n))[::-1]),
    ):
        yield f"nodes in the order of the matrices instead of {text}", x[np.argsort(node_order)], dof
        yield f"nodes {text} instead of the order of the matrices", x[node_order], dof
    for order in permutations(range(3)):
        names = [f"{a} for {b}" for a, b in zip((AXES[k] for k in order), AXES, strict=True) if a != b]
        if names:
            text = f"exchanged axes, {' and '.join(names)}"
            yield f"{text}, in the places of the nodes", x[:, order], dof
            yield f"{text}, in the order of the freedoms", x, dof[:, [*order, 3, 4, 5]]
            yield f"{text}, in the order of the freedoms", x, dof[:, [*order, *(3 + k for k in order)]]
    for k, axis in enumerate(AXES):
        yield f"the sign of {axis} in the places of the nodes", x * np.where(np.arange(3) == k, -1.0, 1.0), dof


def _reversed_entry(model: FiniteElementModel) -> tuple[int, int] | None:
    """Row and column of an entry whose sign must change for the model to be free; None if there is none."""
    motions = model.rigid_motions(model.positions.mean(axis=0))
    forces = np.asarray(model.K @ motions)[:, :3]
    i = int(np.abs(forces).max(axis=1).argmax())
    row = model.K[[i]].toarray()[0]
    # the new sign changes the force of its row by twice the entry times the motion of its column
    residuals = np.abs(forces[i] - 2.0 * row[:, None] * motions[:, :3]).max(axis=1)
    residuals[i] = np.inf
    for j in np.argsort(residuals)[:3].tolist():
        K = model.K.tolil(copy=True)
        K[i, j], K[j, i] = -K[i, j], -K[j, i]
        corrected = replace(model, K=sp.csc_array(K))
        if _rigid_motion_forces(corrected, model.positions, model.dof).max() <= GROUNDED:
            return min(i, j), max(i, j)
    return None


def check_connected(model: FiniteElementModel, reference: Reference) -> None:
    """Refuse nodes without connection to the reference node, and mechanisms."""
    reference_freedoms = model.reference_freedoms(reference)
    islands = _island_nodes(model, reference_freedoms)
    if islands.size:
        raise ModelError(f"No element ties {_node_list(model, islands)} to the reference node.")
    _check_mechanism(model, reference_freedoms)


def _island_nodes(model: FiniteElementModel, held: np.ndarray) -> np.ndarray:
    """Nodes without a path of stiffness entries to the reference."""
    node_of, K = model.node_of, sp.coo_array(model.K)
    n = len(model.names)
    stiff = np.abs(K.data) > 0
    graph = sp.coo_array((np.ones(int(stiff.sum())), (node_of[K.row[stiff]], node_of[K.col[stiff]])), shape=(n, n))
    _, component = connected_components(sp.csr_array(graph), directed=False)
    return np.flatnonzero(component != component[node_of[held[0]]])


def _check_mechanism(model: FiniteElementModel, held: np.ndarray) -> None:
    """Refuse motions without stiffness while the degrees of freedom `held` are zero."""
    free = np.setdiff1d(np.arange(model.n_dof), held)
    diagonal = model.K.diagonal()[free]
    if (diagonal <= 0).any():
        number = int(free[np.flatnonzero(diagonal <= 0)[0]])
        node, axis = (int(i) for i in np.argwhere(model.dof == number)[0])
        raise ModelError(f"Nothing resists the motion {AXIS_WORDS[axis]} of node {model.names[node]!r}.")
    scale = sp.csr_array(sp.diags(1 / np.sqrt(diagonal)))
    K = sp.csc_array(scale @ model.K[free][:, free] @ scale)
    # the shift keeps the factorisation regular if the stiffness is singular
    value, vector = eigsh(K, k=1, sigma=-1e-9, which="LM", v0=np.ones(free.size))
    if value[0] < MECHANISM:
        motion = np.zeros(model.n_dof)
        motion[free] = np.abs(scale @ vector[:, 0])
        per_node = np.where(model.dof >= 0, motion[model.dof], 0.0).max(axis=1)
        moving = np.flatnonzero(per_node > 0.1 * per_node.max())
        raise ModelError(
            f"The stiffness is singular with the reference node held: {_node_list(model, moving)} can move without "
            "force."
        )


def _node_list(model: FiniteElementModel, nodes: np.ndarray) -> str:
    return f"{'node' if nodes.size == 1 else 'nodes'} {some_of((repr(model.names[i]) for i in nodes), MAX_NAMES)}"
