"""Consistent start: position and velocity of z from the drawing and the declared velocities."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import spsolve

from mbs.common.affine import Affine
from mbs.compiler.consistent_start import start_velocity
from mbs.compiler.full_coordinates import full_mass, symmetric
from mbs.compiler.natural_coordinates import NaturalCoordinates
from mbs.compiler.pose import full_values
from mbs.compiler.row_arrays import RowArrays
from mbs.compiler.start_velocities import LEAST_WEIGHT, GivenVelocity, contradiction, given_velocities, raised_weight
from mbs.kernel.header.enumerations import DrivingFunctionType
from mbs.model.driving_functions import table_value
from mbs.model.model import Model

Array = NDArray[np.float64]
Index = NDArray[np.int64]

RATE_ARM = 0.1
"""Arm of the mass that weighs a given rate, parts of the model's length, at least 1 m: bodies in motion weigh less."""


def reference_position(
    model: Model,
    natural: NaturalCoordinates,
    remaining: list[int],
    T: sparse.csr_matrix,
    z0: Array,
    M_full: sparse.csr_matrix,
) -> Array:
    """z of the reference configuration; if the drawing does not close, the nearest z in the metric of the mass."""
    reference = np.array([c.reference for c in model.coordinates])
    z = np.array([natural.info[i].reference for i in remaining])
    if np.max(np.abs(T @ z + z0 - reference)) > 1e-9:
        M = M_full + sparse.diags(np.where(M_full.diagonal() > 0.0, 0.0, 1.0))
        z = spsolve((T.T @ M @ T).tocsc(), T.T @ (M @ (reference - z0)))
    return np.atleast_1d(z)


def driving_start(model: Model) -> tuple[Array, Array]:
    """Value and rate of the driving functions at time zero."""
    values = np.array([g.start for g in model.guides], dtype=float)
    rates = np.zeros(len(model.guides))
    for g in model.guides:
        if g.type == DrivingFunctionType.OF_TIME:
            n = int(g.reals[0])
            breaks, c = np.array(g.reals[1 : n + 2]), np.array(g.reals[n + 2 :]).reshape(n, 6)
            if breaks[0] <= 0.0 < breaks[-1]:
                k = int(np.searchsorted(breaks, 0.0, side="right")) - 1
                t = -breaks[k]
                rates[g.index] = sum(p * c[k, p] * t ** (p - 1) for p in range(1, 6))
        elif g.type == DrivingFunctionType.BY_TABLE:
            rates[g.index] = table_value(g, values[g.input])[1] * rates[g.input]
    return values, rates


def velocity(
    model: Model,
    full: list[Affine],
    T: sparse.csr_matrix,
    z: Array,
    mass: sparse.csr_matrix,
    stiffness: sparse.csr_matrix,
    order: Index,
    arrays: RowArrays,
    guides: Array,
    driving_rates: Array,
    length: float,
) -> tuple[Array, str]:
    """Start velocity in elimination order, shape (nq,), from the given velocities of bodies and rates of coordinates,
    and a sentence if they contradict each other; `length`: length of the model, m.
    """
    position = full_values(full, z)
    rates = np.zeros(len(full))
    weights, is_partial = {}, False
    least = LEAST_WEIGHT * float(np.mean(mass.diagonal()))
    for k, (linear, angular) in model.body_velocities.items():
        body = model.bodies[k]
        coordinates = slice(body.start, body.start + body.size)
        zeros = np.zeros(model.dimension), np.zeros(1 if model.dimension == 2 else 3)
        v, w = (at_rest if given is None else given for given, at_rest in zip((linear, angular), zeros, strict=True))
        rates[coordinates] = body.velocity(v, w, position[coordinates])
        weights[k] = raised_weight(body, linear is not None, angular is not None or body.is_point, least)
        is_partial = is_partial or (linear is None) != (angular is None)
    M_given = full_mass(model, weights)
    mean = float(np.mean(mass.diagonal())) * max(1.0, RATE_ARM * length) ** 2
    added_mass = np.zeros(len(full))
    for i, rate in model.coordinate_rates.items():
        added_mass[i] = max(mean, model.inertias.get(i, 0.0))
        rates[i] = rate

    def solve(M_given: sparse.csr_matrix, rates: Array, is_partial: bool) -> Array:
        weighted_mass = symmetric(T.T @ M_given @ T)[order][:, order].tocsr()
        given_momentum = (T.T @ (M_given @ rates))[order]
        free_momentum = (T.T @ (full_mass(model) @ rates))[order] if is_partial else None
        return start_velocity(
            arrays, mass, stiffness, weighted_mass, given_momentum, z[order], guides, driving_rates, free_momentum
        )

    def full_rates(v: Array) -> Array:
        of_z = np.empty_like(v)
        of_z[order] = v
        return np.asarray(T @ of_z)

    def solve_alone(g: GivenVelocity) -> Array:
        single_rates = np.zeros(len(full))
        single_rates[g.coordinates] = g.rates
        return full_rates(solve(g.matrix(len(full)), single_rates, False))

    qd = solve(M_given + sparse.diags(added_mass), rates, is_partial)
    return qd, contradiction(model, list(given_velocities(model, position, mean, least)), full_rates(qd), solve_alone)
