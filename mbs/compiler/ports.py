"""Maps of coordinates and multipliers from a model without ports to the same model with ports."""

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, sparse

from mbs.common.frames import Frames
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import SensorType
from mbs.system.system import System

Array = NDArray[np.float64]

CLOSED = 1e-9
"""Largest difference of equal models: of coordinates in m, of masses and gradients relative."""
DROP = 1e-13
"""Entries of a map below this part of its largest count as zero."""
_POSITIONS, _DISTANCE = 3, 0.3
"""Number of positions at which gradients of rows are compared, and their typical distance from the drawing, m."""


def with_ports_of(ported: System, plain: System) -> System | None:
    """The System with ports, with maps by which it follows a run of the one without them (`ali3_ports_follow`).

    Rows of ports are linear, and all other full coordinates are the same in both Systems, so its coordinates are affine
    functions of those of the plain System. The gradients of its other rows are constant linear combinations of those of
    the plain System, and so are its multipliers. The multipliers of the rows of ports balance the remaining forces on
    as many coordinates, those with the fewest of these rows.

    Parameters
    ----------
    ported : System
        With quasi-static outputs, which read the rows of the ports.
    plain : System
        Of the same model without ports.

    Returns
    -------
    System or None
        With the arrays ``ported_``; None if the models differ, or a System was read from a file without its full
        coordinates.
    """
    ported_frames, plain_frames = ported.frames, plain.frames
    if (
        ported_frames is None
        or plain_frames is None
        or ported_frames.flexible
        or plain_frames.flexible
        or not _have_same_forces(ported, plain)
    ):
        return None
    rows, ports, constants = _port_rows(ported)
    ported_indices, plain_indices = _shared_coordinates(ported_frames), _shared_coordinates(plain_frames)
    if not len(constants) or len(ported_indices) != len(plain_indices):
        return None
    known_rows = np.vstack([ported_frames.T[ported_indices].toarray(), ports])
    known_values = np.vstack([plain_frames.T[plain_indices].toarray(), np.zeros((len(ports), plain.nq))])
    offset = np.concatenate([plain_frames.constant[plain_indices] - ported_frames.constant[ported_indices], -constants])
    T, _, rank, _ = np.linalg.lstsq(known_rows, np.column_stack([known_values, offset]), rcond=None)
    if rank < ported.nq or np.max(np.abs(known_rows @ T - np.column_stack([known_values, offset]))) > CLOSED:
        return None
    T[np.abs(T) < DROP * np.max(np.abs(T))] = 0.0
    columns = sparse.csc_matrix(T[:, :-1])
    difference = (columns.T @ _mass(ported) @ columns - _mass(plain)).toarray()
    if np.max(np.abs(difference)) > CLOSED * _mass(plain).max():
        return None
    multiplier_map = _multiplier_map(ported, plain, columns, T[:, -1])
    if multiplier_map is None:
        return None
    port_forces = _balance_forces(ported, rows)
    arrays = {
        "ported_ptr": columns.indptr,
        "ported_row": columns.indices,
        "ported_val": columns.data,
        "ported_const": T[:, -1],
        "ported_lam_ptr": multiplier_map.indptr,
        "ported_lam_row": multiplier_map.indices,
        "ported_lam_val": multiplier_map.data,
        "ported_force_ptr": port_forces.indptr,
        "ported_force_col": port_forces.indices,
        "ported_force_val": port_forces.data,
    }
    return ported.with_arrays(arrays)


def _multiplier_map(ported: System, plain: System, T: sparse.csc_matrix, constant: Array) -> sparse.csc_matrix | None:
    """Matrix from multipliers of the plain System to multipliers of rows that are not of ports; None if rows differ.

    With dependent rows it is the matrix of least norm.
    """
    random = np.random.Generator(np.random.PCG64(0))
    positions = [plain.arrays["q0"] + _DISTANCE * random.standard_normal(plain.nq) for _ in range(_POSITIONS + 1)]
    plain_instance = Instance(LoadedSystem(plain.kernel_bytes()))
    ported_instance = Instance(LoadedSystem(ported.kernel_bytes()))
    plain_gradients = [_gradients(plain, plain_instance, q) for q in positions]
    ported_gradients = [_gradients(ported, ported_instance, T @ q + constant) @ T for q in positions]
    multiplier_map, *_ = np.linalg.lstsq(
        np.hstack(ported_gradients[:-1]).T, np.hstack(plain_gradients[:-1]).T, rcond=CLOSED
    )
    multiplier_map[np.abs(multiplier_map) < CLOSED * np.max(np.abs(multiplier_map))] = 0.0
    gaps = (
        np.max(np.abs(g.T @ multiplier_map - w.T)) / np.max(np.abs(w))
        for g, w in zip(ported_gradients, plain_gradients, strict=True)
    )
    return sparse.csc_matrix(multiplier_map) if max(gaps) < CLOSED else None


