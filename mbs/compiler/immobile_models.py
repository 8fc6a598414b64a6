"""Checks of models whose joints allow no motion, or not the motion that a drive prescribes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.compiler.dependent_rows import DEPENDENT
from mbs.compiler.polynomial import RowTerms
from mbs.compiler.structure import rank_at
from mbs.model.model import Model

Array = NDArray[np.float64]

MAX_OPEN_RATE = 1e-6
"""Largest error of a rate that may remain, parts of the largest prescribed rate."""


def locked_gears(model: Model) -> str:
    """A sentence on gears that form a ring with contradicting ratios; empty if there are none.

    Raises
    ------
    ModelError
        One of the wheels that are tied to the ring has a rate to start with.
    """
    gears: dict[int, list[tuple[int, float, str]]] = {}
    for joint in model.joints:
        if joint.couples is not None:
            first, second, ratio = joint.couples
            gears.setdefault(first, []).append((second, 1.0 / ratio, joint.name))
            gears.setdefault(second, []).append((first, ratio, joint.name))
    turns: dict[int, float] = {}  # turns of each wheel for one turn of the first wheel that is connected to it
    path: dict[int, set[str]] = {}  # gears between these two wheels
    for start in gears:
        if start in turns:
            continue
        turns[start], path[start], connected, message = 1.0, set(), [start], ""
        for wheel in connected:
            for other, ratio, name in gears[wheel]:
                turn = ratio * turns[wheel]
                if other not in turns:
                    turns[other], path[other] = turn, path[wheel] | {name}
                    connected.append(other)
                elif not message and abs(turn - turns[other]) > DEPENDENT * abs(turns[other]):
                    names = ", ".join(f"'{gear}'" for gear in sorted((path[wheel] ^ path[other]) | {name}))
                    message = (
                        f"The gears {names} form a ring that is locked: '{model.coordinates[other].name}' would have "
                        f"to turn {turn / turns[other]:g} times as far as along the other path of the ring, so none of "
                        "their wheels turns; check the ratios and their signs."
                    )
        if message and any(wheel in model.coordinate_rates for wheel in connected):
            raise ModelError(message)
        if message:
            return message
    return ""


def locked_parts(
    model: Model,
    full: Sequence[Affine],
    new: NDArray[np.int64],
    rows: Sequence[RowTerms],
    Phiq: sparse.csr_matrix,
    mass_diagonal: Array,
) -> str:
    """A sentence on parts that joints hold while others can move; empty if there are none.

    Parts that rows connect are tested together: at a dead centre one of them has no rate, but not all. Rows of drives,
    with switches and on velocities lock nothing. `full`: full coordinates as expressions in z; `new`: columns of z in
    `Phiq`.
    """
    permanent = [i for i, row in enumerate(rows) if row.switch < 0 and not row.guides and not row.rates]
    jacobian = Phiq[permanent].tocsr()
    # with structural zeros
    ties = [jacobian.indices[jacobian.indptr[i] : jacobian.indptr[i + 1]] for i in range(len(permanent))]
    owner = {i: body.name for body in model.bodies for i in range(body.start, body.start + body.size)}
    columns_by_name: dict[str, set[int]] = {}
    for i, expression in enumerate(full):
        name = owner.get(i, model.coordinates[i].name)
        columns_by_name.setdefault(name, set()).update(int(new[k]) for k in expression.terms)
    ties += [np.array(sorted(columns), dtype=jacobian.indices.dtype) for columns in columns_by_name.values()]
    pattern = np.ones(sum(map(len, ties))), np.concatenate([*ties, []]), np.cumsum([0, *map(len, ties)])
    incidence = sparse.csr_matrix(pattern, shape=(len(ties), jacobian.shape[1]))
    count, group = connected_components(incidence.T @ incidence, directed=False)
    locked = []
    for number in range(count):
        columns = np.flatnonzero(group == number)
        inner_rows = np.flatnonzero(np.diff(jacobian[:, columns].indptr))
        is_massless = not mass_diagonal[columns].any()  # a measured angle
        if (
            is_massless
            or len(inner_rows) < len(columns)
            or rank_at(jacobian[inner_rows][:, columns], mass_diagonal[columns]) != len(columns)
        ):
            continue
        locked.append([name for name, indices in columns_by_name.items() if indices and group[min(indices)] == number])
    if not locked or len(locked) == count:
        return ""
    names = ", ".join(f"'{name}'" for group_names in locked for name in group_names)
    return f"Parts that cannot move, as their joints leave them no freedom: {names}."


def check_motion(
    model: Model, rows: Sequence[RowTerms], Phiq: sparse.csr_matrix, phi_t: Array, qd: Array, mass_diagonal: Array
) -> None:
    """Raise `ModelError` for a model with drives or initial velocities that its joints do not allow.

    A structure without these is valid: it has joint forces, and reports say that it does not move. Rows with switches
    do not count.
    """
    nq = Phiq.shape[1]
    permanent = [i for i, row in enumerate(rows) if row.switch < 0]
    scleronomic = [i for i in permanent if not rows[i].guides]
    is_driven = len(scleronomic) < len(permanent) or bool(model.body_velocities or model.coordinate_rates)
    if is_driven and len(scleronomic) >= nq and rank_at(Phiq[scleronomic], mass_diagonal) == nq:
        raise ModelError(
            f"The model '{model.name}' is locked: its joints are {nq} independent conditions on {nq} coordinates, "
            "which leaves no motion; check the axes of its joints, or let a body bend."
        )
    size = np.sqrt(np.asarray(Phiq.multiply(Phiq).sum(axis=1)).ravel())
    open_rates = np.abs(Phiq @ qd + phi_t) / size
    prescribed = np.max(np.abs(phi_t) / size, initial=0.0)
    if np.max(open_rates, initial=0.0) > MAX_OPEN_RATE * prescribed > 0.0:
        drives = ", ".join(sorted({f"'{row.name}'" for row, rate in zip(rows, phi_t, strict=True) if rate != 0.0}))
        worst = rows[int(np.argmax(open_rates))].name
        raise ModelError(
            f"The model '{model.name}' cannot start as {drives} asks: no velocity satisfies its joints; '{worst}' "
            f"stays open by {np.max(open_rates):.3g} m/s. Check the drives, the axes of the joints, or let a body bend."
        )
