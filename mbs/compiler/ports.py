"""Maps from a model without ports to the same model with ports: coordinates and multipliers."""

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
"""Largest difference, of coordinates in m and relative of masses, at which both are one model."""
DROP = 1e-13
_PLACES, _FAR = 3, 0.3  # positions at which gradients of rows are compared, and how far they are from the drawing, m


def with_ports_of(ported: System, without: System) -> System | None:
    """The System with ports that can follow a run of the one without them (`ali3_ports_follow`).

    Its rows of ports are linear, and all other full coordinates are the same in both, so its coordinates are affine
    functions of those of the other. The gradients of its other rows, in the coordinates of the other, are constant sums
    of those of the rows there, so its multipliers follow from those of the other. The forces at the ports balance what
    is then open: so many coordinates as there are rows of ports give them, those that the fewest of these rows touch.

    `ported`: with quasi-static outputs, whose rows are those of the ports; `without`: of the same model without ports.
    Result: with the arrays ``ported_``; None where the two are not one model, or were read from files and so do not
    know their full coordinates.
    """
    ported_frames, plain_frames = ported.frames, without.frames
    if (
        ported_frames is None
        or plain_frames is None
        or ported_frames.flexible
        or plain_frames.flexible
        or not _same_forces(ported, without)
    ):
        return None
    rows, ports, constants = _port_rows(ported)
    ported_indices, plain_indices = _shared(ported_frames), _shared(plain_frames)
    if not len(constants) or len(ported_indices) != len(plain_indices):
        return None
    known_rows = np.vstack([ported_frames.T[ported_indices].toarray(), ports])
    right = np.vstack([plain_frames.T[plain_indices].toarray(), np.zeros((len(ports), without.nq))])
    offset = np.concatenate([plain_frames.constant[plain_indices] - ported_frames.constant[ported_indices], -constants])
    T, _, rank, _ = np.linalg.lstsq(known_rows, np.column_stack([right, offset]), rcond=None)
    if rank < ported.nq or np.max(np.abs(known_rows @ T - np.column_stack([right, offset]))) > CLOSED:
        return None
    T[np.abs(T) < DROP * np.max(np.abs(T))] = 0.0
    columns = sparse.csc_matrix(T[:, :-1])
    difference = (columns.T @ _mass(ported) @ columns - _mass(without)).toarray()
    if np.max(np.abs(difference)) > CLOSED * _mass(without).max():
        return None
    shares = _shares(ported, without, columns, T[:, -1])
    if shares is None:
        return None
    balance = _balance(ported, rows)
    arrays = {
        "ported_ptr": columns.indptr,
        "ported_row": columns.indices,
        "ported_val": columns.data,
        "ported_const": T[:, -1],
        "ported_lam_ptr": shares.indptr,
        "ported_lam_row": shares.indices,
        "ported_lam_val": shares.data,
        "ported_force_ptr": balance.indptr,
        "ported_force_col": balance.indices,
        "ported_force_val": balance.data,
    }
    return ported.with_arrays(arrays)


def _shares(ported: System, without: System, T: sparse.csc_matrix, constant: Array) -> sparse.csc_matrix | None:
    """Multipliers of the rows that are no ports by those of the System without ports; None: its rows are others.

    Where rows depend on each other the shares are the smallest ones.
    """
    random = np.random.Generator(np.random.PCG64(0))
    positions = [without.arrays["q0"] + _FAR * random.standard_normal(without.nq) for _ in range(_PLACES + 1)]
    instance_plain, instance_ported = (
        Instance(LoadedSystem(without.kernel_bytes())),
        Instance(LoadedSystem(ported.kernel_bytes())),
    )
    expected = [_gradients(without, instance_plain, q) for q in positions]
    gradients = [_gradients(ported, instance_ported, T @ q + constant) @ T for q in positions]
    multiplier_map, *_ = np.linalg.lstsq(np.hstack(gradients[:-1]).T, np.hstack(expected[:-1]).T, rcond=CLOSED)
    multiplier_map[np.abs(multiplier_map) < CLOSED * np.max(np.abs(multiplier_map))] = 0.0
    gaps = (
        np.max(np.abs(g.T @ multiplier_map - w.T)) / np.max(np.abs(w)) for g, w in zip(gradients, expected, strict=True)
    )
    return sparse.csc_matrix(multiplier_map) if max(gaps) < CLOSED else None


