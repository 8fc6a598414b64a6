"""Springs and dampers by name: thin wrappers around the records of `mbs.elements`."""

import numpy as np

from mbs.common.checks import instance_of
from mbs.elements.record import ElementRecord
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.elements.spring_damper import EndStops, SpringDamper
from mbs.model.bodies import BodyVocabulary
from mbs.model.coordinate import Coordinate
from mbs.model.joint_ends import FixedEnd, body_and_point, different


class SpringVocabulary(BodyVocabulary):
    """Springs of a model; each method returns the record of its element, for sensors."""

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

        Raises
        ------
        ModelError
            Both ends are on the same body.
        """
        subject = f"spring-damper '{name}'"
        p1, p2 = self._end(end_1, subject), self._end(end_2, subject)
        first, second = body_and_point(end_1, subject)[0], body_and_point(end_2, subject)[0]
        if first.flexibility is None:  # which has many nodes
            different(first, second, subject)
        if stops is not None:
            instance_of(EndStops, stops, f"The stops of {subject}", "EndStops")
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
