"""Forces and torques by name: thin wrappers around the records of `mbs.elements`."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import number, one_of, shown
from mbs.common.errors import ModelError
from mbs.elements.body_force import BodyForce
from mbs.elements.body_torque import BodyTorque
from mbs.elements.input_force import InputForce
from mbs.elements.record import ElementRecord
from mbs.elements.spin_torque import SpinTorque
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.coordinate import Coordinate
from mbs.model.inputs import owned_input
from mbs.model.records import Input


class ForceVocabulary(BodyVocabulary):
    """Forces and torques of a model; each method returns the record of its element, for sensors."""

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
        subject = f"force '{name}'"
        self.owned(body, f"The {subject}")
        p = self._end((body, body.com if point is None else point), subject)
        e = np.eye(self.dimension)[: 3 if self.dimension == 3 else 1]
        one_of(axes, ("earth", "body"), f"The axes of {subject}")
        frame = [AffineVector.constant(u) if axes == "earth" else body.vector(u) for u in e]
        return self.add(BodyForce(self._numbers(inputs, self.dimension, subject)).record(name, p, frame))

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
        subject = f"torque '{name}'"
        self.owned(body, f"The {subject}")
        if body.is_ground or body.is_point:
            raise ModelError(f"The {subject} needs a rigid body, not '{body.name}'.")
        channels = [inputs] if isinstance(inputs, Input) else inputs
        count = 3 if self.dimension == 3 else 1
        numbers = self._numbers(channels, count, subject)
        one_of(axes, ("earth", "body"), f"The axes of {subject}")
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
        subject = f"torque '{name}'"
        expression = self.expression(angle, f"The {subject}")
        channel = owned_input(self, input, f"The {subject}")
        factor = number(gain, f"The gain of {subject}")
        if isinstance(angle, Spin):
            return self.add(SpinTorque(channel.index, factor).record(name, angle.f, angle.g, angle.affine))
        return self.add(InputForce(channel.index, (factor,)).record(name, [expression]))

    def _numbers(self, inputs: Sequence[Input | None], count: int, subject: str) -> list[int | None]:
        """Numbers of the inputs, one per component."""
        if not isinstance(inputs, (list, tuple)):
            raise ModelError(f"The inputs of {subject} must be {count} inputs or None, not {shown(inputs)}.")
        if len(inputs) != count:
            raise ModelError(f"The {subject} has {len(inputs)} inputs; it needs {count}, None where there is none.")
        return [None if i is None else owned_input(self, i, f"The {subject}").index for i in inputs]
