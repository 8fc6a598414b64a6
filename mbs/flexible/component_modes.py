"""Craig-Bampton reduction with the floating frame clamped at a reference node."""

from collections.abc import Sequence

import numpy as np
from scipy.linalg import eigh

from mbs.common.checks import flag, instance_of, is_number, positive, whole
from mbs.common.errors import ModelError
from mbs.common.one_thread import in_one_thread
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.fixed_interface import FixedInterface, Interface
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.modal_body import InterfaceModes
from mbs.flexible.reduced_body import ReducedBody

DEPENDENT = 1e-10  # squared mass norm below which an inertia mode depends linearly on others
ROUND_OFF = 2e-16  # fraction of the squared mass norm
MAX_MODES = 10**6
FIRST_BATCH = 20  # modes that are computed first if they are chosen by frequency


@in_one_thread
def craig_bampton(
    model: FiniteElementModel,
    reference: Reference,
    interfaces: Sequence[Interface | str | int],
    dynamic_modes: int | Sequence[int] = 0,
    *,
    up_to: float | None = None,
    inertia_modes: bool = False,
    damping: RayleighDamping | None = None,
) -> ReducedBody:
    """Static modes of the interfaces and dynamic modes with fixed interfaces (the paper's equation (9)).

    Parameters
    ----------
    reference : str, int or three of them
        Node of the floating frame: it does not move in any mode.
    interfaces : sequence of Interface, str or int
        Nodes of joints and forces. Static mode j is a unit motion of one interface coordinate, all others held.
    dynamic_modes : int or sequence of int
        How many of the lowest, or which (0 is the lowest).
    up_to : float, optional
        Take instead all dynamic modes up to this frequency, Hz.
    inertia_modes : bool
        Add the deformations under the inertia of the six rigid accelerations with the interfaces held: then static
        loads, gravity and steady accelerations deform the reduced body exactly like the full one.
    damping : RayleighDamping, optional
        None: no damping.

    Returns
    -------
    ReducedBody
        In the unit-interface basis: dynamic modes are mass-normalised and zero at the interfaces.
    """
    _check_arguments(model, inertia_modes, up_to, damping)
    fixed = FixedInterface(model, reference, interfaces)
    static = fixed.static_modes()
    hertz, dynamic = _dynamic_modes(fixed, dynamic_modes, up_to)
    names = _static_names(fixed)
    dynamic_names = [f"dynamic {i + 1}" for i in range(hertz.size)]
    if inertia_modes:
        hertz, dynamic = _with_inertia_modes(fixed, dynamic)
        dynamic_names = [f"dynamic and inertia {i + 1}" for i in range(hertz.size)]
    modes = np.hstack([static, dynamic])
    n_static, m = static.shape[1], modes.shape[1]
    if m == 0:
        raise ModelError("A reduction without interfaces and without dynamic modes leaves a rigid body.")

    K = _reduced_stiffness(model, static, hertz)
    origin = model.origin(reference)
    mass_shapes = np.asarray(model.mass.interpolation @ modes).reshape(-1, 3, m)
    weighted = (np.sqrt(model.mass.masses)[:, None, None] * mass_shapes).reshape(-1, m)
    M = _symmetric(weighted.T @ weighted)
    rotations = np.where(model.dof[:, 3:, None] >= 0, modes[model.dof[:, 3:]], 0.0)
    return ReducedBody(
        origin=origin,
        node_names=model.names,
        node_positions=model.positions - origin,
        node_translations=modes[model.dof[:, :3]],
        node_rotations=rotations,
        modes=modes,
        accelerations=_accelerations(fixed, modes),
        mass_positions=model.mass.positions - origin,
        masses=model.mass.masses,
        mass_shapes=mass_shapes,
        K=K,
        M=M,
        C=damping.matrix(M, K) if damping else np.zeros((m, m)),
        mode_names=(*names, *dynamic_names),
        interfaces=_interface_modes(fixed, origin),
        n_static=n_static,
        frequencies=hertz,
        frame=model.frame,
    )


def _check_arguments(
    model: FiniteElementModel, inertia_modes: bool, up_to: float | None, damping: RayleighDamping | None
) -> None:
    """Raise an error of the engine if an argument of `craig_bampton` has a wrong type or value."""
    instance_of(FiniteElementModel, model, "The model to reduce", "a FiniteElementModel")
    flag(inertia_modes, "inertia_modes")
    if up_to is not None:
        positive(up_to, "The frequency up_to of the modes")
    if damping is not None:
        instance_of(RayleighDamping, damping, "The damping of the modes", "a RayleighDamping")


def _reduced_stiffness(model: FiniteElementModel, static: np.ndarray, hertz: np.ndarray) -> np.ndarray:
    """Stiffness by modes, shape (m, m): static modes, then dynamic ones, which are not coupled with them."""
    n_static = static.shape[1]
    m = n_static + hertz.size
    K = np.zeros((m, m))
    K[:n_static, :n_static] = _symmetric(static.T @ (model.K @ static))
    K[range(n_static, m), range(n_static, m)] = (2 * np.pi * hertz) ** 2
    return K


