"""Compilation of a Model to the arrays of a System, in a chain of steps."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.affine import Affine
from mbs.common.checks import flag, instance_of, mapping
from mbs.common.errors import ModelError
from mbs.compiler.angle_axes import check_angle_axes
from mbs.compiler.armatures import armature_arrays
from mbs.compiler.consistent_start import close_position
from mbs.compiler.dependent_rows import independent_rows
from mbs.compiler.equilibrium import equilibrium, start_arrays
from mbs.compiler.extent import (
    check_distance,
    coordinate_lengths,
    drawn_length,
    length_tolerance_factor,
    model_length,
    unit_vectors,
)
from mbs.compiler.flexible import deformation_metric, flexible_arrays, flexible_cliques, flexible_coordinates
from mbs.compiler.frames import frames_of
from mbs.compiler.front_arrays import front_arrays, locator, mass_positions, row_fronts
from mbs.compiler.fronts import Fronts, build_fronts
from mbs.compiler.full_coordinates import full_gravity, full_mass, reduce_coordinates, symmetric, transformation
from mbs.compiler.immobile_models import check_motion, locked_gears, locked_parts
from mbs.compiler.lookup_tables import (
    Dependents,
    base_coordinates,
    carried_mass,
    dependent_columns,
    expand_columns,
    joint_error,
    locator_with_dependents,
    lookup_arrays,
    lookup_cliques,
    lookup_coordinates,
    separate_dependents,
)
from mbs.compiler.metadata import metadata
from mbs.compiler.natural_coordinates import NaturalCoordinates, natural_coordinates
from mbs.compiler.open_joints import joint_gaps, joints_of_bodies
from mbs.compiler.ordering import clique_pattern, fill_reducing_order
from mbs.compiler.parametric_axes import axis_arrays, axis_cliques, axis_coordinates
from mbs.compiler.parametric_inertias import inertia_arrays, inertia_cliques
from mbs.compiler.payloads import add_entries, payload_arrays, payload_cliques
from mbs.compiler.polynomial import RowTerms, row_terms
from mbs.compiler.pose import pose_arrays, pose_partners
from mbs.compiler.row_arrays import RowArrays
from mbs.compiler.row_scale import row_scale
from mbs.compiler.rows import rigid_rows
from mbs.compiler.start import driving_start, reference_position, velocity
from mbs.compiler.structure import rank_at, structure_report
from mbs.compiler.tables import Signals, channel_arrays, element_arrays, element_cliques, sensor_arrays
from mbs.kernel.header.arrays import ARRAYS
from mbs.model.equation import Equation
from mbs.model.model import Model
from mbs.system.compiled_model import CompiledModel

Array = NDArray[np.float64]
Tables = dict[str, Any]
Corrections = dict[str, tuple[float, float]]
ModeArrays = Callable[
    [Model, Sequence[RowTerms], Sequence[Affine], Array, Array, Signals], tuple[Tables, Callable[[], Tables]]
]
TreeArrays = Callable[[Model, Signals, Sequence[int], NDArray[np.int64]], tuple[Tables, str]]
NO_TREE: Tables = {name: [] for name in ARRAYS if name.startswith("tree_")}
"""Arrays of a System without a tree."""


def check_model(model: Model) -> Model:
    """The model; raises an error unless it is a Model with a body, whose relative angles can turn."""
    instance_of(Model, model, "What compile takes", "a Model")
    if not model.bodies:
        raise ModelError(f"The model '{model.name}' has no bodies.")
    check_angle_axes(model)
    return model


def compiled(
    model: Model,
    corrections: Corrections | None = None,
    *,
    make_modes: ModeArrays | None = None,
    make_tree: TreeArrays | None = None,
) -> CompiledModel:
    """The arrays and metadata of a model, from which `compile` makes the System.

    The optional arguments are needed only for steps and for closed loops.

    Parameters
    ----------
    corrections : dict of str to tuple of float, optional
        Corrections of joints that close the loops of the model, by name, m and rad.
    make_modes : callable, optional
        `mode_arrays`: makes the assembly modes by which steps are checked.
    make_tree : callable, optional
        `tree_arrays`: makes the tree for methods in relative coordinates; without it there is none.
    """
    reduced = _reduce(check_model(model), corrections or {})
    ordered = _order(model, reduced)
    start = _solve_start(model, reduced, ordered)
    tables, no_tree, modes = _make_tables(model, reduced, ordered, start, make_modes, make_tree)
    meta = _make_metadata(model, reduced, ordered, start, corrections or {}, no_tree)
    frames = frames_of(model, ordered.T[:, ordered.fronts.order], ordered.z0)
    if flag(model.start_in_equilibrium, f"The start_in_equilibrium of model '{model.name}'"):
        parameters = mapping(model.equilibrium_parameters, "the equilibrium_parameters of a model", "names to values")
        at_rest = CompiledModel(tables, meta)
        q, y = equilibrium(at_rest, parameters)
        tables.update(start_arrays(at_rest, parameters, y))
        tables.update(q0=q, y0=y, qd0=np.zeros_like(q), **_make_pose(model, reduced, ordered, q))
    return CompiledModel(tables, meta, frames, modes)


@dataclass(frozen=True)
class _Reduced:
    """Coordinates z and rows of a model after the elimination."""

    natural: NaturalCoordinates
    dependents: Dependents
    rows: list[RowTerms]
    counts: Mapping[str, int]
    """Numbers of eliminated equations and rows, for the report."""
    length: float
    """Length of the model, m."""
    size: float
    """Length of the model as drawn, m."""


def _reduce(model: Model, corrections: Corrections) -> _Reduced:
    """Eliminate linear equations, make rows of all others and remove dependent rows."""
    linear, row_equations = _equations(model)
    natural = natural_coordinates(model)
    table_coordinates = {*lookup_coordinates(model)}
    for equation in linear:
        if not table_coordinates.isdisjoint(equation.linear_form().terms):
            raise joint_error(equation.name)
    length, size = model_length(model), drawn_length(model)
    retained = flexible_coordinates(model) | base_coordinates(model)
    natural, remaining, full, of_z, redundant, remaining_equations = reduce_coordinates(
        model, natural, linear, retained, size
    )
    dependents = separate_dependents(model, remaining, full, of_z, remaining_equations)
    error = max((max(distance / size, angle) for distance, angle in corrections.values()), default=0.0)
    candidate_rows = [row_terms(e, j, k, dependents.with_dependents, size, error) for j, k, e in row_equations]
    for row in candidate_rows:
        if row.columns() and row.columns()[-1] >= len(dependents.remaining):
            raise joint_error(row.name)
        switch = model.joints[row.joint].switch
        row.switch = -1 if switch is None else switch.index
    candidate_rows += dependents.remaining_equations
    candidate_rows += [row for body in model.bodies for row in rigid_rows(body, dependents.full, error)]
    check_distance(model, candidate_rows, [natural.info[k].kind for k in dependents.remaining], size)
    rows, dependent = independent_rows(candidate_rows, joints_of_bodies(model), size)
    if not dependents.remaining:
        raise ModelError(f"The model '{model.name}' cannot move: its joints fix every coordinate.")
    counts = {"linear_equations": len(linear), "redundant_equations": redundant, "dependent_rows": dependent}
    return _Reduced(natural, dependents, rows, counts, length, size)


@dataclass(frozen=True)
class _Ordered:
    """Mass and rows in the order of elimination."""

    T: sparse.csr_matrix
    """q_full = T z + z0, z as before ordering."""
    z0: Array
    M_full: sparse.csr_matrix
    mass: sparse.csr_matrix
    fronts: Fronts
    new: NDArray[np.int64]
    """Index of each z in elimination order."""
    arrays: RowArrays
    tangent_nonzeros: int


def _order(model: Model, reduced: _Reduced) -> _Ordered:
    dependents, rows = reduced.dependents, reduced.rows
    T, z0 = transformation(dependents.full, len(dependents.remaining))
    M_full = full_mass(model)
    mass = symmetric(T.T @ M_full @ T)
    fronts, tangent_nonzeros = _factorise_symbolically(model, rows, dependents.full, mass, dependents)
    order = fronts.order
    new = np.argsort(order)
    mass = mass[order][:, order].tocsr()
    mass = add_entries(mass, [new[c].tolist() for c in _parametric_mass_cliques(model, dependents.full)])
    mass.sort_indices()
    return _Ordered(T, z0, M_full, mass, fronts, new, RowArrays(rows, new), tangent_nonzeros)


@dataclass(frozen=True)
class _Start:
    """Assembled position and velocity."""

    q: Array
    qd: Array
    guides: Array
    """Values of the driving functions."""
    active_rows: list[RowTerms]
    """Rows that are switched on."""
    rank: int | None
    """Rank of these rows; None: it could not be computed."""
    contradiction: str
    """Sentence on given velocities that contradict each other, or empty."""
    locked: str
    """Sentence on gears or parts that cannot move, or empty."""


def _solve_start(model: Model, reduced: _Reduced, ordered: _Ordered) -> _Start:
    dependents, rows, new = reduced.dependents, reduced.rows, ordered.new
    T, z0, mass, order = ordered.T, ordered.z0, ordered.mass, ordered.fronts.order
    guides, driving_rates = driving_start(model)
    active_rows = [row for row in rows if row.switch < 0 or model.switches[row.switch].on]
    arrays = ordered.arrays if len(active_rows) == len(rows) else RowArrays(active_rows, new)
    position_rows = [row for row in active_rows if not row.rates]
    position_arrays = arrays if len(position_rows) == len(active_rows) else RowArrays(position_rows, new)
    stiffness = deformation_metric(model, dependents.full, new)
    q_reference = reference_position(model, reduced.natural, dependents.remaining, T, z0, ordered.M_full)[order]
    tolerance_factor = length_tolerance_factor(reduced.size)
    q = close_position(
        position_rows,
        position_arrays,
        mass,
        stiffness,
        q_reference,
        guides,
        lambda q: joint_gaps(model, T @ q[new] + z0),
        tolerance_factor,
    )
    qd, contradiction = velocity(
        model, dependents.full, T, q[new], mass, stiffness, order, arrays, guides, driving_rates, reduced.size
    )
    _, Phiq, phi_t = arrays.evaluate(q, guides, driving_rates)
    check_motion(model, active_rows, Phiq, phi_t, qd, mass.diagonal())
    locked = locked_gears(model) or locked_parts(model, dependents.full, new, active_rows, Phiq, mass.diagonal())
    return _Start(q, qd, guides, active_rows, rank_at(Phiq, mass.diagonal()), contradiction, locked)


def _make_tables(
    model: Model,
    reduced: _Reduced,
    ordered: _Ordered,
    start: _Start,
    make_modes: ModeArrays | None,
    make_tree: TreeArrays | None,
) -> tuple[Tables, str, Callable[[], Tables] | None]:
    """All arrays of the System with its start as drawn, the reason why it has no tree, and a function for modes."""
    dependents, rows, natural = reduced.dependents, reduced.rows, reduced.natural
    remaining, full, of_z = dependents.remaining, dependents.full, dependents.of_z
    with_dependents = dependents.with_dependents
    fronts, new, arrays = ordered.fronts, ordered.new, ordered.arrays
    order, q, guides, nz = fronts.order, start.q, start.guides, len(remaining)
    scales = _scale_rows(model, reduced, ordered, start)
    columns_of_dependents = [[int(new[j]) for j in columns] for columns in dependent_columns(model, with_dependents)]
    columns = np.concatenate([new, np.arange(nz, nz + len(columns_of_dependents))])
    signals = Signals(with_dependents, columns, axis_coordinates(model, with_dependents))
    locate = locator(fronts)
    row_numbers = {(r.joint, r.equation_number): n for n, r in enumerate(rows) if r.joint >= 0}
    tree, no_tree = make_tree(model, signals, remaining, new) if make_tree else ({}, "nobody asked for one")
    triads, modes = make_modes(model, start.active_rows, full, q[new], guides, signals) if make_modes else ({}, None)
    tables: Tables = {
        "q0": q,
        "qd0": start.qd,
        **_mass_arrays(model, ordered),
        **arrays.arrays,
        **scales,
        "row_switch": [row.switch for row in rows],
        "switch_start": [int(s.on) for s in model.switches],
        **row_fronts(arrays, locate),
        **front_arrays(fronts),
        **element_arrays(model, signals, locator_with_dependents(locate, columns_of_dependents, nz)),
        **sensor_arrays(model, signals, row_numbers),
        **channel_arrays(model),
        **payload_arrays(model, signals),
        **armature_arrays(model, full, new),
        **inertia_arrays(model, signals),
        **axis_arrays(model, signals, with_dependents, new),
        **flexible_arrays(model, full, new, locate),
        **lookup_arrays(model, with_dependents, new),
        **_make_pose(model, reduced, ordered, q),
        **NO_TREE,
        **tree,
        **triads,
        **start_arrays(None, {}),
        "pose_partner": pose_partners(model, natural, remaining, of_z, signals, order),
        **signals.arrays(),
    }
    return tables, no_tree, modes


def _scale_rows(model: Model, reduced: _Reduced, ordered: _Ordered, start: _Start) -> Tables:
    """Scale the rows of the arrays; the scales, and the factor on tolerances of lengths unless it is 1."""
    _, Phiq, _ = ordered.arrays.evaluate(start.q, start.guides)
    carried_masses = (ordered.T.multiply(ordered.T).T @ carried_mass(model))[ordered.fronts.order]
    diagonal = np.maximum(ordered.mass.diagonal(), carried_masses)
    if not diagonal.any():
        raise ModelError(f"The model '{model.name}' cannot move: its joints fix every coordinate that has mass.")
    tolerance_factor = length_tolerance_factor(reduced.size)
    scale, measure = row_scale(reduced.rows, Phiq, diagonal, tolerance_factor)
    ordered.arrays.scale(scale)
    fineness = {"fineness": [tolerance_factor]} if tolerance_factor != 1.0 else {}
    return {"row_scale": scale, "row_measure": measure, **fineness}


def _mass_arrays(model: Model, ordered: _Ordered) -> Tables:
    """The constant mass matrix and gravity."""
    mass, gravity = ordered.mass, full_gravity(model)
    return {
        "mass_ptr": mass.indptr,
        "mass_col": mass.indices,
        "mass_val": mass.data,
        "mass_pos": mass_positions(mass, ordered.fronts),
        "gravity_force": (ordered.T.T @ gravity)[ordered.fronts.order],
        "gravity_const": [-gravity @ ordered.z0],
    }


def _make_pose(model: Model, reduced: _Reduced, ordered: _Ordered, q: Array) -> Mapping[str, Any]:
    """The `pose_` arrays at a position."""
    dependents, new = reduced.dependents, ordered.new
    return pose_arrays(model, reduced.natural, dependents.remaining, dependents.of_z, q[new], ordered.fronts.order)


def _make_metadata(
    model: Model, reduced: _Reduced, ordered: _Ordered, start: _Start, corrections: Corrections, no_tree: str
) -> Tables:
    report = {
        **structure_report(model, ordered.fronts, start.rank, len(reduced.rows)),
        **reduced.counts,
        "tangent_nonzeros": ordered.tangent_nonzeros,
        "no_tree": no_tree,
        "locked": start.locked,
        "closed": corrections,
        "length": reduced.length,
        "length_stated": model.length is not None,
        **({"contradiction": start.contradiction} if start.contradiction and not model.start_in_equilibrium else {}),
    }
    coordinates = [reduced.dependents.remaining[k] for k in ordered.fronts.order]
    info = [reduced.natural.info[k] for k in coordinates]
    lengths = coordinate_lengths([c.kind for c in info], unit_vectors(model, coordinates), reduced.length)
    return metadata(model, [c.name for c in info], reduced.rows, report, lengths)


def _equations(model: Model) -> tuple[list[Equation], list[tuple[int, int, Equation]]]:
    """Joint equations to be eliminated, and those that become rows, with numbers of joint and equation."""
    linear, row_equations = [], []
    for j, joint in enumerate(model.joints):
        as_rows = {*(joint.force_equations if joint.as_rows else []), *joint.turning_equations}
        replaced = set(joint.replaced_equations)
        for k, equation in enumerate(joint.equations):
            if k in replaced:
                continue
            if equation.is_linear and k not in as_rows:
                linear.append(equation)
            else:
                row_equations.append((j, k, equation))
    return linear, row_equations


def _parametric_mass_cliques(model: Model, full: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z (before ordering) between which parameters change the mass matrix."""
    return payload_cliques(model, full) + inertia_cliques(model, full) + axis_cliques(model, full)


