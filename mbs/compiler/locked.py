"""Models whose joints leave no motion, or not the one a drive asks for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.errors import ModelError
from mbs.compiler.polynomial import RowTerms
from mbs.compiler.structure import rank_at
from mbs.model.mechanism import Mechanism

Array = NDArray[np.float64]

IMPOSSIBLE = 1e-6
"""Part of the largest rate a condition asks for that may stay open."""


def check_motion(
    model: Mechanism, rows: Sequence[RowTerms], Phiq: sparse.csr_matrix, phi_t: Array, qd: Array, mass_diagonal: Array
) -> None:
    """Refuse a model that cannot move at its reference position although it is asked to, or not as its drives ask.

    A structure that stands, to which nothing gives a velocity, is a model too, since its joint forces may be what is
    wanted: `print(system)` and every run tell that nothing moves. Switched rows may be switched off again and do not
    count.
    """
    nq = Phiq.shape[1]
    lasting = [i for i, row in enumerate(rows) if row.switch < 0]
    scleronomic = [i for i in lasting if not rows[i].guides]
    asked = len(scleronomic) < len(lasting) or bool(model.body_velocities or model.coordinate_rates)
    if asked and len(scleronomic) >= nq and rank_at(Phiq[scleronomic], mass_diagonal) == nq:
        raise ModelError(
            f"The model '{model.name}' is locked: its joints are {nq} independent conditions on {nq} coordinates, "
            "which leaves no motion; check the axes of its joints, or let a body bend."
        )
    size = np.sqrt(np.asarray(Phiq.multiply(Phiq).sum(axis=1)).ravel())
    open_rates = np.abs(Phiq @ qd + phi_t) / size
    wanted = np.max(np.abs(phi_t) / size, initial=0.0)
    if np.max(open_rates, initial=0.0) > IMPOSSIBLE * wanted > 0.0:
        drives = ", ".join(sorted({f"'{row.name}'" for row, rate in zip(rows, phi_t, strict=True) if rate != 0.0}))
        worst = rows[int(np.argmax(open_rates))].name
        raise ModelError(
            f"The model '{model.name}' cannot start as {drives} asks: no velocity satisfies its joints; '{worst}' "
            f"stays open by {np.max(open_rates):.3g} m/s. Check the drives, the axes of the joints, or let a body bend."
        )
