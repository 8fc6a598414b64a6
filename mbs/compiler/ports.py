"""A model with ports beside the same model without them: the coordinates of the one by those of the other."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.frames import Frames
from mbs.kernel.header.enumerations import SensorType
from mbs.system.system import System

Array = NDArray[np.float64]

CLOSED = 1e-9
"""Largest difference, of coordinates in m and relative of masses, at which both are one model."""
DROP = 1e-13


def with_ports_of(ported: System, without: System) -> System | None:
    """The System with ports that can follow a run of the one without them (`ali3_ports_follow`).

    Its rows of ports are linear, and all other full coordinates are the same in both, so its coordinates are affine
    functions of those of the other.

    `ported`: with quasi-static outputs, whose rows are those of the ports; `without`: of the same model without ports.
    Result: with the arrays ``ported_``; None where the two are not one model, or were read from files and so do not
    know their full coordinates.
    """
    one, other = ported.frames, without.frames
    if one is None or other is None or one.flexible or other.flexible or not _same_forces(ported, without):
        return None
    ports, constants = _port_rows(ported)
    mine, theirs = _shared(one), _shared(other)
    if not len(constants) or len(mine) != len(theirs):
        return None
    known = np.vstack([one.T[mine].toarray(), ports])
    right = np.vstack([other.T[theirs].toarray(), np.zeros((len(ports), without.nq))])
    offset = np.concatenate([other.constant[theirs] - one.constant[mine], -constants])
    T, _, rank, _ = np.linalg.lstsq(known, np.column_stack([right, offset]), rcond=None)
    if rank < ported.nq or np.max(np.abs(known @ T - np.column_stack([right, offset]))) > CLOSED:
        return None
    T[np.abs(T) < DROP * np.max(np.abs(T))] = 0.0
    columns = sparse.csc_matrix(T[:, :-1])
    difference = (columns.T @ _mass(ported) @ columns - _mass(without)).toarray()
    if np.max(np.abs(difference)) > CLOSED * _mass(without).max():
        return None
    arrays = {
        "ported_ptr": columns.indptr,
        "ported_row": columns.indices,
        "ported_val": columns.data,
        "ported_const": T[:, -1],
    }
    return ported.with_arrays(arrays)


def following(systems: list[System]) -> tuple[list[System], list[int]]:
    """Systems of an FMU, each with ports where another needs it for its outputs.

    `systems`: by fidelity, with the same sensors.

    Returns
    -------
    list of System
        The same, those that follow another with their map.
    list of int
        Per System the number of the one that follows it, and computes what it leaves out; -1: none.
    """
    found, followers = list(systems), []
    left_out = [[k for k, s in enumerate(system.meta["sensors"]) if not s.get("computed", True)] for system in systems]
    for system, missing in zip(systems, left_out, strict=True):
        follower = -1
        for k, other in enumerate(found):
            if not missing or set(missing) & set(left_out[k]):
                continue
            mapped = with_ports_of(other, system)
            if mapped is not None:
                found[k], follower = mapped, k
                break
        followers.append(follower)
    return found, followers


def _same_forces(ported: System, without: System) -> bool:
    """Whether both have elements of the same types and the same inputs; their points are given in other frames."""
    types = all(np.array_equal(ported.arrays[n], without.arrays[n]) for n in ("el_type", "el_int", "el_real_ptr"))
    inputs = [[entry["name"] for entry in system.meta["inputs"]] for system in (ported, without)]
    return types and inputs[0] == inputs[1]


def _shared(frames: Frames) -> list[int]:
    """Full coordinates of rigid bodies, of particles, angles and spins: all but those of ports, free vectors."""
    size = frames.dimension * (frames.dimension + 1) if frames.dimension == 3 else 4
    rigid = [i for start in frames.bodies for i in range(start, start + size)]
    own = set(rigid)
    lone = [i + k for i in frames.points if i not in own for k in range(frames.dimension)]
    return [*rigid, *lone, *frames.scalars]


def _port_rows(system: System) -> tuple[Array, Array]:
    """Rows of the ports, linear in the coordinates, and their constants; of unit size."""
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
    return dense, constants


def _mass(system: System) -> sparse.csr_matrix:
    a = system.arrays
    return sparse.csr_matrix((a["mass_val"], a["mass_col"], a["mass_ptr"]), shape=(system.nq, system.nq))
