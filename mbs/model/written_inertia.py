"""Bodies whose mass, centre of mass and inertia parameters write."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import positive, shown, vector
from mbs.common.errors import ModelError
from mbs.model.carried import WrittenInertia
from mbs.model.core import ModelCore
from mbs.model.inertia import inertia_matrix


def new_written_inertia(
    model: ModelCore,
    name: str,
    point: AffineVector,
    axes: Sequence[AffineVector],
    mass: float,
    com: ArrayLike,
    inertia: ArrayLike,
) -> WrittenInertia:
    """Register it; see `Model.written_inertia`."""
    what = f"written inertia {shown(name)}"
    if model.dimension != 3:
        raise ModelError(f"The {what} needs a spatial model.")
    m = positive(mass, f"The mass of {what}")
    tensor = inertia_matrix(inertia, 3, f"the inertia of {what}")
    if not isinstance(axes, (list, tuple)) or len(axes) != 3 or not all(isinstance(a, AffineVector) for a in axes):
        raise ModelError(f"The axes of {what} are {shown(axes)}; they must be three vectors of a body.")
    x, y, z = (model.expressions(axis, f"The {what}") for axis in axes)
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor.tolist()
    place = vector(com, 3, f"the centre of mass of {what}").tolist()
    reals = (m, *place, xx, yy, zz, xy, xz, yz)
    new = WrittenInertia(
        model.unique("written inertia", name), (model.expressions(point, f"The {what}"), x, y, z), reals
    )
    model.written_inertias.append(new)
    return new
