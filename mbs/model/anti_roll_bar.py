"""Anti-roll bar: a torsion spring between two arms on one axis."""

from numpy.typing import ArrayLike

from mbs.common.checks import flag, positive, shown
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.model.angle import angle_and_joint
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.joints.joint import Joint


def anti_roll_bar(
    model: BodyVocabulary,
    name: str,
    left: Coordinate | Body,
    right: Coordinate | Body,
    *,
    stiffness: float,
    damping: float = 0.0,
    stiffness_factor: float = 1.0,
    carrier: Body | None = None,
    axis: ArrayLike | None = None,
    free_twist: float | None = None,
    mirrored: bool = False,
) -> ElementRecord:
    """A torsion spring between two arms; its torque on the left one is the output ``force`` of the element.

    Drop links between the arms and the suspension are `distance` joints; without them the suspension carries the arms.

    Parameters
    ----------
    left, right : Coordinate or Body
        Relative angles of the arms, or the arms themselves, which turn on `carrier` about `axis`.
    stiffness, damping : float
        N m/rad and N m s/rad of the twist.
    stiffness_factor : float
        Factor on the stiffness, for a parameter.
    carrier : Body, optional
        With arms given as bodies: the body on which they turn.
    axis : array_like, shape (3,), optional
        With arms given as bodies, in space.
    free_twist : float, optional
        Twist without torque, rad; by default as drawn.
    mirrored : bool
        The angles count opposite ways (mirrored axes): the twist is their sum instead of left minus right.

    Raises
    ------
    ModelError
        The arms are the same, a body and an angle, or a spin; or bodies are given without a carrier.
    """
    subject = f"anti-roll bar '{name}'"
    angles, joints = _arm_angles(model, name, (left, right), carrier, axis)
    first, second = angles
    flag(mirrored, f"The mirrored of {subject}")
    if first.index == second.index:
        raise ModelError(f"The {subject} joins '{first.name}' with itself; it needs two arms.")
    twist = first.affine + second.affine if mirrored else first.affine - second.affine
    if free_twist is None:
        free_twist = float(twist.value(model.drawn()))
    k = positive(stiffness, f"The stiffness of the {subject}")
    bar = ScalarSpringDamper(k, damping, free_twist, stiffness_factor=stiffness_factor)
    record = model.add(bar.record(name, twist))
    for joint in joints:
        model._join(joint)
    return record


def _arm_angles(
    model: BodyVocabulary,
    name: str,
    arms: tuple[Coordinate | Body, Coordinate | Body],
    carrier: Body | None,
    axis: ArrayLike | None,
) -> tuple[list[Coordinate], list[Joint]]:
    """The angles of both arms, and the joints of those that are created for arms given as bodies."""
    subject = f"anti-roll bar '{name}'"
    if all(isinstance(arm, Coordinate) for arm in arms):
        if carrier is not None or axis is not None:
            raise ModelError(f"The {subject} joins two angles; leave out its carrier and its axis.")
        angles = [model.owned_coordinate(arm, f"The {subject}") for arm in arms]  # type: ignore[arg-type]
        if any(model.coordinates[angle.index].kind == "spin" for angle in angles):
            raise ModelError(f"The {subject} needs relative angles; a spin has a rate but no angle.")
        joints: list[Joint] = []
    elif all(isinstance(arm, Body) for arm in arms):
        if carrier is None:
            raise ModelError(f"The {subject} needs the carrier on which its arms turn.")
        ends = [
            angle_and_joint(model, f"{name}.{side}", carrier, arm, axis, 0.0)  # type: ignore[arg-type]
            for side, arm in zip(("left", "right"), arms, strict=True)
        ]
        angles, joints = [angle for angle, _ in ends], [joint for _, joint in ends]
    else:
        raise ModelError(
            f"The {subject} needs two relative angles or two bodies as its arms, got {shown(arms[0])} and "
            f"{shown(arms[1])}."
        )
    return angles, joints
