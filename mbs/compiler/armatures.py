"""Armatures whose ratio is set by a parameter, as the `armature_` arrays of the System."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.compiler.polynomial import substitute
from mbs.kernel.header.enumerations import ParameterTarget
from mbs.model.model import Model


def written_armatures(model: Model) -> list[int]:
    """Numbers of the armatures whose ratio a parameter writes; all others are constants of the mass matrix."""
    targets = [target for p in model.parameters for target in p.targets]
    return sorted({k for family, k, *_ in targets if family == ParameterTarget.ARMATURE})


def armature_arrays(model: Model, full: Sequence[Affine], new: NDArray[np.int64]) -> dict[str, Any]:
    """The `armature_` arrays; the mass matrix contains their inertia with the ratio as drawn.

    `full`: full coordinates as expressions in z; `new`: index of each z in elimination order.
    """
    columns, inertias, ratios = [], [], []
    for armature in (model.armatures[k] for k in written_armatures(model)):
        terms = substitute(armature.coordinate, full).terms
        if len(terms) != 1:
            raise ModelError(
                f"The ratio of armature '{armature.name}' is written by a parameter, but its angle follows from "
                f"{len(terms)} coordinates of the model; it must be one of them."
            )
        ((column, factor),) = terms.items()
        columns.append(int(new[column]))
        inertias.append(armature.inertia * factor * factor)
        ratios.append(armature.ratio)
    return {"armature_col": columns, "armature_inertia": inertias, "armature_ratio": ratios}
