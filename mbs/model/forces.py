"""Force elements by name: thin wrappers around the records of `mbs.elements`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import array, direction, instance_of, named, not_negative, number, one_of, shown, text, whole
from mbs.common.errors import ModelError
from mbs.elements.body_force import BodyForce
from mbs.elements.body_torque import BodyTorque
from mbs.elements.contact_points import ContactPoints
from mbs.elements.drag import Drag
from mbs.elements.input_force import InputForce
from mbs.elements.lift import Lift
from mbs.elements.record import ElementRecord
from mbs.elements.road import ANSWER, GridRoad, KerbRoad, PlaneRoad, PortRoad, Road
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.elements.spin_torque import SpinTorque
from mbs.elements.spring_damper import EndStops, SpringDamper
from mbs.elements.wind import Wind
from mbs.elements.wind_drag import WindDrag
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried import Spin
from mbs.model.coordinate import Coordinate
from mbs.model.ends import FixedEnd, body_and_point, different
from mbs.model.flexible import FlexibleBody
from mbs.model.inputs import new_input, owned_input
from mbs.model.records import Input, RoadFileParameter, Role
from mbs.roads.road_file import RoadFile


class ForceVocabulary(BodyVocabulary):
    """Springs, forces and torques of a model; each method returns the record of its element, for sensors."""

    def spring_damper(
        self,
        name: str,
        end_1: FixedEnd,
        end_2: FixedEnd,
        *,
        stiffness: float,
        damping: float = 0.0,
        free_length: float | None = None,
        stops: EndStops | None = None,
    ) -> ElementRecord:
        """Spring and damper between two points.

        Parameters
        ----------
        end_1, end_2 : (Body, array_like) or PointMass
            A body and its point in earth axes in the reference configuration, m; or a particle.
        stiffness, damping : float
            N/m and N s/m.
        free_length : float, optional
            m; by default as drawn.
        stops : EndStops, optional
            Bump and rebound stops.

        Raises
        ------
        ModelError
            Both ends are on the same body.
        """
        what = f"spring-damper '{name}'"
        p1, p2 = self._end(end_1, what), self._end(end_2, what)
        first, second = body_and_point(end_1, what)[0], body_and_point(end_2, what)[0]
        if not isinstance(first, FlexibleBody):  # which has many nodes
            different(first, second, what)
        if stops is not None:
            instance_of(EndStops, stops, f"The stops of {what}", "EndStops")
        gap = p2 - p1
        if free_length is None:
            free_length = float(np.linalg.norm(gap.value(self.drawn())))
        return self.add(SpringDamper(stiffness, damping, free_length, stops).record(name, gap))

    def torsional_spring_damper(
        self, name: str, angle: Coordinate, *, stiffness: float, damping: float = 0.0, free_angle: float = 0.0
    ) -> ElementRecord:
        """Spring and damper on a relative angle.

        Parameters
        ----------
        angle : Coordinate
            A relative angle, or an expression of coordinates.
        stiffness, damping : float
            N m/rad and N m s/rad.
        free_angle : float
            Angle without spring torque, rad.
        """
        expression = self.expression(angle, f"The torsional spring-damper '{name}'")
        return self.add(ScalarSpringDamper(stiffness, damping, free_angle).record(name, expression))

    def force(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        *,
        inputs: Sequence[Input | None],
        axes: Literal["earth", "body"] = "earth",
    ) -> ElementRecord:
        """Force at a point from one input per component.

        Parameters
        ----------
        point : array_like, shape (dimension,), optional
            Earth axes in the reference configuration, m; by default the centre of mass.
        inputs : sequence of Input or None
            One per component, N; None: no force along that axis.
        axes : {"earth", "body"}
            Axes of the components.
        """
        what = f"force '{name}'"
        self.owned(body, f"The {what}")
        p = self._end((body, body.com if point is None else point), what)
        e = np.eye(self.dimension)[: 3 if self.dimension == 3 else 1]
        one_of(axes, ("earth", "body"), f"The axes of {what}")
        frame = [AffineVector.constant(u) if axes == "earth" else body.vector(u) for u in e]
        return self.add(BodyForce(self._numbers(inputs, self.dimension, what)).record(name, p, frame))

    def torque(
        self, name: str, body: Body, *, inputs: Sequence[Input | None] | Input, axes: Literal["earth", "body"] = "earth"
    ) -> ElementRecord:
        """Torque on a body from one input per component.

        Parameters
        ----------
        body : Body
            A rigid body or a node of a flexible one.
        inputs : sequence of Input or None, or Input
            Three in space, one in the plane, N m; None: no torque about that axis.
        axes : {"earth", "body"}
            Axes of the components.

        Raises
        ------
        ModelError
            The body is the ground or a point mass.
        """
        what = f"torque '{name}'"
        self.owned(body, f"The {what}")
        if body.is_ground or body.is_point:
            raise ModelError(f"The {what} needs a rigid body, not '{body.name}'.")
        channels = [inputs] if isinstance(inputs, Input) else inputs
        count = 3 if self.dimension == 3 else 1
        numbers = self._numbers(channels, count, what)
        one_of(axes, ("earth", "body"), f"The axes of {what}")
        frame = [body.vector(u) for u in np.eye(self.dimension)[:count]]
        return self.add(BodyTorque(numbers, axes).record(name, frame))

    def torque_on(self, name: str, angle: Coordinate, *, input: Input, gain: float = 1.0) -> ElementRecord:
        """Torque on a relative angle or a spin; the first body of the angle or the carrier of the spin takes the
        reaction.

        Parameters
        ----------
        angle : Coordinate
            A relative angle, an expression of coordinates, or a spin.
        gain : float
            The torque is ``gain * input``, N m.
        """
        what = f"torque '{name}'"
        expression = self.expression(angle, f"The {what}")
        channel = owned_input(self, input, f"The {what}")
        factor = number(gain, f"The gain of {what}")
        if isinstance(angle, Spin):
            return self.add(SpinTorque(channel.index, factor).record(name, angle.f, angle.g, angle.affine))
        return self.add(InputForce(channel.index, (factor,)).record(name, [expression]))

    def drag(
        self,
        name: str,
        body: Body,
        point: ArrayLike,
        *,
        drag_area: float,
        air_density: float = 1.225,
        wind: Wind | None = None,
    ) -> ElementRecord:
        """Aerodynamic drag at a point.

        Parameters
        ----------
        point : array_like, shape (dimension,)
            Earth axes in the reference configuration, m.
        drag_area : float
            Drag coefficient times frontal area, m2.
        air_density : float
            kg/m3.
        wind : Wind, optional
            How the air moves; by default it is still.
        """
        self.owned(body, f"The drag '{name}'")
        air = Drag(drag_area, air_density) if wind is None else WindDrag(drag_area, air_density, wind=wind)
        return self._add_in_air(air.record(name, self._end((body, point), f"drag '{name}'")), "drag")

    def lift(
        self,
        name: str,
        body: Body,
        point: ArrayLike,
        *,
        forward: ArrayLike,
        up: ArrayLike,
        lift_area: float,
        air_density: float = 1.225,
        wind: Wind | None = None,
    ) -> ElementRecord:
        """Aerodynamic lift at a point, along an axis of the body.

        Parameters
        ----------
        point : array_like, shape (dimension,)
            Earth axes in the reference configuration, m.
        forward, up : array_like, shape (dimension,)
            Axes of the body, as drawn, of any length: lift goes with the square of the point's speed along the first
            and acts along the second.
        lift_area : float
            Lift coefficient times frontal area, m2; negative: downforce.
        air_density : float
            kg/m3.
        wind : Wind, optional
            How the air moves; by default it is still.

        Raises
        ------
        ModelError
            An axis is zero.
        """
        what = f"lift '{name}'"
        owned = self.owned(body, f"The {what}")
        front, top = (
            owned.vector(direction(axis, self.dimension, f"the {word} axis of {what}"))
            for axis, word in ((forward, "forward"), (up, "upward"))
        )
        made = Lift(lift_area, air_density).record(name, self._end((body, point), what), front, top, wind)
        return self._add_in_air(made, "lift")

    def road(self, road: Road | RoadFile, *, file: str | None = None) -> int:
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
        kinds = (PlaneRoad, KerbRoad, GridRoad, PortRoad, RoadFile)
        instance_of(
            kinds, road, f"A road of model '{self.name}'", "a PlaneRoad, KerbRoad, GridRoad, PortRoad or RoadFile"
        )
        k, start = len(self.roads), ""
        if isinstance(road, RoadFile):
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
        contact : ContactPoints
            How it touches.
        """
        place = array(point, (3,), f"the place of contact point {shown(name)}")
        return self.contact_points(name, body, place[None], road=road, contact=contact)

    def _add_in_air(self, made: ElementRecord, kind: str) -> ElementRecord:
        """Add an element of the air, whose integers are the inputs of its wind."""
        if max(made.integer, default=-1) >= len(self.inputs):
            raise ModelError(
                f"The wind of {kind} '{made.name}' has the inputs {list(made.integer)}, but the model '{self.name}' "
                f"has {len(self.inputs)}, counted from 0."
            )
        return self.add(made)

    def _end(self, end: FixedEnd, what: str) -> AffineVector:
        body, point = body_and_point(end, what)
        return self.owned(body, f"The {what}").point(point)

    def _numbers(self, inputs: Sequence[Input | None], count: int, what: str) -> list[int | None]:
        """Numbers of the inputs, one per component."""
        if not isinstance(inputs, (list, tuple)):
            raise ModelError(f"The inputs of {what} must be {count} inputs or None, not {shown(inputs)}.")
        if len(inputs) != count:
            raise ModelError(f"The {what} has {len(inputs)} inputs; it needs {count}, None where there is none.")
        return [None if i is None else owned_input(self, i, f"The {what}").index for i in inputs]
