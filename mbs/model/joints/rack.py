"""Rack and pinion: a body slides along an axis of a carrier by the radius of a pinion per radian."""

from numpy.typing import ArrayLike

from mbs.common.checks import not_zero
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.coordinate import Coordinate
from mbs.model.equation import Equation, dot_products
from mbs.model.joint_ends import different
from mbs.model.joints.joint import Joint
from mbs.model.joints.transmission import rotation_from_drawn, turning_rate


def rack(
    model: BodyVocabulary,
    name: str,
    pinion: Coordinate,
    body: Body,
    *,
    carrier: Body,
    axis: ArrayLike,
    radius: float,
    point: ArrayLike | None = None,
) -> Joint:
    """A rack that slides on a carrier by the radius of a pinion per radian; it guides nothing (see `prismatic`).

    The equation is ``(p - c) . e = radius * theta`` with p of the rack, c and e of the carrier, p = c and theta = 0 as
    drawn; with a spin as pinion the same of the rates.

    Parameters
    ----------
    pinion : Coordinate
        Relative angle of the pinion against the carrier, or a spin on it.
    axis : array_like, shape (dimension,)
        Direction of the slide, fixed in the carrier, earth axes as drawn.
    radius : float
        m per rad; negative if the rack goes against `axis` when the pinion turns positively.
    point : array_like, shape (dimension,), optional
        Of the rack, as drawn, m; by default its centre of mass.

    Returns
    -------
    Joint
        For sensors: its force on the rack along the axis.

    Raises
    ------
    ModelError
        The radius is zero, the carrier is a point mass, or the rack is the ground or the carrier.
    """
    subject = f"rack '{name}'"
    wheel_coordinate = model.owned_coordinate(pinion, f"The {subject}")
    different(body, carrier, subject)
    if model.owned(carrier, f"The {subject}").is_point:
        raise ModelError(f"The carrier of {subject} needs axes; '{carrier.name}' is a point mass.")
    if model.owned(body, f"The {subject}").is_ground:
        raise ModelError(
            f"The rack of {subject} is the ground; it must be a moving body, with the ground as its carrier."
        )
    r = not_zero(radius, f"The radius of {subject}")
    position = body.com if point is None else point
    gap = model.anchor(body, position, subject) - model.anchor(carrier, position, subject)
    e = model.anchor_axis(carrier, axis, subject)
    if isinstance(wheel_coordinate, Spin):
        rates = [*dot_products(e, gap), *dot_products(gap, e), *turning_rate(wheel_coordinate, -r)]
        equation = Equation(name, "rack", rates=rates)
    else:
        equation = Equation(name, "rack", dot_products(gap, e), rotation_from_drawn(model, wheel_coordinate) * -r)
    joint = Joint(name, "rack", [equation], rows_weight=1.0)
    joint.as_rows = True  # angles are never eliminated
    return joint
