"""Initial pose of a scene that is not tied to the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mbs.affine import Affine
from mbs.errors import ModelError
from mbs.model.model import Model

Array = NDArray[np.float64]

NAMES = ("pose_0", "pose_cos", "pose_sin", "pose_x", "pose_y", "pose_z", "pose_speed")


def pose_arrays(model: Model, kept: Sequence[int], full: Sequence[Affine], q: Array) -> dict[str, Array]:
    """The `pose_` arrays, in the order of `kept`; empty unless the model floats.

    A coordinate is a component of a point or of a vector of a body, so that moving and turning the scene as a whole
    is linear in cos, sin and the shift.

    Parameters
    ----------
    q : ndarray
        Position of z to be moved, in the order of `kept`.
    """
    if not model.floating:
        return {name: np.zeros(0) for name in NAMES}
    tied = [model.coordinates[i].name for i, e in enumerate(full) if abs(e.constant) > 1e-9]
    if tied:
        raise ModelError(
            f"The model '{model.name}' is declared floating, but joints tie it to the ground (coordinate '{tied[0]}')."
        )
    arrays = {name: np.zeros(len(kept)) for name in NAMES}
    spins = {s.index: s for s in model.spins}
    value = full_values(full, q)
    for k, i in enumerate(kept):
        info = model.coordinates[i]
        if info.kind == "spin":
            wheel = spins[i]
            if wheel.rolling_radius > 0.0:
                arrays["pose_speed"][k] = wheel.axis_reference[1] / wheel.rolling_radius
            continue
        if info.kind == "angle":
            arrays["pose_0"][k] = q[k]
            continue
        # q is in the units of z (metres per unit axis); i - component is the x component of the same point or vector
        unit = 1.0 / full[i].terms[k]
        x, y = value[i - info.component] * unit, value[i - info.component + 1] * unit
        if info.component == 2:
            arrays["pose_0"][k] = q[k]
        else:
            arrays["pose_cos"][k], arrays["pose_sin"][k] = (x, -y) if info.component == 0 else (y, x)
        if info.kind == "point":
            arrays[f"pose_{'xyz'[info.component]}"][k] = 1.0
    return arrays


def full_values(full: Sequence[Affine], z: Array) -> Array:
    """Full coordinates (unit axes) at z."""
    return np.array([e.value(z) for e in full])
