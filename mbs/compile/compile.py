"""compile(): from a Model to a System, one chain of steps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.affine import Affine
from mbs.compile.consistent import close_position, start_velocity
from mbs.compile.dependent_rows import independent_rows
from mbs.compile.equilibrium import equilibrium
from mbs.compile.fronts import Fronts, build_fronts
from mbs.compile.full_coordinates import full_gravity, full_mass, lengths, reduce_coordinates, transformation
from mbs.compile.ordering import clique_pattern, fill_reducing_order
from mbs.compile.polynomial import RowTerms, row_terms
from mbs.compile.pose import full_values, pose_arrays
from mbs.compile.report import rank_at
from mbs.compile.row_arrays import RowArrays
from mbs.compile.rows import rigid_rows
from mbs.compile.tables import Signals, channel_arrays, element_arrays, element_cliques, sensor_arrays
from mbs.errors import ModelError
from mbs.model.guides import TIME
from mbs.model.model import Model
from mbs.system import System

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def compile(model: Model) -> System:
    """Compile a model.

    Linear joint equations are eliminated, dependent rows removed, the elimination order and fronts of the tangent
    computed, and the start position and velocity solved.

    Raises
    ------
    ModelError
        If the assembly cannot be closed or the model is not possible; the message names the joints.
    """
    if not model.bodies:
        raise ModelError(f"The model '{model.name}' has no bodies.")
    equations = [(j, k, e) for j, joint in enumerate(model.joints) for k, e in enumerate(joint.equations)]
    stays = [
        not e.is_linear or (model.joints[j].keep and k in model.joints[j].force_equations) for j, k, e in equations
    ]
    linear = [e for (_, _, e), s in zip(equations, stays, strict=True) if not s]
    kept, full, redundant = reduce_coordinates(model, linear)

    candidates = [row_terms(e, j, k, full) for (j, k, e), s in zip(equations, stays, strict=True) if s]
    for body in model.bodies:
        candidates += rigid_rows(body, full)
    rows, dependent = independent_rows(candidates)
    if not kept:
        raise ModelError(f"The model '{model.name}' cannot move: its joints fix every coordinate.")

    T, z0 = transformation(full, len(kept))
    M_full = full_mass(model)
    mass = _symmetric(T.T @ M_full @ T)
    fronts, pattern = _symbolic(model, rows, full, mass)
    order = fronts.order
    new = np.empty(len(order), dtype=np.int64)
    new[order] = np.arange(len(order))
    mass = mass[order][:, order].tocsr()
    mass.sort_indices()
    arrays = RowArrays(rows, new)

    guides, guide_rates = _guide_start(model)
    z_start = _start(model, kept, T, z0, M_full)[order]
    q = close_position(rows, arrays, mass, z_start, guides)
    z = np.empty_like(q)
    z[order] = q
    qd = _velocity(model, kept, full, T, z, mass, order, arrays, guides, guide_rates)

    _, Phiq, _ = arrays.evaluate(q, guides)
    scale, measure = _row_scale(rows, Phiq, mass.diagonal())
    arrays.scale(scale)
    gravity = full_gravity(model)

    signals = Signals(full, new)
    locate = _locator(fronts)
    tables: dict[str, Any] = {
        "q0": q,
        "qd0": qd,
        "mass_ptr": mass.indptr,
        "mass_col": mass.indices,
        "mass_val": mass.data,
        "mass_pos": _mass_positions(mass, fronts),
        "gravity_force": (T.T @ gravity)[order],
        "gravity_const": np.array([-gravity @ z0]),
        **arrays.arrays,
        "row_scale": scale,
        "row_measure": measure,
        **_row_fronts(arrays, locate),
        **_front_arrays(fronts),
        **element_arrays(model, signals, locate),
        **sensor_arrays(model, signals, {(r.joint, r.part): n for n, r in enumerate(rows) if r.joint >= 0}),
        **channel_arrays(model),
        **{
            name: values[order] if len(values) else values for name, values in pose_arrays(model, kept, full, z).items()
        },
    }
    tables.update(signals.arrays())

    rank = rank_at(Phiq, mass.diagonal())
    report = {
        "bodies": len(model.bodies),
        "full_coordinates": len(full),
        "linear_equations": len(linear),
        "redundant_equations": redundant,
        "coordinates": len(kept),
        "rows": len(rows),
        "dependent_rows": dependent,
        "rank": rank,
        "degrees_of_freedom": None if rank is None else len(kept) - rank,
        "tangent_nonzeros": (pattern.nnz + len(kept)) // 2,
        "factor_nonzeros": fronts.factor_nonzeros,
        "fronts": len(fronts.index),
        "largest_front": max(len(i) for i in fronts.index),
        "elements": len(model.elements),
        "inputs": len(model.inputs),
        "sensors": len(model.sensors),
    }
    system = System(tables, _meta(model, kept, order, rows, report))
    if not model.start_in_equilibrium:
        return system
    q = equilibrium(system, model.equilibrium_parameters)
    z[order] = q
    tables.update(q0=q, qd0=np.zeros_like(q))
    tables.update({name: values[order] for name, values in pose_arrays(model, kept, full, z).items() if len(values)})
    return System(tables, system.meta)


def _symmetric(matrix: sparse.csr_matrix) -> sparse.csr_matrix:
    """Exactly symmetric, without round-off entries."""
    m = (0.5 * (matrix + matrix.T)).tocoo()
    diagonal = np.abs(m.tocsr().diagonal())
    big = np.sqrt(np.maximum(diagonal[m.row] * diagonal[m.col], 0.0))
    stay = (np.abs(m.data) > 1e-14 * big) & (m.data != 0.0)
    return sparse.coo_matrix((m.data[stay], (m.row[stay], m.col[stay])), shape=m.shape).tocsr()


def _symbolic(
    model: Model, rows: list[RowTerms], full: list[Affine], mass: sparse.csr_matrix
) -> tuple[Fronts, sparse.csc_matrix]:
    """Pattern of the tangent, its elimination order and fronts."""
    entries = mass.tocoo()
    cliques: list[list[int]] = [[int(i), int(j)] for i, j in zip(entries.row, entries.col, strict=True) if i > j]
    cliques += [row.columns() for row in rows]
    cliques += element_cliques(model, full)
    pattern = clique_pattern(mass.shape[0], cliques)
    return build_fronts(pattern, fill_reducing_order(pattern)), pattern


def _start(model: Model, kept: list[int], T: sparse.csr_matrix, z0: Array, M_full: sparse.csr_matrix) -> Array:
    """z of the reference configuration; where the drawing does not close, the nearest one in the metric of the mass."""
    reference = np.array([c.reference for c in model.coordinates])
    units = lengths(model)
    z = (reference * units)[kept]
    if np.max(np.abs(T @ z + z0 - reference)) > 1e-9:
        M = M_full + sparse.diags(np.where(M_full.diagonal() > 0.0, 0.0, 1.0))
        z = sparse.linalg.spsolve((T.T @ M @ T).tocsc(), T.T @ (M @ (reference - z0)))
    return np.atleast_1d(z)


def _guide_start(model: Model) -> tuple[Array, Array]:
    """Value and rate of the guides at time zero."""
    values = np.array([g.start for g in model.guides], dtype=float)
    rates = np.zeros(len(model.guides))
    for g in model.guides:
        if g.type == TIME:
            n = int(g.reals[0])
            breaks, c = np.array(g.reals[1 : n + 2]), np.array(g.reals[n + 2 :]).reshape(n, 6)
            if breaks[0] <= 0.0 < breaks[-1]:
                k = int(np.searchsorted(breaks, 0.0, side="right")) - 1
                t = -breaks[k]
                rates[g.index] = sum(p * c[k, p] * t ** (p - 1) for p in range(1, 6))
    return values, rates


def _velocity(
    model: Model,
    kept: list[int],
    full: list[Affine],
    T: sparse.csr_matrix,
    z: Array,
    mass: sparse.csr_matrix,
    order: Index,
    arrays: RowArrays,
    guides: Array,
    guide_rates: Array,
) -> Array:
    """Start velocity in elimination order, from the velocities of bodies and coordinates."""
    position = full_values(full, z)
    rates = np.zeros(len(full))
    weights = np.zeros(len(model.bodies))
    for k, (linear, angular) in model.body_velocities.items():
        body = model.bodies[k]
        part = slice(body.start, body.start + body.size)
        rates[part] = body.velocity(linear, angular, position[part])
        weights[k] = 1.0
    M_given = full_mass(model, weights)
    mean = float(np.mean(mass.diagonal()))
    own = np.zeros(len(full))
    for i, rate in model.coordinate_rates.items():
        own[i] = max(mean, model.inertias.get(i, 0.0))
        rates[i] = rate
    M_given = M_given + sparse.diags(own)
    given = _symmetric(T.T @ M_given @ T)[order][:, order].tocsr()
    aim = (T.T @ (M_given @ rates))[order]
    q = z[order]
    return start_velocity(arrays, mass, given, aim, q, guides, guide_rates)


def _row_scale(rows: list[RowTerms], Phiq: sparse.csr_matrix, diagonal: Array) -> tuple[Array, Array]:
    """`row_scale` and `row_measure` of the System file."""
    inverse = np.where(diagonal > 0.0, 1.0 / np.where(diagonal > 0.0, diagonal, 1.0), 0.0)
    squared = Phiq.multiply(Phiq).tocsr()
    by_mass = np.asarray(squared @ inverse).ravel()
    length = np.sqrt(np.asarray(squared.sum(axis=1)).ravel())
    flat = [rows[i] for i in np.flatnonzero(length == 0.0)]
    if flat:
        names = ", ".join(f"'{r.name}' ({r.kind})" for r in flat)
        raise ModelError(
            f"The condition of {names} does not move with any coordinate at the start; change the drawing there."
        )
    # a row over coordinates without mass is scaled as if they had the mean mass
    mean = float(np.mean(diagonal[diagonal > 0.0]))
    by_mass = np.where(by_mass > 0.0, by_mass, length**2 / mean)
    scale = 1.0 / np.sqrt(by_mass)
    return scale, 1.0 / (length * scale)


def _locator(fronts: Fronts) -> Any:
    """A function from columns to (front, local indices)."""
    front_of = np.repeat(np.arange(len(fronts.index)), np.diff(fronts.col))

    def locate(columns: Any) -> tuple[int, list[int]]:
        s = int(front_of[min(columns)])
        local = np.searchsorted(fronts.index[s], columns)
        assert np.array_equal(fronts.index[s][local], columns), "a clique lies outside its front"
        return s, [int(i) for i in local]

    return locate


def _row_fronts(arrays: RowArrays, locate: Any) -> dict[str, Any]:
    fronts, local = [], []
    for columns in arrays.cliques():
        s, places = locate(columns)
        fronts.append(s)
        local += places
    return {"row_front": np.array(fronts, dtype=np.int64), "row_loc": np.array(local, dtype=np.int64)}


def _front_arrays(fronts: Fronts) -> dict[str, Any]:
    sizes = np.array([len(i) for i in fronts.index], dtype=np.int64)
    maps = []
    for s, index in enumerate(fronts.index):
        pivots = int(fronts.col[s + 1] - fronts.col[s])
        rest = index[pivots:]
        maps.append(np.full(pivots, -1))
        if len(rest):
            maps.append(np.searchsorted(fronts.index[fronts.parent[s]], rest))
    return {
        "front_col": fronts.col,
        "front_ptr": np.concatenate([[0], np.cumsum(sizes)]),
        "front_idx": np.concatenate(fronts.index),
        "front_parent": fronts.parent,
        "front_map": np.concatenate(maps),
        "front_off": np.concatenate([[0], np.cumsum(sizes * sizes)]),
    }


def _mass_positions(mass: sparse.csr_matrix, fronts: Fronts) -> Index:
    """Place of each lower-triangle entry in the front storage, -1 above the diagonal."""
    sizes = np.array([len(i) for i in fronts.index], dtype=np.int64)
    offset = np.concatenate([[0], np.cumsum(sizes * sizes)])
    front_of = np.repeat(np.arange(len(fronts.index)), np.diff(fronts.col))
    row = np.repeat(np.arange(mass.shape[0]), np.diff(mass.indptr))
    found = np.full(mass.nnz, -1, dtype=np.int64)
    for n in np.flatnonzero(row >= mass.indices):
        j = int(mass.indices[n])
        s = int(front_of[j])
        i_local = int(np.searchsorted(fronts.index[s], row[n]))
        found[n] = offset[s] + (j - fronts.col[s]) * sizes[s] + i_local
    return found


def _meta(model: Model, kept: list[int], order: Index, rows: list[RowTerms], report: dict[str, Any]) -> dict[str, Any]:
    return {
        "name": model.name,
        "dimension": model.dimension,
        "coordinates": [model.coordinates[kept[k]].name for k in order],
        "rows": [{"name": r.name, "kind": r.kind} for r in rows],
        "inputs": [
            {
                "name": i.name,
                "unit": i.unit,
                "description": i.description,
                "start": i.start,
                "min": i.min if math.isfinite(i.min) else None,
                "max": i.max if math.isfinite(i.max) else None,
            }
            for i in model.inputs
        ],
        "sensors": [{"name": s.name, "unit": s.unit, "description": s.description} for s in model.sensors],
        "parameters": [
            {"name": p.name, "unit": p.unit, "description": p.description, "value": p.value, "min": p.min, "max": p.max}
            for p in model.parameters
        ],
        "elements": [
            {
                "name": e.name,
                "type": e.type.name,
                "outputs": [{"name": o.name, "unit": o.unit, "description": o.description} for o in e.outputs],
            }
            for e in model.elements
        ],
        "guides": [g.name for g in model.guides],
        "report": report,
        "experiment": {"stop_time_s": model.stop_time, "step_s": model.step},
        "floating": model.floating,
    }
