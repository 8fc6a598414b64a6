"""Answers of other programs on a road, and points of bodies that touch one."""

import math

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import array, instance_of, named, not_negative, shown, text, whole
from mbs.common.errors import ModelError
from mbs.elements.contact_points import ContactPoints
from mbs.elements.record import ElementRecord
from mbs.elements.road import ANSWER
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.inputs import new_input
from mbs.model.records import Role


class ContactVocabulary(BodyVocabulary):
    """Vocabulary of answers on roads, and of contact with roads."""

    def road_answer(self, name: str, *, friction: float = 0.9, near: str = "") -> int:
        """Seven inputs with which another program gives position and friction of the road at a point, for a `PortRoad`.

        They are the point that it was asked for, with which the answer holds whenever it comes, and height, unit
        normal and friction there: ``name_x``, ``name_y``, ``name_height``, ``name_normal_x``, ``name_normal_y``,
        ``name_normal_z`` and ``name_friction``. The road continues from there as the plane that they define. They start
        as level ground at height 0. A step with a normal that is not a unit vector upwards is refused.

        Parameters
        ----------
        friction : float
            Coefficient of friction at the start.
        near : str, optional
            Name of the sensor of the x of the part that meets the road, followed by its y and z: an FMU warns once when
            the point of the answer is more than 10 m away from it.

        Returns
        -------
        int
            The number of the first input.
        """
        subject = f"road answer '{named(name, 'a road answer')}'"
        start_friction = not_negative(friction, f"The friction of {subject}")
        text(near, f"The near of {subject}")
        normals, roles = ("normal_x", "normal_y", "normal_z"), {"x": Role.ANSWER, "normal_x": Role.NORMAL}
        starts = {"normal_z": 1.0, "friction": start_friction}
        limits = {"friction": (0.0, 10.0)} | dict.fromkeys(normals, (-1.1, 1.1))
        units, names = dict.fromkeys(("x", "y", "height"), "m"), {"x": "x", "y": "y", "height": "height"}
        first = len(self.inputs)
        for component in ANSWER:
            location = (
                "of the point that the answer on the road holds for, earth"
                if component in "xy"
                else "of the road there"
            )
            quantity = names.get(
                component, f"{component[-1]} of the unit normal, earth, upwards," if component in normals else component
            )
            new_input(
                self,
                f"{name}_{component}",
                starts.get(component, 0.0),
                *limits.get(component, (-math.inf, math.inf)),
                units.get(component, "1"),
                f"{quantity} {location}",
                False,
                True,
                roles.get(component, Role.NONE),
                near if component == "x" else "",
                {"x": 1.0, "y": 1.0, "height": 0.02, "friction": 0.2 * start_friction}.get(component, 0.02),
            )
        return first

    def contact_points(
        self, name: str, body: Body, points: ArrayLike, *, road: int, contact: ContactPoints
    ) -> ElementRecord:
        """Points of a body that touch a road, with friction.

        Parameters
        ----------
        body : Body
            A rigid body of a spatial model.
        points : array_like, shape (n, 3)
            Earth axes in the reference configuration, m.
        contact : ContactPoints
            How they touch; `ContactPoints.for_mass` chooses numbers.
        """
        subject = f"contact points '{name}'"
        self.owned(body, f"The {subject}")
        if self.dimension != 3 or body.is_ground or body.is_point or body.is_flexible:
            raise ModelError(f"The {subject} need a rigid body in space, not '{body.name}'.")
        instance_of(ContactPoints, contact, f"The contact of {subject}", "ContactPoints")
        k = whole(road, f"The road of {subject}", 0)
        if k >= len(self.roads):
            raise ModelError(f"The {subject} ask for road {k}; the model has {len(self.roads)}.")
        positions = array(points, (None, 3), f"the places of {subject}")
        axes = [body.vector(v) for v in np.eye(3)]
        return self.add(contact.record(name, body.point(body.com), axes, positions - body.com, k))

    def contact_point(
        self, name: str, body: Body, point: ArrayLike, *, road: int, contact: ContactPoints
    ) -> ElementRecord:
        """One point of a body that touches a road; see `contact_points`.

        Parameters
        ----------
        body : Body
            A rigid body of a spatial model.
        point : array_like, shape (3,)
            Earth axes in the reference configuration, m.
        """
        position = array(point, (3,), f"the place of contact point {shown(name)}")
        return self.contact_points(name, body, position[None], road=road, contact=contact)
