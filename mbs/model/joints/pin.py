"""Pin: holds a point of a body at its present position, switched on and off at run time."""

from numpy.typing import ArrayLike

from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.joints.joint import Joint, equal_vectors
from mbs.model.switches import new_switch


def pin(model: BodyVocabulary, name: str, body: Body, point: ArrayLike | None = None, *, on: bool = False) -> Joint:
    """Hold a point of a body by a switch of the same name, which a running `Simulation` turns on and off.

    The point stays where it is when the switch is turned on.

    Parameters
    ----------
    body : Body
        A body or a point mass that can move.
    point : array_like, shape (dimension,), optional
        Earth axes in the reference configuration, m; by default the centre of mass.
    on : bool
        Whether it holds, as drawn, from the start.

    Raises
    ------
    ModelError
        The body is the ground.
    """
    subject = f"pin '{name}'"
    if model.owned(body, f"The {subject}").is_ground:
        raise ModelError(f"The {subject} holds a point of the ground; it needs a body that can move.")
    position = body.com if point is None else point
    held_point = model.anchor(body, position, subject)
    equations = equal_vectors(name, "point", held_point, model.anchor(model.ground, position, subject))
    joint = Joint(name, "pin", equations, rows_weight=1.0)
    joint.as_rows = True
    joint.switch = new_switch(model, name, on)
    return joint
