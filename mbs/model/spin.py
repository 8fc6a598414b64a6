"""An axisymmetric wheel reduced to one coordinate: its absolute axial rate."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import direction, not_negative, positive, vector
from mbs.common.errors import ModelError
from mbs.elements.gyroscopic_spin import GyroscopicSpin
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried import Spin
from mbs.model.perpendicular import perpendicular


def _own(vector: AffineVector) -> AffineVector:
    """The same, told apart from equal vectors of the carrier that do not turn with the axis."""
    return AffineVector(tuple(Affine(c.terms, c.constant) for c in vector.components))


def spin(
    model: BodyVocabulary,
    name: str,
    carrier: Body,
    centre: ArrayLike,
    axis: ArrayLike,
    mass: float,
    spin_inertia: float,
    diametral_inertia: float,
    rolling_radius: float,
) -> Spin:
    """Lump the wheel on its carrier and add its spin and gyroscopic moment."""
    what = f"spin '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {what} needs a spatial model; in the plane a wheel is a body.")
    model.owned(carrier, f"The {what}")
    if carrier.is_ground or carrier.is_point or carrier.is_flexible:
        raise ModelError(f"The carrier of {what} must be a rigid body, not '{carrier.name}'.")
    m = positive(mass, f"The mass of {what}")
    I_s = positive(spin_inertia, f"The spin inertia of {what}")
    I_d = not_negative(diametral_inertia, f"The diametral inertia of {what}")
    if I_s > 2.0 * I_d * (1.0 + 1e-9):
        raise ModelError(
            f"The spin inertia {I_s:g} of {what} is more than twice its diametral inertia {I_d:g}; no wheel has that."
        )
    radius = not_negative(rolling_radius, f"The rolling radius of {what}")
    e = direction(axis, 3, f"the axis of {what}")
    c = vector(centre, 3, f"the centre of {what}")
    x, y = perpendicular(e)
    model.remember(carrier)
    carrier.joint_axes.append(e)
    # I = I_d (1 - e e'), zero about the axis, has the second moment J = tr(I)/2 - I = I_d e e'
    carrier.add_mass(m, c, I_d * np.outer(e, e))
    index = model.new_coordinate(model.unique("spin", name), "spin", 0.0)
    model.inertias[index] = I_s
    along, across, aside = (_own(carrier.vector(v)) for v in (e, x, y))
    new = Spin(
        name,
        index,
        "rad",
        carrier,
        carrier.point(c),
        along,
        across,
        aside,
        I_s,
        I_d,
        radius,
        (tuple(x), tuple(y), tuple(e)),
    )
    model.add(GyroscopicSpin(I_s).record(f"{name}.gyroscopic", new.f, new.g, new.affine))
    model.spins.append(new)
    return new