def _factorise_symbolically(
    model: Model, rows: list[RowTerms], full: list[Affine], mass: sparse.csr_matrix, dependents: Dependents
) -> tuple[Fronts, int]:
    """Elimination order and fronts of the tangent, and the non-zeros of its lower triangle."""
    entries = mass.tocoo()
    cliques: list[list[int]] = [[int(i), int(j)] for i, j in zip(entries.row, entries.col, strict=True) if i > j]
    cliques += [row.columns() for row in rows]
    columns_of_dependents, nz = dependent_columns(model, dependents.with_dependents), mass.shape[0]
    modes = flexible_cliques(model, full)
    cliques += modes + payload_cliques(model, full) + inertia_cliques(model, full)
    cliques += lookup_cliques(model, dependents.with_dependents)

    def pattern_with(reserved: Mapping[int, frozenset[int]]) -> sparse.csc_matrix:
        return clique_pattern(
            nz,
            cliques
            + [
                expand_columns(c, columns_of_dependents, nz)
                for c in element_cliques(model, dependents.with_dependents, reserved)
            ],
        )

    pattern = pattern_with({})
    # columns of modes are contiguous
    late = {c: k for k, columns in enumerate(modes, 1) for c in columns[12:]}
    if not model.written_axes:
        return build_fronts(pattern, fill_reducing_order(pattern), late), (pattern.nnz + nz) // 2
    cliques += axis_cliques(model, full)  # entries for other axes of wheels do not change the order
    padded_pattern = pattern_with(axis_coordinates(model, dependents.with_dependents))
    return build_fronts(padded_pattern, fill_reducing_order(pattern), late), (pattern.nnz + nz) // 2
