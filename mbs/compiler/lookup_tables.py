"""Lookup-table bodies and numbers: dependent coordinates, numbered after the coordinates, and `tabled_` arrays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.compiler.front_arrays import Locate
from mbs.compiler.polynomial import RowTerms
from mbs.model.model import Model
from mbs.model.table_bodies import LookupTableBody, LookupTableNumber

NO_FRAME = [-1] * 12


@dataclass(frozen=True)
class Dependents:
    """Natural coordinates as expressions in the coordinates z of the System and in the dependents.

    Dependents are the coordinates that lookup tables give; they are numbered after z.
    """

    remaining: list[int]
    """Natural coordinates that form z."""
    full: list[Affine]
    """As in `reduce_coordinates`, with dependents as constants, at their drawn values."""
    of_z: list[Affine]
    """As in `reduce_coordinates`, zero for dependents."""
    with_dependents: list[Affine]
    """As `full`, with dependents as coordinates after z: for signals."""
    remaining_equations: list[RowTerms]
    """Linear equations that the elimination has not removed, as rows over z."""


def lookup_coordinates(model: Model) -> list[int]:
    """Natural coordinates that tables give, in the order of dependents."""
    return [i for t in model.lookup_tables for i in _dependents(t)]


def base_coordinates(model: Model) -> set[int]:
    """Natural coordinates that tables depend on, of base bodies and parameters: they are never eliminated."""
    bases = {i for b in model.bodies if b.is_base for i in range(b.start, b.start + b.size)}
    return bases | {c.index for t in model.lookup_tables for c in t.parameters}


def carried_mass(model: Model) -> NDArray[np.float64]:
    """Diagonal mass that lookup-table bodies, as drawn, add to the coordinates of their bases, shape (n_full,)."""
    mass = np.zeros(len(model.coordinates))
    for t in model.lookup_tables:
        if isinstance(t, LookupTableBody) and not t.base.is_ground:
            arm, moment = t.com - t.base.com, t.first_moment
            second = np.diag(t.second_moment) + 2.0 * arm * moment + t.mass * arm**2
            mass[t.base.start : t.base.start + 12] += np.repeat([t.mass, *second], 3)
    return mass


def separate_dependents(
    model: Model, remaining: list[int], full: list[Affine], of_z: list[Affine], remaining_equations: list[RowTerms]
) -> Dependents:
    """Remove the dependents from z and number them after it; arguments as in `reduce_coordinates`."""
    dependent = {i: d for d, i in enumerate(lookup_coordinates(model))}
    if not dependent:
        return Dependents(remaining, full, of_z, full, remaining_equations)
    z = [i for i in remaining if i not in dependent]
    index_in_z = {i: k for k, i in enumerate(z)}
    new_index = [index_in_z[i] if i in index_in_z else len(z) + dependent[i] for i in remaining]

    def renumber(e: Affine) -> Affine:
        return Affine({new_index[j]: c for j, c in e.terms.items()}, e.constant)

    with_dependents = [renumber(e) for e in full]
    drawn = [Affine({}, c.reference) if i in dependent else with_dependents[i] for i, c in enumerate(model.coordinates)]
    without_dependents = [Affine() if i in dependent else renumber(e) for i, e in enumerate(of_z)]
    number_of = {-1: -1} | dict(enumerate(new_index))
    rows = [
        replace(r, main={(number_of[i], number_of[j]): v for (i, j), v in r.main.items()}) for r in remaining_equations
    ]
    return Dependents(z, drawn, without_dependents, with_dependents, rows)


def joint_error(name: str) -> ModelError:
    """Error for a joint on a lookup-table body."""
    return ModelError(f"The joint '{name}' is on a lookup-table body, which accepts forces and sensors but no joints.")


def dependent_columns(model: Model, with_dependents: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z that each dependent depends on."""
    return [_table_coordinates(t, with_dependents) for t in model.lookup_tables for _ in _dependents(t)]


def lookup_cliques(model: Model, with_dependents: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z (before ordering) that each table couples in the tangent."""
    return [sorted(_table_coordinates(t, with_dependents)) for t in model.lookup_tables]


def expand_columns(columns: Sequence[int], dependent_columns: Sequence[Sequence[int]], nz: int) -> list[int]:
    """Coordinates of z on which columns depend; number `nz` and higher are dependents, columns `dependent_columns`."""
    return sorted({j for c in columns for j in (dependent_columns[c - nz] if c >= nz else [c])})


def locator_with_dependents(locate: Locate, dependent_columns: Sequence[Sequence[int]], nz: int) -> Locate:
    """A locator that accepts dependents, which have local index 0."""

    def locate_expanded(columns: Sequence[int]) -> tuple[int, list[int]]:
        if all(c < nz for c in columns):
            return locate(columns)
        expanded = expand_columns(columns, dependent_columns, nz)
        front, local = locate(expanded)
        local_index = dict(zip(expanded, local, strict=True))
        return front, [local_index.get(c, 0) if c < nz else 0 for c in columns]

    return locate_expanded


def lookup_arrays(model: Model, with_dependents: Sequence[Affine], new: NDArray[np.int64]) -> Mapping[str, Any]:
    """The `tabled_` arrays of the System; empty if there are no lookup tables."""
    if not model.lookup_tables:
        return {}
    arrays: dict[str, list[Any]] = {n: [] for n in ("size", "frame", "param", "axis", "coef", "mass", "gravity")}
    for t in model.lookup_tables:
        c = t.table.coefficients
        arrays["size"] += [c.shape[2], c.shape[0], c.shape[1]]
        has_base = isinstance(t, LookupTableBody) and not t.base.is_ground
        columns = [int(new[j]) for j in _table_coordinates(t, with_dependents)]
        arrays["frame"] += columns[:12] if has_base else NO_FRAME
        arrays["param"] += [*columns[12 * has_base :], -1][:2]
        for axis in (*t.table.axes, np.array([0.0, 1.0]))[:2]:
            arrays["axis"] += [float(axis[0]), float(axis[1] - axis[0])]
        arrays["coef"].append(c.ravel())
        arrays["mass"] += _moments(t)
        arrays["gravity"] += list(model.gravity)
    return {f"tabled_{n}": np.concatenate(v) if n == "coef" else v for n, v in arrays.items()}


def _moments(t: LookupTableBody | LookupTableNumber) -> list[float]:
    """Mass, first moments and second moments xx, yy, zz, yz, zx, xy of a body; zeros for a number."""
    if isinstance(t, LookupTableNumber):
        return [0.0] * 10
    J = t.second_moment
    return [t.mass, *t.first_moment, J[0, 0], J[1, 1], J[2, 2], J[1, 2], J[2, 0], J[0, 1]]


def _dependents(t: LookupTableBody | LookupTableNumber) -> range:
    """Range of the natural coordinates that a table determines."""
    return range(t.start, t.start + 12) if isinstance(t, LookupTableBody) else range(t.index, t.index + 1)


def _table_coordinates(t: LookupTableBody | LookupTableNumber, with_dependents: Sequence[Affine]) -> list[int]:
    """Coordinates of z of the base of a table, then of its parameters; none of them is eliminated."""
    base = t.base if isinstance(t, LookupTableBody) else None
    frame = [] if base is None or base.is_ground else list(range(base.start, base.start + 12))
    return [next(iter(with_dependents[i].terms)) for i in (*frame, *(c.index for c in t.parameters))]
