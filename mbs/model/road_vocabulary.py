"""Roads of a model, and points of bodies that touch them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import array, instance_of, named, not_negative, shown, text, whole
from mbs.common.errors import ModelError
from mbs.elements.contact_points import ContactPoints
from mbs.elements.record import ElementRecord
from mbs.elements.road import ANSWER, GridRoad, KerbRoad, PlaneRoad, PortRoad, Road, RoadOfFile
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.inputs import new_input
from mbs.model.records import RoadFileParameter, Role


class RoadVocabulary(BodyVocabulary):
    """Roads, answers on them, and contact with them."""

    def road(self, road: Road | RoadOfFile, *, file: str | None = None) -> int:
        """Add a road.

        Parameters
        ----------
        road : PlaneRoad, KerbRoad, GridRoad, PortRoad or RoadFile
            Of `mbs.elements`, or a file (`mbs.RoadFile`).
        file : str, optional
            Name of a parameter, as ``"road.file"``, that exchanges this road for one of a file before a start: of an
            FMU a variable of type String, of runs `parameters={"road.file": "path.road"}`. Its start value is the
            path of a `RoadFile`, else nothing: then the road is the one given here. A `RoadFile` without a name has
            ``"road.file"``, from the second road on with its number, ``"road_1.file"``.

        Returns
        -------
        int
            Its number, for tyres, contact points and parameters.

        Raises
        ------
        ModelError
            The file is no road, or a road at ports asks for inputs that the model does not have.
        """
        kinds = (PlaneRoad, KerbRoad, GridRoad, PortRoad, RoadOfFile)
        instance_of(
            kinds, road, f"A road of model '{self.name}'", "a PlaneRoad, KerbRoad, GridRoad, PortRoad or RoadFile"
        )
        k, start = len(self.roads), ""
        if isinstance(road, RoadOfFile):
            road.check()
            start = str(Path(road.path).absolute())
            file = file or ("road.file" if k == 0 else f"road_{k}.file")
            road = road.road
        _ = road.real  # its numbers are looked at
        if isinstance(road, PortRoad) and max(road.first) + len(ANSWER) > len(self.inputs):
            raise ModelError(
                f"A road at ports has its first inputs {list(road.first)}, but the model '{self.name}' has "
                f"{len(self.inputs)}; `road_answer` makes them."
            )
        if file is not None:
            self.road_files.append(RoadFileParameter(self.unique("parameter", file), k, start))
        self.roads.append(road)
        return k

    def road_answer(self, name: str, *, friction: float = 0.9, near: str = "") -> int:
        """Seven inputs by which another program says what the road is like at a point: for a `PortRoad`.

        They are the point that it was asked for, with which the answer holds whenever it comes, and height, unit
        normal and friction there: ``name_x``, ``name_y``, ``name_height``, ``name_normal_x``, ``name_normal_y``,
        ``name_normal_z`` and ``name_friction``. The road goes on from there as the plane that they give. They start as
        level ground at height 0. A step with a normal that is no unit vector upwards is refused.

        Parameters
        ----------
        friction : float
            Coefficient of friction at the start.
        near : str, optional
            Name of the sensor of the x of what meets the road there, whose y and z follow it: an FMU tells, once, when
            the point of the answer is more than 10 m away from it.

        Returns
        -------
        int
            The number of the first input.
        """
        what = f"road answer '{named(name, 'a road answer')}'"
        grip = not_negative(friction, f"The friction of {what}")
        text(near, f"The near of {what}")
        up, roles = ("normal_x", "normal_y", "normal_z"), {"x": Role.ANSWER, "normal_x": Role.NORMAL}
        starts = {"normal_z": 1.0, "friction": grip}
        limits = {"friction": (0.0, 10.0)} | dict.fromkeys(up, (-1.1, 1.1))
        units, words = dict.fromkeys(("x", "y", "height"), "m"), {"x": "x", "y": "y", "height": "height"}
        first = len(self.inputs)
        for part in ANSWER:
            at = "of the point that the answer on the road holds for, earth" if part in "xy" else "of the road there"
            word = words.get(part, f"{part[-1]} of the unit normal, earth, upwards," if part in up else part)
            new_input(
                self,
                f"{name}_{part}",
                starts.get(part, 0.0),
                *limits.get(part, (-math.inf, math.inf)),
                units.get(part, "1"),
                f"{word} {at}",
                False,
                True,
                roles.get(part, Role.NONE),
                near if part == "x" else "",
                {"x": 1.0, "y": 1.0, "height": 0.02, "friction": 0.2 * grip}.get(part, 0.02),
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
        what = f"contact points '{name}'"
        self.owned(body, f"The {what}")
        if self.dimension != 3 or body.is_ground or body.is_point or body.is_flexible:
            raise ModelError(f"The {what} need a rigid body in space, not '{body.name}'.")
        instance_of(ContactPoints, contact, f"The contact of {what}", "ContactPoints")
        k = whole(road, f"The road of {what}", 0)
        if k >= len(self.roads):
            raise ModelError(f"The {what} ask for road {k}; the model has {len(self.roads)}.")
        places = array(points, (None, 3), f"the places of {what}")
        axes = [body.vector(v) for v in np.eye(3)]
        return self.add(contact.record(name, body.point(body.com), axes, places - body.com, k))

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
        place = array(point, (3,), f"the place of contact point {shown(name)}")
        return self.contact_points(name, body, place[None], road=road, contact=contact)
