"""Two bodies that slide along axes of their carriers in a constant ratio."""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from mbs.common.checks import not_zero
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.ends import different
from mbs.model.equation import Equation, Product, dot_products
from mbs.model.joints.joint import Joint


class Slide(NamedTuple):
    """A body that slides on another one."""

    body: Body
    carrier: Body
    axis: ArrayLike
    """Shape (dimension,): direction of the slide, fixed in the carrier, earth axes as drawn."""


def coupled_slides(model: BodyVocabulary, name: str, slide_1: Slide, slide_2: Slide, ratio: float) -> Joint:
    """``(p_1 - c_1) . e_1 = ratio * (p_2 - c_2) . e_2`` with p of the body, c and e of its carrier, p = c as drawn."""
    what = f"coupled slides '{name}'"
    if slide_1.body is slide_2.body:
        raise ModelError(f"The {what} couple '{slide_1.body.name}' with itself; they need two bodies that slide.")
    i = not_zero(ratio, f"The ratio of {what}")
    products = _way(model, slide_1, 1.0, what) + _way(model, slide_2, -i, what)
    joint = Joint(name, "rack", [Equation(name, "rack", products)], rows_weight=1.0)
    joint.as_rows = True  # where both axes are the ground's the row is linear, and its force is asked for all the same
    return joint


def _way(model: BodyVocabulary, slide: Slide, factor: float, what: str) -> list[Product]:
    body, carrier = slide.body, slide.carrier
    different(body, carrier, what)
    if model.owned(carrier, f"The {what}").is_point:
        raise ModelError(f"A carrier of {what} needs axes; '{carrier.name}' is a point mass.")
    if model.owned(body, f"The {what}").is_ground:
        raise ModelError(f"A sliding body of {what} is the ground; it must move, with the ground as its carrier.")
    gap = model.anchor(body, body.com, what) - model.anchor(carrier, body.com, what)
    return dot_products(gap, model.anchor_axis(carrier, slide.axis, what), factor)
