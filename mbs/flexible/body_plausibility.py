"""Plausibility of a flexible body: mass, size and frequencies, and mistakes in units that would explain odd values."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import eigh, null_space
from scipy.spatial import ConvexHull

from ali3.plausibility import Mistake, Plausibility, Value, plausibility_of, quantities_of
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.mass_points import rigid_motions
from mbs.flexible.reduced_body import ReducedBody

RIGID = 6
SLIM = 0.05
"""Least ratio of the smallest to the largest side at which the volume of the convex hull is used."""
QUANTITIES = quantities_of("flexible")


class FlexibleWarning(UserWarning):
    """A flexible body that is unlikely; the message names a mistake in units that would explain it."""


class Units(NamedTuple):
    """Factors from the numbers of a file to SI units."""

    length: float = 1.0
    mass: float = 1.0
    stiffness: float = 1.0


UNIT_MISTAKES = (
    ("t, mm and N instead of kg, m and N", Units(1e-3, 1e3, 1e3)),
    ("g instead of kg in the mass", Units(mass=1e-3)),
    ("t instead of kg in the mass", Units(mass=1e3)),
    ("mm instead of m in the places of the nodes", Units(length=1e-3)),
    ("kg, mm and N instead of kg, m and N", Units(1e-3, 1.0, 1e3)),
    ("kg, mm and ms instead of kg, m and s", Units(1e-3, 1.0, 1e6)),
    ("g, mm and ms instead of kg, m and s", Units(1e-3, 1e-3, 1e3)),
    ("pounds instead of kg in the mass", Units(mass=0.45359237)),
)
"""Mistakes in units, the most common first. Consistent units change no frequency."""


@plausibility_of.register
def model_plausibility(
    model: FiniteElementModel, label: str = "", modes: bool = True, beside: float = 0.0, held: ArrayLike = ()
) -> list[Plausibility]:
    """Quantities of a finite-element model with their usual ranges.

    `label`: file name for messages; `modes`: whether frequencies are computed; `beside`: mass that belongs to the body
    and is not in the model, kg; `held`: degrees of freedom of its interfaces.
    """
    x, masses = model.positions, model.mass.masses
    free = _frequency_of_model(model, RIGID) if modes else None
    supported = _frequency_of_model(model, 0, held) if modes and np.size(held) else None
    moment, hull = masses @ model.mass.positions, _hull(x)
    values = partial(_values, x, hull, masses, moment, free, supported, model.given, beside)
    return [_plausibility(label, values, alone=not modes)]


@plausibility_of.register
def reduced_plausibility(body: ReducedBody) -> list[Plausibility]:
    """Quantities of a reduced body with their usual ranges; positions are from its reference node."""
    x, moment = body.node_positions, body.masses @ body.mass_positions
    values = partial(
        _values, x, _hull(x), body.masses, moment, _free_frequency(body), _supported_frequency(body), {}, 0.0
    )
    return [_plausibility("", values)]


def _plausibility(label: str, values: partial[list[Value]], alone: bool = False) -> Plausibility:
    """Plausibility with the mistakes of `UNIT_MISTAKES`. `alone`: only mistakes in one of nodes, mass and stiffness."""
    mistakes_with_keys = [(text, frozenset(_affected_keys(units)), units) for text, units in UNIT_MISTAKES]
    mistakes = [
        Mistake(text, keys, partial(values, units))
        for text, keys, units in mistakes_with_keys
        if not alone or len(keys) == 1
    ]
    return Plausibility(label, values(Units()), mistakes)


def _affected_keys(units: Units) -> Iterator[str]:
    """Keys of the data that a mistake in units changes."""
    for key, factor, unit_factor in zip(("nodes", "mass", "stiffness"), units, Units(), strict=True):
        if factor != unit_factor:
            yield key


def _values(
    x: np.ndarray,
    hull: float,
    masses: np.ndarray,
    moment: np.ndarray,
    free: float | None,
    supported: float | None,
    faults: Mapping[str, Mapping[str, float]],
    beside: float,
    units: Units,
) -> list[Value]:
    """Values of all quantities with the data in `units`; lengths and frequencies as in the file."""
    total, sides = units.mass * float(masses.sum()), units.length * np.ptp(x, axis=0)
    size, centre = float(sides.max()), units.length * moment / max(float(masses.sum()), np.finfo(float).tiny)
    mass, nodes = {"mass": total}, {"nodes": f"{len(x)} within {_size_text(sides)} m"}
    values = [Value(QUANTITIES["mass"], total, mass), Value(QUANTITIES["size"], size, nodes)]
    for name, components in (("extent", sides), ("centre", np.round(centre, 9) + 0.0)):
        values += [Value(QUANTITIES[name], float(v), nodes, axis) for axis, v in zip("xyz", components, strict=True)]
    volume = units.length**3 * hull
    if volume > 0.0:
        values.append(Value(QUANTITIES["dense"], total / volume, mass | nodes))
    if beside:
        values.append(Value(QUANTITIES["beside"], total / beside, mass | {"mass beside it": beside}))
    frequency_factor = float(np.sqrt(units.stiffness / units.mass))
    if free is not None:
        keys: dict[str, Any] = (
            {"stiffness": f"a first free frequency of {frequency_factor * free:.4g} Hz"} | mass | nodes
        )
        wave_speed = 2.0 * size * frequency_factor * free
        values += [
            Value(QUANTITIES["free"], frequency_factor * free, keys),
            Value(QUANTITIES["wave"], wave_speed, keys),
        ]
        if volume > 0.0 and total > 0.0:
            values.append(Value(QUANTITIES["stiff"], wave_speed**2 * volume / total, keys))
    if supported is not None:
        values.append(Value(QUANTITIES["supported"], frequency_factor * supported))
    for quantity, by_matrix in faults.items():
        values += [Value(QUANTITIES[quantity], float(v), {}, name) for name, v in by_matrix.items()]
    return values


def _size_text(sides: np.ndarray) -> str:
    return " x ".join(f"{side:.4g}" for side in sides)


def _hull(x: np.ndarray) -> float:
    """Volume of the convex hull of points (n, 3), m3; 0 for a flat or slim body, see `SLIM`."""
    centred = x - x.mean(axis=0)
    sides = np.ptp(centred @ np.linalg.svd(centred.T @ centred)[0], axis=0)
    return float(ConvexHull(x).volume) if sides.min() > SLIM * sides.max() else 0.0


def _frequency_of_model(model: FiniteElementModel, number: int, held: ArrayLike = ()) -> float | None:
    """Natural frequency by its number from 0, Hz; None if the modes cannot be computed."""
    try:
        return float(natural_modes(model, number + 1, held)[0][-1])
    except ModelError:
        return None


def _free_frequency(body: ReducedBody) -> float | None:
    """First elastic frequency of a free reduced body, Hz."""
    points, modes = len(body.masses), body.n_modes
    shapes = np.concatenate([rigid_motions(body.mass_positions), body.mass_shapes], axis=2).reshape(3 * points, -1)
    M = shapes.T @ (np.repeat(body.masses, 3)[:, None] * shapes)
    K = np.zeros((RIGID + modes, RIGID + modes))
    K[RIGID:, RIGID:] = body.K
    return _frequency(K, M, RIGID)


def _supported_frequency(body: ReducedBody) -> float | None:
    """First frequency with all interfaces held, Hz; None if no mode is left."""
    rows = [body.node_translations[i.node] for i in body.interfaces.values()]
    rows += [body.node_rotations[i.node] for i in body.interfaces.values() if i.rotation is not None]
    Z = null_space(np.vstack(rows)) if rows else np.eye(body.n_modes)
    return _frequency(Z.T @ body.K @ Z, Z.T @ body.M @ Z, 0) if Z.shape[1] else None


def _frequency(K: np.ndarray, M: np.ndarray, number: int) -> float | None:
    """Frequency by its number from 0, Hz; None if it cannot be computed."""
    try:
        squares = eigh(K, M, eigvals_only=True)
    except np.linalg.LinAlgError:
        return None
    return float(np.sqrt(max(squares[number], 0.0)) / (2 * np.pi)) if number < len(squares) else None
