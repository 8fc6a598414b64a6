"""Payloads: point masses on bodies whose mass a parameter may write."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import not_negative, shown, vector
from mbs.common.errors import ModelError
from mbs.model.body import SAME_PLACE, Body
from mbs.model.carried import Payload
from mbs.model.core import ModelCore
from mbs.model.flexible import FlexibleBody

REALS = ("mass",)


def new_payload(
    model: ModelCore, name: str, body: Body, position: ArrayLike, mass: float, point: AffineVector | None
) -> Payload:
    """Register a payload; see `Model.payload`."""
    what = f"payload {shown(name)}"
    m = not_negative(mass, f"The mass of {what}")
    place = vector(position, model.dimension, f"the position of {what}")
    if body.is_ground:
        raise ModelError(f"The {what} sits on the ground, which does not move; give it to a body.")
    if body.is_tabled:
        raise ModelError(
            f"The {what} sits on tabled body '{body.name}', whose mass is part of its table; give it to its base."
        )
    if point is not None:
        drawn = model.expressions(point, f"The {what}").value(model.drawn())
        if np.linalg.norm(drawn - place) > SAME_PLACE:
            raise ModelError(f"The {what} is at {place.tolist()}, but its point is drawn at {drawn.tolist()}.")
        carrier = point
    elif isinstance(body, FlexibleBody):  # the origin of a floating frame is no material point, a node is
        carrier = body.interface_at(place, what).point()
    else:
        carrier = body.point(place)
    new = Payload(model.unique("payload", name), body, place, carrier, m, point is not None)
    model.payloads.append(new)
    return new
