"""Wheels whose axes are set by parameters, as the `axis_` arrays of the System, and coordinates of their signals."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.compiler.polynomial import substitute
from mbs.kernel.header.enumerations import ParameterTarget
from mbs.model.carried_parts import WrittenAxis
from mbs.model.model import Model

ROUND_OFF = 1e-12
"""Largest difference, rad, of a number that a parameter writes from the drawn one due to round-off."""


def axis_coordinates(model: Model, full: Sequence[Affine]) -> dict[int, frozenset[int]]:
    """Coordinates of z (before ordering) on which components of vectors of these wheels depend, by identity."""
    coordinates: dict[int, frozenset[int]] = {}
    for axis in model.written_axes:
        for k in range(3):
            coordinates |= dict.fromkeys((id(v.components[k]) for v in axis.vectors), _frame_coordinates(axis, k, full))
    return coordinates


def axis_cliques(model: Model, full: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z (before ordering) that a wheel couples in the mass matrix of its carrier."""
    axes = [a for a in model.written_axes if not a.spin.carrier.is_lookup_table]
    return [sorted(_frame_coordinates(axis, k, full)) for axis in axes for k in range(3)]


def _frame_coordinates(axis: WrittenAxis, k: int, full: Sequence[Affine]) -> frozenset[int]:
    """Coordinates of z on which the k-th component of a vector of the carrier may depend."""
    return frozenset(j for v in axis.frame for j in substitute(v.components[k], full).terms)


def axis_arrays(
    model: Model, signals: Any, with_dependents: Sequence[Affine], new: NDArray[np.int64]
) -> Mapping[str, Any]:
    """The `axis_` arrays; `signals`: signals of the System, `new`: index of each z in elimination order."""
    tables = {id(t): k for k, t in enumerate(model.lookup_tables)}
    axes = model.written_axes

    def numbers(vectors: Iterable[AffineVector]) -> list[int]:
        return [signals.number(c) for v in vectors for c in v.components]

    return {
        "axis_parameter": _reals(model),
        "axis_vector": np.array([_drawn_vectors(a) for a in axes]).ravel(),
        "axis_inertia": [a.spin.diametral_inertia for a in axes],
        "axis_frame": [n for a in axes for n in numbers(a.frame)],
        "axis_signal": [n for a in axes for n in numbers(a.vectors)],
        "axis_spin": [int(new[next(iter(substitute(a.spin.affine, with_dependents).terms))]) for a in axes],
        "axis_rolling": [r for a in axes for r in (a.spin.rolling_radius, a.leaning)],
        "axis_table": [tables.get(id(a.spin.carrier), -1) for a in axes],
    }


def _reals(model: Model) -> list[float]:
    """Numbers of the axes as drawn, with the same bits as the parameters write.

    An instance compares them with the numbers of its parameters to detect changed axes.
    """
    reals = [list(a.reals) for a in model.written_axes]
    for p in model.parameters:
        for family, k, i, scale, offset, _ in p.targets:
            written = p.value * scale + offset
            if family == ParameterTarget.AXIS and abs(written - reals[k][i]) < ROUND_OFF:
                reals[k][i] = written
    return [r for pair in reals for r in pair]


def _drawn_vectors(axis: WrittenAxis) -> list[float]:
    """f, g and the axis of a wheel as drawn, in the frame of its carrier."""
    return [float(v) for vector in axis.spin.drawn for v in vector]