def _accelerations(fixed: FixedInterface, modes: np.ndarray) -> np.ndarray | None:
    """Accelerations of the nodes whose inertia loads the inner nodes as each mode does, shape (3 n, m)."""
    model = fixed.model
    if not model.mass_along_beams:
        return None
    motions = np.hstack([model.rigid_motions(model.origin(fixed.reference)), modes])
    inertia = np.asarray(model.mass_matrix() @ motions)[fixed.inner]
    coefficients = np.linalg.lstsq(inertia, np.asarray(model.K @ modes)[fixed.inner], rcond=None)[0]
    return np.asarray((motions @ coefficients)[model.dof[:, :3].ravel()])


def _dynamic_modes(
    fixed: FixedInterface, dynamic_modes: int | Sequence[int], up_to: float | None
) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies, Hz, and shapes (n_dof, k) of the chosen dynamic modes."""
    held = fixed.held_freedoms()
    if up_to is not None:
        if not (is_number(dynamic_modes) and dynamic_modes == 0):
            raise ModelError("Dynamic modes are chosen by number or by frequency, not by both.")
        available = fixed.model.n_dof - held.size
        mass_freedoms = int((fixed.model.mass_matrix().diagonal()[fixed.inner] > 0).sum())
        count = min(FIRST_BATCH, mass_freedoms, available)
        hertz, shapes = natural_modes(fixed.model, count, held)
        while hertz.size and hertz[-1] <= up_to and count < mass_freedoms:
            count = min(2 * count, mass_freedoms)
            hertz, shapes = natural_modes(fixed.model, count, held)
        chosen = np.flatnonzero(hertz <= up_to)
    else:
        chosen = _mode_indices(dynamic_modes)
        if chosen.size and (chosen.min() < 0 or np.unique(chosen).size != chosen.size):
            raise ModelError(f"Dynamic modes are different numbers from 0 up, not {chosen.tolist()}.")
        hertz, shapes = natural_modes(fixed.model, int(chosen.max(initial=-1)) + 1, held)
    return hertz[chosen], shapes[:, chosen]


def _mode_indices(dynamic_modes: int | Sequence[int]) -> np.ndarray:
    """Indices of the dynamic modes, from their number or a sequence of indices."""
    if isinstance(dynamic_modes, Sequence) and not isinstance(dynamic_modes, (str, bytes)):
        return np.array([whole(k, "An entry of dynamic_modes") for k in dynamic_modes], dtype=int)
    return np.arange(whole(dynamic_modes, "The number of dynamic_modes", 0, MAX_MODES))


def _with_inertia_modes(fixed: FixedInterface, dynamic: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies, Hz, and Ritz vectors of the dynamic modes and the deformations under rigid accelerations."""
    model = fixed.model
    M = model.mass_matrix()
    deformations = fixed.solve(np.asarray(M @ model.rigid_motions(model.origin(fixed.reference))))
    full_square = np.einsum("ij,ij->j", deformations, M @ deformations)
    deformations -= dynamic @ (dynamic.T @ (M @ deformations))
    square = np.einsum("ij,ij->j", deformations, M @ deformations)
    # a straight beam without rotary inertia does not deform under rotation about its axis
    is_deformed = square > ROUND_OFF * full_square
    deformations = deformations[:, is_deformed] / np.sqrt(square[is_deformed])
    weights, directions = np.linalg.eigh(deformations.T @ (M @ deformations))
    deformations = deformations @ directions[:, weights > DEPENDENT] / np.sqrt(weights[weights > DEPENDENT])
    basis = np.hstack([dynamic, deformations])
    squares, V = eigh(_symmetric(basis.T @ (model.K @ basis)), _symmetric(basis.T @ (M @ basis)))
    shapes = basis @ V
    largest_entries = shapes[np.abs(shapes).argmax(axis=0), np.arange(shapes.shape[1])]
    return np.sqrt(squares) / (2 * np.pi), shapes * np.sign(largest_entries)


def _static_names(fixed: FixedInterface) -> list[str]:
    """Names of the static modes: node and axis of the unit motion."""
    names = []
    for interface in fixed.interfaces:
        node = fixed.model.names[fixed.model.node(interface.node)]
        axes = ["x", "y", "z"] * interface.translations + ["rx", "ry", "rz"] * interface.rotations
        names += [f"{node} {axis}" for axis in axes]
    return names


def _interface_modes(fixed: FixedInterface, origin: np.ndarray) -> dict[str, InterfaceModes]:
    """Columns of the modes that move each interface, by the name of its node. `origin`: of the floating frame, m."""
    modes, column = {}, 0
    for interface in fixed.interfaces:
        node = fixed.model.node(interface.node)
        translation = column + np.arange(3) if interface.translations else None
        column += 3 * interface.translations
        rotation = column + np.arange(3) if interface.rotations else None
        column += 3 * interface.rotations
        position = fixed.model.positions[node] - origin
        modes[fixed.model.names[node]] = InterfaceModes(node, position, translation, rotation)
    return modes


def _symmetric(X: np.ndarray) -> np.ndarray:
    return np.asarray((X + X.T) / 2)
