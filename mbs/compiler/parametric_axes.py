"""Wheels whose axes are set by parameters, as the `axis_` arrays of the System, with entries for their signals."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.compiler.polynomial import substitute
from mbs.kernel.header.enumerations import ParameterTarget
from mbs.model.carried_parts import WrittenAxis
from mbs.model.model import Model

ROUND = 1e-12
"""rad, by which a value that a parameter writes may differ from the drawn one in its last bits."""


def axis_room(model: Model, full: Sequence[Affine]) -> dict[int, frozenset[int]]:
    """Coordinates of z, before ordering, that components of the vectors of such wheels may have, by their identity."""
    rooms: dict[int, frozenset[int]] = {}
    for axis in model.written_axes:
        for k in range(3):
            rooms |= dict.fromkeys((id(v.components[k]) for v in axis.vectors), _room(axis, k, full))
    return rooms


def axis_cliques(model: Model, full: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z (before ordering) that a wheel couples in the mass matrix of its carrier."""
    axes = [a for a in model.written_axes if not a.spin.carrier.is_tabled]
    return [sorted(_room(axis, k, full)) for axis in axes for k in range(3)]


def _room(axis: WrittenAxis, k: int, full: Sequence[Affine]) -> frozenset[int]:
    """Coordinates of z that the k-th component of a vector of the carrier may have."""
    return frozenset(j for v in axis.frame for j in substitute(v.components[k], full).terms)


def axis_arrays(model: Model, signals: Any, seen: Sequence[Affine], new: NDArray[np.int64]) -> Mapping[str, Any]:
    """The `axis_` arrays, of `mbs.compiler.tables.Signals` and expressions of z."""
    tables = {id(t): k for k, t in enumerate(model.tabled)}
    axes = model.written_axes

    def numbers(vectors: Iterable[AffineVector]) -> list[int]:
        return [signals.number(c) for v in vectors for c in v.components]

    return {
        "axis_real": _reals(model),
        "axis_vector": np.array([_drawn(a) for a in axes]).ravel(),
        "axis_inertia": [a.spin.diametral_inertia for a in axes],
        "axis_frame": [n for a in axes for n in numbers(a.frame)],
        "axis_signal": [n for a in axes for n in numbers(a.vectors)],
        "axis_spin": [int(new[next(iter(substitute(a.spin.affine, seen).terms))]) for a in axes],
        "axis_rolling": [r for a in axes for r in (a.spin.rolling_radius, a.leaning)],
        "axis_table": [tables.get(id(a.spin.carrier), -1) for a in axes],
    }


def _reals(model: Model) -> list[float]:
    """Numbers of the axes as drawn, to the last bit as the parameters write them.

    An instance compares with these to see whether a parameter has changed an axis.
    """
    reals = [list(a.reals) for a in model.written_axes]
    for p in model.parameters:
        for family, k, i, scale, offset, _ in p.targets:
            written = p.value * scale + offset
            if family == ParameterTarget.AXIS and abs(written - reals[k][i]) < ROUND:
                reals[k][i] = written
    return [r for pair in reals for r in pair]


def _drawn(axis: WrittenAxis) -> list[float]:
    """f, g and the axis of a wheel as drawn, along the axes of its carrier."""
    return [float(v) for vector in axis.spin.drawn for v in vector]
