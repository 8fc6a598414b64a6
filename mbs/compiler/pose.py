"""Initial pose of a scene without joints to the ground, as the `pose_` arrays of the System."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.compiler.natural_coordinates import NaturalCoordinates
from mbs.compiler.tables import Signals
from mbs.model.model import Model

Array = NDArray[np.float64]
Index = NDArray[np.int64]

NAMES = ("pose_0", "pose_cos", "pose_sin", "pose_x", "pose_y", "pose_z", "pose_speed")


def pose_arrays(
    model: Model,
    natural: NaturalCoordinates,
    remaining: Sequence[int],
    of_z: Sequence[Affine],
    q: Array,
    order: Index,
) -> dict[str, Array]:
    """The `pose_` arrays in elimination order; empty unless the model is floating.

    A coordinate is a component of a point or of a vector of a body, so it is linear in the translation of the scene and
    in cosine and sine of its heading. `q`: position of z to be moved, in the order of `remaining`. Raises `ModelError`:
    a joint connects a floating model to the ground.
    """
    if not model.floating:
        return {name: np.zeros(0) for name in NAMES}
    rolling_joints = [joint.name for joint in model.joints if joint.type == "rolling"]
    if rolling_joints:
        raise ModelError(
            f"The model '{model.name}' is declared floating, but '{rolling_joints[0]}' ties it to the height of the "
            "ground."
        )
    tied_coordinates = [natural.info[i].name for i, e in enumerate(of_z) if abs(e.constant) > 1e-9]
    if tied_coordinates:
        raise ModelError(
            f"The model '{model.name}' is declared floating, but joints tie it to the ground (coordinate "
            f"'{tied_coordinates[0]}')."
        )
    arrays = {name: np.zeros(len(remaining)) for name in NAMES}
    spins = {s.index: s for s in model.spins}
    value = full_values(of_z, q)
    for k, i in enumerate(remaining):
        info = natural.info[i]
        if info.kind == "spin":
            wheel = spins[i]
            if wheel.rolling_radius > 0.0:
                arrays["pose_speed"][k] = wheel.axis_reference[1] / wheel.rolling_radius
            continue
        if info.kind in ("angle", "mode"):
            arrays["pose_0"][k] = q[k]
            continue
        x, y = value[i - info.component], value[i - info.component + 1]
        if info.component == 2:
            arrays["pose_0"][k] = q[k]
        else:
            arrays["pose_cos"][k], arrays["pose_sin"][k] = (x, -y) if info.component == 0 else (y, x)
        if info.kind == "point":
            arrays[f"pose_{'xyz'[info.component]}"][k] = 1.0
    return {name: values[order] for name, values in arrays.items()}


def pose_partners(
    model: Model,
    natural: NaturalCoordinates,
    remaining: Sequence[int],
    of_z: Sequence[Affine],
    signals: Signals,
    order: Index,
) -> Index:
    """`pose_partner` in elimination order: signal of the other horizontal component, from 1, negative at x; 0: none.

    With it a scene can be moved from another position than the `pose_` arrays have.
    """
    partners = np.zeros(len(remaining), dtype=np.int64)
    for k, i in enumerate(remaining):
        info = natural.info[i]
        if info.kind not in ("spin", "angle", "mode") and info.component < 2:
            other = of_z[i - info.component + 1 - info.component]
            sign = -1 if info.component == 0 else 1
            partners[k] = sign * (1 + signals.number_of_z(other))
    return partners[order] if model.floating else np.zeros(0, dtype=np.int64)


def full_values(full: Sequence[Affine], z: Array) -> Array:
    """Values of expressions in z, shape (n_full,)."""
    return np.array([e.value(z) for e in full])
