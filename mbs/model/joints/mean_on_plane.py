"""The mean of points of several bodies stays in a plane of a carrier."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from mbs.checks import shown
from mbs.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.ends import body_and_point, different
from mbs.model.equation import Equation, Product, dot_products
from mbs.model.joints.joint import Joint


def mean_on_plane(
    model: BodyVocabulary, name: str, ends: Sequence[tuple[Body, ArrayLike]], carrier: Body, normal: ArrayLike
) -> Joint:
    """``sum (p_i - c_i) . n / number = 0`` with the points p_i of the bodies, where they are drawn on the carrier c_i,
    and the normal n of the carrier.
    """
    what = f"mean on plane '{name}'"
    if not isinstance(ends, Sequence) or not ends:
        raise ModelError(f"The {what} needs a list of (body, point), one at least, got {shown(ends)}.")
    if model.owned(carrier, f"The {what}").is_point:
        raise ModelError(f"The plane of {what} needs a body with axes; '{carrier.name}' is a point mass.")
    n = model.anchor_axis(carrier, normal, what)
    products: list[Product] = []
    for body, point in (body_and_point(end, what, "(body, point)") for end in ends):
        different(body, carrier, what)
        place = body.com if point is None else point
        gap = model.anchor(body, point, what) - model.anchor(carrier, place, what)
        products += dot_products(gap, n, 1.0 / len(ends))
    return Joint(name, "mean_on_plane", [Equation(name, "plane", products)])
