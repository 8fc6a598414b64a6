"""Anti-roll bar: a torsion spring between two arms on one axis."""

from __future__ import annotations

from numpy.typing import ArrayLike

from mbs.common.checks import flag, positive, shown
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.model.angle import relative_angle
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.joints.joint import Joint


def arm_angles(
    model: BodyVocabulary,
    name: str,
    arms: tuple[Coordinate | Body, Coordinate | Body],
    carrier: Body | None,
    axis: ArrayLike | None,
) -> tuple[list[Coordinate], list[Joint]]:
    """The angles of both arms, and the joints of those that are made here for arms given as bodies."""
    what = f"anti-roll bar '{name}'"
    if all(isinstance(arm, Coordinate) for arm in arms):
        if carrier is not None or axis is not None:
            raise ModelError(f"The {what} joins two angles; leave out its carrier and its axis.")
        angles = [model.owned_coordinate(arm, f"The {what}") for arm in arms]  # type: ignore[arg-type]
        if any(model.coordinates[angle.index].kind == "spin" for angle in angles):
            raise ModelError(f"The {what} needs relative angles; a spin has a rate but no angle.")
        joints: list[Joint] = []
    elif all(isinstance(arm, Body) for arm in arms):
        if carrier is None:
            raise ModelError(f"The {what} needs the carrier on which its arms turn.")
        made = [
            relative_angle(model, f"{name}.{side}", carrier, arm, axis, 0.0)  # type: ignore[arg-type]
            for side, arm in zip(("left", "right"), arms, strict=True)
        ]
        angles, joints = [angle for angle, _ in made], [joint for _, joint in made]
    else:
        raise ModelError(
            f"The {what} needs two relative angles or two bodies as its arms, got {shown(arms[0])} and "
            f"{shown(arms[1])}."
        )
    return angles, joints


def anti_roll_bar(
    model: BodyVocabulary,
    name: str,
    angles: list[Coordinate],
    stiffness: float,
    damping: float,
    stiffness_factor: float,
    free_twist: float | None,
    mirrored: bool,
) -> ElementRecord:
    """Torque ``-k (twist - free_twist) - c d(twist)/dt`` on the first angle and against it on the second."""
    first, second = angles
    flag(mirrored, f"The mirrored of anti-roll bar '{name}'")
    if first.index == second.index:
        raise ModelError(f"The anti-roll bar '{name}' joins '{first.name}' with itself; it needs two arms.")
    twist = first.affine + second.affine if mirrored else first.affine - second.affine
    if free_twist is None:
        free_twist = float(twist.value(model.drawn()))
    k = positive(stiffness, f"The stiffness of the anti-roll bar '{name}'")
    return model.add(ScalarSpringDamper(k, damping, free_twist, stiffness_factor=stiffness_factor).record(name, twist))