def _gradients(system: System, instance: Instance, q: Array) -> Array:
    """Phi_q of the stored rows, dense."""
    a = system.arrays
    values = np.array(instance.evaluate(q.tolist(), [0.0] * system.nq)["jacobian"])
    return sparse.csr_matrix((values, a["row_col"], a["row_ptr"]), (len(a["row_const"]), system.nq)).toarray()


def _balance(system: System, rows: list[int]) -> sparse.csr_matrix:
    """Multipliers of the rows of ports by open forces on the coordinates that the fewest of them touch; row by row."""
    a = system.arrays
    values = sparse.csr_matrix((a["row_lin"], a["row_col"], a["row_ptr"]), (len(a["row_const"]), system.nq))
    gradients = values[rows].toarray()
    touched = np.maximum(np.count_nonzero(gradients, axis=0), 1)
    *_, order = linalg.qr(gradients / touched**2, mode="economic", pivoting=True)
    chosen = np.sort(order[: len(rows)])
    inverse = np.linalg.inv(gradients[:, chosen].T)
    inverse[np.abs(inverse) < DROP * np.max(np.abs(inverse))] = 0.0
    balance = np.zeros((len(a["row_const"]), system.nq))
    balance[np.ix_(np.array(rows), chosen)] = inverse
    return sparse.csr_matrix(balance)


def following(systems: list[System]) -> tuple[list[System], list[int]]:
    """Systems of an FMU, each with ports where another needs it for its outputs.

    `systems`: by fidelity, with the same sensors.

    Returns
    -------
    list of System
        The Systems; those that follow another one with their map.
    list of int
        For each System the number of the one that follows it and computes its omitted sensors; -1: none.
    """
    mapped_systems, followers = list(systems), []
    left_out = [[k for k, s in enumerate(system.meta["sensors"]) if not s.get("computed", True)] for system in systems]
    for system, omitted in zip(systems, left_out, strict=True):
        follower = -1
        for k, candidate in enumerate(mapped_systems):
            if not omitted or set(omitted) & set(left_out[k]):
                continue
            mapped = with_ports_of(candidate, system)
            if mapped is not None:
                mapped_systems[k], follower = mapped, k
                break
        followers.append(follower)
    return mapped_systems, followers


def _same_forces(ported: System, without: System) -> bool:
    """Whether both have elements of the same types and the same inputs; their points are given in other frames."""
    types = all(np.array_equal(ported.arrays[n], without.arrays[n]) for n in ("el_type", "el_int", "el_real_ptr"))
    inputs = [[entry["name"] for entry in system.meta["inputs"]] for system in (ported, without)]
    return types and inputs[0] == inputs[1]


def _shared(frames: Frames) -> list[int]:
    """Full coordinates of rigid bodies, of particles, angles and spins: all but those of ports, free vectors."""
    size = frames.dimension * (frames.dimension + 1) if frames.dimension == 3 else 4
    rigid = [i for start in frames.bodies for i in range(start, start + size)]
    rigid_set = set(rigid)
    lone = [i + k for i in frames.points if i not in rigid_set for k in range(frames.dimension)]
    return [*rigid, *lone, *frames.scalars]


def _port_rows(system: System) -> tuple[list[int], Array, Array]:
    """Numbers of the rows of the ports; these, linear in the coordinates, and their constants; of unit size."""
    a = system.arrays
    rows: list[int] = []
    for kind, first, last in zip(a["sen_type"], a["sen_int_ptr"], a["sen_int_ptr"][1:], strict=False):
        if kind == SensorType.QUASI_STATIC:
            rows += [int(r) for r in a["sen_int"][first + 13 : last] if r not in rows]
    dense, constants = np.zeros((len(rows), system.nq)), np.zeros(len(rows))
    for k, row in enumerate(rows):
        first, last = a["row_ptr"][row], a["row_ptr"][row + 1]
        size = np.max(np.abs(a["row_lin"][first:last]))
        dense[k, a["row_col"][first:last]] = a["row_lin"][first:last] / size
        constants[k] = a["row_const"][row] / size
    return rows, dense, constants


def _mass(system: System) -> sparse.csr_matrix:
    a = system.arrays
    return sparse.csr_matrix((a["mass_val"], a["mass_col"], a["mass_ptr"]), shape=(system.nq, system.nq))
