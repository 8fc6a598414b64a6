"""A point that can be held where it is at the moment, and let go: rows that are switched at run time."""

from __future__ import annotations

from numpy.typing import ArrayLike

from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.joints.joint import Joint, equal_vectors
from mbs.model.switches import new_switch


def pin(model: BodyVocabulary, name: str, body: Body, point: ArrayLike | None, on: bool) -> Joint:
    """The point of the body stays where it is when the switch of the same name goes on.

    At the start, if `on`, that is where it is drawn.
    """
    what = f"pin '{name}'"
    if model.owned(body, f"The {what}").is_ground:
        raise ModelError(f"The {what} holds a point of the ground; it needs a body that can move.")
    place = body.com if point is None else point
    held = model.anchor(body, place, what)
    equations = equal_vectors(name, "point", held, model.anchor(model.ground, place, what))
    joint = Joint(name, "pin", equations, rows_weight=1.0)
    joint.as_rows = True
    joint.switch = new_switch(model, name, on)
    return joint
