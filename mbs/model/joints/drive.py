"""A coordinate or a distance that follows a driving function."""

from mbs.common.affine import Affine
from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.coordinate import Coordinate
from mbs.model.driving_functions import owned_driving_function
from mbs.model.equation import DrivingTerm, Equation
from mbs.model.joint_ends import End
from mbs.model.joints.distance import distance
from mbs.model.joints.joint import Joint
from mbs.model.records import DrivingFunction
from mbs.model.switches import new_switch


def drive(
    model: BodyVocabulary,
    name: str,
    driven: Coordinate | Affine | tuple[End, End],
    guide: DrivingFunction,
    *,
    switch: bool | None = None,
) -> Joint:
    """Prescribed motion: a coordinate, a component of a point, or the distance of two points is a driving function.

    The equation is ``coordinate - s(t) = 0``, or for two ends ``(|p_1 - p_2|^2 - s(t)^2)/2 = 0``.

    Parameters
    ----------
    driven : Coordinate, Affine or (end, end)
        A relative angle; an expression such as ``body.point(p)[0]``; or two ends as in `distance`.
    guide : DrivingFunction
        Of this model, rad or m.
    switch : bool, optional
        With a switch of the same name, on or off at the start: the drive can let go. One that is turned on later
        keeps the distance to its driving function that there is then.

    Returns
    -------
    Joint
        For sensors: its force is the force of the drive, zero while it is off.

    Raises
    ------
    ModelError
        The driven coordinate or distance cannot move, an end slides, or a driven distance starts at zero.
    """
    joint = _drive(model, name, driven, guide)
    if switch is not None:
        joint.switch = new_switch(model, name, switch)
    return joint


def _drive(
    model: BodyVocabulary, name: str, driven: Coordinate | Affine | tuple[End, End], guide: DrivingFunction
) -> Joint:
    subject = f"drive '{name}'"
    g = owned_driving_function(model, guide, f"The {subject}").index
    minus_one = Affine({}, -1.0)
    if isinstance(driven, tuple) and len(driven) == 2:
        if guide.start <= 0.0:
            raise ModelError(
                f"The driving function of {subject} starts at {guide.start:g} m; "
                "a driven distance must be greater than zero."
            )
        rod = distance(model, name, driven[0], driven[1], length=guide.start)
        if rod.equations[0].guides:
            raise ModelError(f"An end of {subject} slides; only fixed points may have a driven distance.")
        row = Equation(
            name, "driven_distance", rod.equations[0].products, guides=[DrivingTerm(g, 2, linear=minus_one * 0.5)]
        )
        joint = Joint(name, "drive", [row])
        joint.actuator = rod.ends
        return joint
    if not isinstance(driven, (Coordinate, Affine)):
        raise ModelError(
            f"The {subject} needs a coordinate, a component of a point or two ends of a distance, got {shown(driven)}."
        )
    expression = model.expression(driven, f"The {subject}")
    if not expression.terms:
        raise ModelError(f"The {subject} drives something that cannot move: it depends on no coordinate.")
    row = Equation(name, "drive", linear=expression, guides=[DrivingTerm(g, 1, linear=minus_one)])
    joint = Joint(name, "drive", [row], rows_weight=1.0)
    if (driven.unit if isinstance(driven, Coordinate) else guide.unit) == "rad":
        joint.force_unit = "N m"
    return joint
