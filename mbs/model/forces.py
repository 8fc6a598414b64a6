"""Force elements by name: thin wrappers around the records of `mbs.elements`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from mbs.affine import AffineVector
from mbs.elements.body_force import BodyForce
from mbs.elements.body_torque import BodyTorque
from mbs.elements.contact_points import ContactPoints
from mbs.elements.drag import Drag
from mbs.elements.input_force import InputForce
from mbs.elements.record import ElementRecord
from mbs.elements.road import Road
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.elements.spin_torque import SpinTorque
from mbs.elements.spring_damper import EndStops, SpringDamper
from mbs.errors import ModelError
from mbs.model.body import Body
from mbs.model.core import Coordinate, ModelCore
from mbs.model.inputs import Input, owned_input
from mbs.model.spin import Spin


class ForceVocabulary(ModelCore):
    """Springs, forces and torques of a model; each method returns the record of its element."""

    def spring_damper(
        self,
        name: str,
        end_1: Any,
        end_2: Any,
        *,
        stiffness: float,
        damping: float = 0.0,
        free_length: float | None = None,
        stops: EndStops | None = None,
    ) -> ElementRecord:
        """Spring and damper between two points; ends are (body, point) or a point mass.

        Parameters
        ----------
        stiffness, damping : float
            N/m and N s/m.
        free_length : float, optional
            m; by default as drawn.
        stops : EndStops, optional
            Bump and rebound stops.
        """
        p1, p2 = self._end(end_1, f"spring-damper '{name}'"), self._end(end_2, f"spring-damper '{name}'")
        gap = p2 - p1
        if free_length is None:
            free_length = float(np.linalg.norm(gap.value(np.array([c.reference for c in self.coordinates]))))
        return self.add(SpringDamper(stiffness, damping, free_length, stops).record(name, gap))

    def torsional_spring_damper(
        self, name: str, angle: Coordinate, *, stiffness: float, damping: float = 0.0, free_angle: float = 0.0
    ) -> ElementRecord:
        """Spring and damper on a relative angle; N m/rad, N m s/rad, rad."""
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
        """Force at a point (default: centre of mass) from one input per component, N; None: none along that axis."""
        what = f"force '{name}'"
        p = self._end((body, body.com if point is None else point), what)
        e = np.eye(self.dimension)[: 3 if self.dimension == 3 else 1]
        if axes not in ("earth", "body"):
            raise ModelError(f"The axes of {what} are {axes!r}; they must be 'earth' or 'body'.")
        frame = [AffineVector.constant(u) if axes == "earth" else body.vector(u) for u in e]
        return self.add(BodyForce(self._numbers(inputs, self.dimension, what)).record(name, p, frame))

    def torque(
        self, name: str, body: Body, *, inputs: Sequence[Input | None] | Input, axes: Literal["earth", "body"] = "earth"
    ) -> ElementRecord:
        """Torque on a body from one input per component (planar: one input), N m; None: none about that axis."""
        what = f"torque '{name}'"
        self.owned(body, f"The {what}")
        if body.is_ground or body.is_point:
            raise ModelError(f"The {what} needs a rigid body, not '{body.name}'.")
        channels = [inputs] if isinstance(inputs, Input) else inputs
        count = 3 if self.dimension == 3 else 1
        frame = [body.vector(u) for u in np.eye(self.dimension)[:count]]
        return self.add(BodyTorque(self._numbers(channels, count, what), axes).record(name, frame))

    def torque_on(self, name: str, angle: Coordinate, *, input: Input, gain: float = 1.0) -> ElementRecord:
        """Torque ``gain * input``, N m, on a relative angle or a spin; the first body of the angle or the carrier of
        the spin takes the reaction.
        """
        what = f"torque '{name}'"
        expression = self.expression(angle, f"The {what}")
        channel = owned_input(self, input, f"The {what}")
        if isinstance(angle, Spin):
            return self.add(SpinTorque(channel.index, gain).record(name, angle.f, angle.g, angle.affine))
        return self.add(InputForce(channel.index, (gain,)).record(name, [expression]))

    def drag(
        self, name: str, body: Body, point: ArrayLike, *, drag_area: float, air_density: float = 1.225
    ) -> ElementRecord:
        """Aerodynamic drag in still air at a point; drag area (coefficient times frontal area) in m2."""
        return self.add(Drag(drag_area, air_density).record(name, self._end((body, point), f"drag '{name}'")))

    def road(self, road: Road) -> int:
        """Add a road; the number is what a tyre asks for."""
        self.roads.append(road)
        return len(self.roads) - 1

    def contact_points(
        self, name: str, body: Body, points: ArrayLike, *, road: int, contact: ContactPoints
    ) -> ElementRecord:
        """Points of a body that touch a road, with friction.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            Earth axes in the reference configuration, m.
        road : int
            Number of the road.
        contact : ContactPoints
            How they touch; `ContactPoints.for_mass` chooses numbers.
        """
        what = f"contact points '{name}'"
        self.owned(body, f"The {what}")
        if self.dimension != 3 or body.is_ground or body.is_point or body.is_flexible:
            raise ModelError(f"The {what} need a rigid body in space, not '{body.name}'.")
        if not 0 <= road < len(self.roads):
            raise ModelError(f"The {what} ask for road {road!r}; the model has {len(self.roads)}.")
        places = np.array(points, dtype=float)
        if places.ndim != 2 or places.shape[1:] != (3,):
            raise ModelError(f"The places of {what} have shape {places.shape}; they need (n, 3).")
        axes = [body.vector(v) for v in np.eye(3)]
        return self.add(contact.record(name, body.point(body.com), axes, places - body.com, road))

    def contact_point(
        self, name: str, body: Body, point: ArrayLike, *, road: int, contact: ContactPoints
    ) -> ElementRecord:
        """One point of a body (earth axes, reference configuration, m) that touches a road; see `contact_points`."""
        return self.contact_points(name, body, np.atleast_2d(np.asarray(point, float)), road=road, contact=contact)

    def _end(self, end: Any, what: str) -> AffineVector:
        if isinstance(end, Body) and end.is_point:
            end = (end, None)
        try:
            body, point = end
        except (TypeError, ValueError):
            raise ModelError(f"An end of {what} must be (body, point) or a point mass; got {end!r}.") from None
        return self.owned(body, f"The {what}").point(point)

    def _numbers(self, inputs: Sequence[Input | None], count: int, what: str) -> list[int | None]:
        if len(inputs) != count:
            raise ModelError(f"The {what} has {len(inputs)} inputs; it needs {count}, None where there is none.")
        return [None if i is None else owned_input(self, i, f"The {what}").index for i in inputs]
