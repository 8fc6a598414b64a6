"""Bodies whose inertia is set by parameters, as the `inertia_` arrays of the System, with entries in the mass."""

from collections.abc import Sequence
from typing import Any

from mbs.common.affine import Affine
from mbs.common.vectors import in_space
from mbs.compiler.polynomial import substitute
from mbs.compiler.tables import Signals
from mbs.model.model import Model


def inertia_cliques(model: Model, full: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z (before ordering) that each component of the vectors of a body couples in the mass matrix."""
    return [
        sorted({j for v in body.vectors for j in substitute(v.components[k], full).terms})
        for body in model.written_inertias
        for k in range(3)
    ]


def inertia_arrays(model: Model, signals: Signals) -> dict[str, Any]:
    """Arrays `inertia_` of a System: bodies whose mass properties parameters write."""
    return {
        "inertia_parameter": [r for body in model.written_inertias for r in body.reals],
        "inertia_signal": [
            signals.number(c) for body in model.written_inertias for v in body.vectors for c in v.components
        ],
        "inertia_gravity": in_space(model.gravity) if model.written_inertias else [],
    }
