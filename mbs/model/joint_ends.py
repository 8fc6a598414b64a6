"""Ends of joints, springs and drives as bodies and points, and the check that they are on different bodies."""

from __future__ import annotations

from typing import TypeAlias

from numpy.typing import ArrayLike

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.model.body import Body
from mbs.model.carried_parts import SlidingPoint

FixedEnd: TypeAlias = "tuple[Body, ArrayLike] | Body"
"""A point of a body, earth axes in the reference configuration, m; or a body for its centre of mass."""
End: TypeAlias = "tuple[Body, ArrayLike] | Body | SlidingPoint"
"""A fixed end, or a point that a driving function slides."""
PointPair: TypeAlias = "ArrayLike | tuple[ArrayLike, ArrayLike]"
"""A point, or one per body if the drawing does not close."""


def body_and_point(
    end: End | FixedEnd, subject: str, expected: str = "(body, point) or a point mass"
) -> tuple[Body, ArrayLike]:
    """Body and point of an end that does not slide; a body alone is its centre of mass.

    Neither is checked to be of the model. `expected`: description of a valid end. Raises `ModelError` if the end is
    something else.
    """
    if isinstance(end, Body):
        return end, end.com
    if isinstance(end, (tuple, list)) and len(end) == 2 and isinstance(end[0], Body):
        return end[0], end[1]
    raise ModelError(f"An end of {subject} must be {expected}; got {shown(end)}.")


def on_one_body(body_1: Body, body_2: Body) -> bool:
    """Whether two bodies are the same rigid body, with or without ports, or both the ground.

    Two nodes of a flexible body are different.
    """
    if body_1.model is not body_2.model:
        return False
    if body_1 is body_2 or (body_1.is_ground and body_2.is_ground):
        return True
    rigid = not (body_1.is_flexible or body_2.is_flexible or body_1.is_ground or body_2.is_ground)
    return rigid and body_1.start == body_2.start


def different(body_1: Body, body_2: Body, subject: str) -> None:
    """Raise `ModelError` for a joint or a force between a body and itself."""
    for body in (body_1, body_2):
        if not isinstance(body, Body):
            raise ModelError(f"The {subject} needs a body, got {shown(body)}.")
    if on_one_body(body_1, body_2):
        name = body_1.name if body_1 is body_2 else f"{body_1.name}' and '{body_2.name}"
        raise ModelError(f"The {subject} joins body '{name}' with itself; it needs two bodies.")
