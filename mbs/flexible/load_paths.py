"""Reduction of a flexible body to the deformations that interface forces can excite."""

import numpy as np
from scipy.linalg import eigh

from mbs.common.errors import ModelError
from mbs.common.one_thread import in_one_thread
from mbs.flexible.mass_points import rigid_motions
from mbs.flexible.reduced_body import ReducedBody


def interface_loads(body: ReducedBody, directions: dict[str, np.ndarray]) -> np.ndarray:
    """Unit forces at interfaces, stacked in the order of `ReducedBody.interfaces`.

    Parameters
    ----------
    directions : dict of str to ndarray, shape (k, 3)
        Per interface the directions in which its joint can push, body axes: one along a rod or a spring, three at a
        spherical joint.

    Returns
    -------
    ndarray, shape (3 n_interfaces, n_loads)
        N.

    Raises
    ------
    ModelError
        There is no direction, or a node is not an interface.
    """
    order = list(body.interfaces)
    columns = []
    for name, vectors in directions.items():
        body.interface(name)
        for v in np.atleast_2d(np.asarray(vectors, float)):
            column = np.zeros((len(order), 3))
            column[order.index(name)] = v
            columns.append(column.ravel())
    if not columns:
        raise ModelError("No direction of any force was given: there is nothing that deforms the body.")
    return np.array(columns).T


@in_one_thread
def load_path_modes(
    body: ReducedBody, loads: np.ndarray, tolerance: float = 1e-6, frame_loads: np.ndarray | None = None
) -> ReducedBody:
    """Body with the deformations under given loads and the inertia that balances them, and no others.

    Each load is put in balance by the inertia of the rigid motion it causes and the deformation is solved for in the
    modes of `body` (give it the inertia modes: then the deformations are as of the full model). A singular value
    decomposition in the energy norm orders the combinations of loads, and those with little energy are left out. The
    result is in modes of its own that are orthogonal in stiffness and mass.

    Parameters
    ----------
    loads : ndarray, shape (3 n_interfaces, n_loads)
        Forces at the interfaces, of `interface_loads` or snapshots of a simulation.
    tolerance : float
        Square root of the energy, as a fraction of the largest, below which a combination of loads is left out.
    frame_loads : ndarray, shape (6, n_loads), optional
        Forces and moments on the floating frame that act together with the loads (drag, a driving function), N and N m.

    Returns
    -------
    ReducedBody
        With one mode per combination of loads that is kept.

    Raises
    ------
    ModelError
        The loads have not three rows for each interface.
    """
    deformation = load_path_deformations(body, loads, frame_loads)
    energy = deformation.T @ body.K @ deformation
    values, vectors = np.linalg.eigh((energy + energy.T) / 2)
    selected = values > tolerance**2 * values[-1]
    basis = deformation @ (vectors[:, selected] / np.sqrt(values[selected]))
    squares, V = eigh(basis.T @ body.K @ basis, basis.T @ body.M @ basis)
    names = tuple(f"load path {i + 1}" for i in range(squares.size))
    return body.transformed(basis @ V, names, np.sqrt(squares) / (2 * np.pi))


@in_one_thread
def load_path_deformations(body: ReducedBody, loads: np.ndarray, frame_loads: np.ndarray | None = None) -> np.ndarray:
    """Amplitudes under interface forces and the inertia that balances them, shape (n_modes, n_loads)."""
    if loads.ndim != 2 or loads.shape[0] != 3 * len(body.interfaces):
        raise ModelError(f"The loads have shape {loads.shape}; {3 * len(body.interfaces)} rows are needed.")
    shapes = np.concatenate([body.interface_translation(name) for name in body.interfaces])
    return np.linalg.solve(body.K, shapes.T @ loads - _balancing_inertia(body, loads, frame_loads))


def _balancing_inertia(body: ReducedBody, loads: np.ndarray, frame_loads: np.ndarray | None) -> np.ndarray:
    """Modal forces of the inertia of the rigid motion that each load causes, shape (n_modes, n_loads)."""
    positions = np.array([interface.position for interface in body.interfaces.values()])
    mass_motions, interface_motions = rigid_motions(body.mass_positions), rigid_motions(positions)
    rigid_mass = np.einsum("k,kia,kib->ab", body.masses, mass_motions, mass_motions)
    coupling = np.einsum("k,kij,kia->ja", body.masses, body.mass_shapes, mass_motions)
    total = interface_motions.reshape(-1, 6).T @ loads + (0.0 if frame_loads is None else frame_loads)
    acceleration = np.linalg.solve(rigid_mass, total)
    return np.asarray(coupling @ acceleration)