def _gradients(system: System, instance: Instance, q: Array) -> Array:
    """Phi_q of the rows in storage, shape (nc, nq)."""
    a = system.arrays
    values = np.array(instance.evaluate(q.tolist(), [0.0] * system.nq)["jacobian"])
    return sparse.csr_matrix((values, a["row_col"], a["row_ptr"]), (len(a["row_const"]), system.nq)).toarray()


def _balance_forces(system: System, rows: list[int]) -> sparse.csr_matrix:
    """Matrix from open forces to multipliers of the rows of ports, by coordinates with the fewest of these rows."""
    a = system.arrays
    values = sparse.csr_matrix((a["row_lin"], a["row_col"], a["row_ptr"]), (len(a["row_const"]), system.nq))
    gradients = values[rows].toarray()
    row_counts = np.maximum(np.count_nonzero(gradients, axis=0), 1)
    *_, order = linalg.qr(gradients / row_counts**2, mode="economic", pivoting=True)
    chosen = np.sort(order[: len(rows)])
    inverse = np.linalg.inv(gradients[:, chosen].T)
    inverse[np.abs(inverse) < DROP * np.max(np.abs(inverse))] = 0.0
    balance = np.zeros((len(a["row_const"]), system.nq))
    balance[np.ix_(np.array(rows), chosen)] = inverse
    return sparse.csr_matrix(balance)


def map_followers(systems: list[System]) -> tuple[list[System], list[int]]:
    """Systems of an FMU, with maps if they follow another one and compute its outputs.

    `systems`: Systems by fidelity, with the same sensors.

    Returns
    -------
    list of System
        The Systems; those that follow another one have their maps.
    list of int
        For each System the number of the one that follows it and computes its omitted sensors; -1: none.
    """
    mapped_systems, followers = list(systems), []
    omitted_sensors = [
        [k for k, s in enumerate(system.meta["sensors"]) if not s.get("computed", True)] for system in systems
    ]
    for system, omitted in zip(systems, omitted_sensors, strict=True):
        follower = -1
        for k, candidate in enumerate(mapped_systems):
            if not omitted or set(omitted) & set(omitted_sensors[k]):
                continue
            mapped = with_ports_of(candidate, system)
            if mapped is not None:
                mapped_systems[k], follower = mapped, k
                break
        followers.append(follower)
    return mapped_systems, followers


def _have_same_forces(ported: System, plain: System) -> bool:
    """Whether both have elements of the same types and the same inputs; numbers of elements are in different frames."""
    types = all(np.array_equal(ported.arrays[n], plain.arrays[n]) for n in ("el_type", "el_int", "el_parameter_ptr"))
    inputs = [[entry["name"] for entry in system.meta["inputs"]] for system in (ported, plain)]
    return types and inputs[0] == inputs[1]


def _shared_coordinates(frames: Frames) -> list[int]:
    """Full coordinates of rigid bodies, point masses, angles and spins, without ports."""
    size = frames.dimension * (frames.dimension + 1) if frames.dimension == 3 else 4
    rigid = [i for start in frames.bodies for i in range(start, start + size)]
    rigid_set = set(rigid)
    points = [i + k for i in frames.points if i not in rigid_set for k in range(frames.dimension)]
    return [*rigid, *points, *frames.scalars]


def _port_rows(system: System) -> tuple[list[int], Array, Array]:
    """Numbers of the rows of the ports, their matrix and their constants, scaled to a largest coefficient of 1."""
    a = system.arrays
    rows: list[int] = []
    for kind, first, last in zip(a["sen_type"], a["sen_int_ptr"], a["sen_int_ptr"][1:], strict=False):
        if kind == SensorType.QUASI_STATIC:
            rows += [int(r) for r in a["sen_int"][first + 13 : last] if r not in rows]
    linear, constants = np.zeros((len(rows), system.nq)), np.zeros(len(rows))
    for k, row in enumerate(rows):
        first, last = a["row_ptr"][row], a["row_ptr"][row + 1]
        size = np.max(np.abs(a["row_lin"][first:last]))
        linear[k, a["row_col"][first:last]] = a["row_lin"][first:last] / size
        constants[k] = a["row_const"][row] / size
    return rows, linear, constants


def _mass(system: System) -> sparse.csr_matrix:
    a = system.arrays
    return sparse.csr_matrix((a["mass_val"], a["mass_col"], a["mass_ptr"]), shape=(system.nq, system.nq))
