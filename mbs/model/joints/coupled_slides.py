"""Two bodies that slide along axes of their carriers in a constant ratio."""

from numpy.typing import ArrayLike

from mbs.common.checks import not_zero
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.equation import Equation, Product, dot_products
from mbs.model.joint_ends import different
from mbs.model.joints.joint import Joint


def coupled_slides(
    model: BodyVocabulary,
    name: str,
    body_1: Body,
    body_2: Body,
    *,
    carrier_1: Body,
    carrier_2: Body,
    axis_1: ArrayLike,
    axis_2: ArrayLike,
    ratio: float,
) -> Joint:
    """Two bodies that slide on their carriers in a constant ratio, as the fingers of a gripper; guides nothing.

    The equation is ``(p_1 - c_1) . e_1 = ratio * (p_2 - c_2) . e_2`` with p of the body, c and e of its carrier, p = c
    as drawn.

    Parameters
    ----------
    axis_1, axis_2 : array_like, shape (dimension,)
        Directions of the slides, fixed in their carriers, earth axes as drawn.
    ratio : float
        Metres of the first for one metre of the second, m/m.

    Returns
    -------
    Joint
        For sensors: its force on the first body along its axis.

    Raises
    ------
    ModelError
        The ratio is zero, both bodies are one, a carrier is a point mass, or a body is the ground or its carrier.
    """
    subject = f"coupled slides '{name}'"
    if body_1 is body_2:
        raise ModelError(f"The {subject} couple '{body_1.name}' with itself; they need two bodies that slide.")
    i = not_zero(ratio, f"The ratio of {subject}")
    products = _travel_products(model, body_1, carrier_1, axis_1, 1.0, subject) + _travel_products(
        model, body_2, carrier_2, axis_2, -i, subject
    )
    joint = Joint(name, "rack", [Equation(name, "rack", products)], rows_weight=1.0)
    joint.as_rows = True  # between axes of the ground the row is linear, but its force is still needed
    return joint


def _travel_products(
    model: BodyVocabulary, body: Body, carrier: Body, axis: ArrayLike, factor: float, subject: str
) -> list[Product]:
    """Travel of a body along an axis of its carrier, times a factor."""
    different(body, carrier, subject)
    if model.owned(carrier, f"The {subject}").is_point:
        raise ModelError(f"A carrier of {subject} needs axes; '{carrier.name}' is a point mass.")
    if model.owned(body, f"The {subject}").is_ground:
        raise ModelError(f"A sliding body of {subject} is the ground; it must move, with the ground as its carrier.")
    gap = model.anchor(body, body.com, subject) - model.anchor(carrier, body.com, subject)
    return dot_products(gap, model.anchor_axis(carrier, axis, subject), factor)
