"""Interface of the chassis for other parts of the car, the same at every fidelity."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import vector
from mbs.model.body import Body
from mbs.model.joint_ends import End
from mbs.model.model import Model
from mbs.vehicle.chassis.section import Chassis
from mbs.vehicle.side import Point, Side


class LeverCarrier(Body):
    """A flexible chassis for levers: its points are joints of the frame, its axes belong to the mean frame.

    A moment of a lever on the axes acts on the frame as forces at the joints of the suspension. At a single node it
    would act as a torque, which the bushes of the lever do not transmit.

    `axes`: x, y and z axis.
    """

    is_flexible = True

    def __init__(self, chassis: Body, axes: list[AffineVector]) -> None:
        super().__init__(chassis.model, chassis.name, chassis.com, chassis.start)
        self._chassis, self._axes = chassis, axes

    def point(self, position: ArrayLike) -> AffineVector:
        """Point of the chassis. `position`: earth axes in the reference configuration, m, shape (3,)."""
        return self._chassis.point(position)

    def vector(self, components: ArrayLike) -> AffineVector:
        """Vector in the mean axes. `components`: earth axes in the reference configuration, shape (3,)."""
        x, y, z = (float(v) for v in vector(components, 3, "a vector of the chassis"))
        return self._axes[0] * x + self._axes[1] * y + self._axes[2] * z


@dataclass(frozen=True)
class Mount:
    """The chassis in a model."""

    body: Body
    """Body for joints and springs."""
    frame: Body
    """Rigid body or floating frame, whose axes and points do not deform."""
    accelerated: Body
    """Body of the accelerometers."""
    origin: tuple[float, float, float]
    """Reference point as drawn, m."""
    drive_axes: tuple[AffineVector, AffineVector]
    """z and x axes on which the reaction of the drive acts."""
    contact_frame: tuple[AffineVector, list[AffineVector], np.ndarray]
    """Origin, axes, and position of the origin as drawn, m, on which forces of the ground and of payloads act."""

    def place(self, point: ArrayLike) -> AffineVector:
        """Point of the contact frame, on which forces act at any fidelity. `point`: position as drawn, m, shape
        (3,)."""
        origin, axes, position = self.contact_frame
        x, y, z = (float(v) for v in np.subtract(vector(point, 3, "a point of the chassis"), position))
        return origin + axes[0] * x + axes[1] * y + axes[2] * z

    def fixed_end(self, side: Side, point: Point) -> End:
        """End of a rod on the chassis, as `TieRodEnd` gives it."""
        return self.body, point

    @property
    def rigid(self) -> bool:
        """Whether the chassis is one rigid body without ports."""
        return self.body is self.frame

    @property
    def lever_carrier(self) -> Body:
        """Body on which levers of anti-roll bars turn."""
        return self.body if self.rigid else LeverCarrier(self.body, self.contact_frame[1])


def rigid_chassis(m: Model, data: Chassis) -> Mount:
    """Add the chassis as one rigid body."""
    rigid = m.body("chassis", mass=data.mass, com=data.com, inertia=data.tensor)
    axes = rigid.vector((0.0, 0.0, 1.0)), rigid.vector((1.0, 0.0, 0.0))
    frame = rigid.point(rigid.com), [rigid.vector(v) for v in np.eye(3)], rigid.com
    return Mount(rigid, rigid, rigid, data.reference, axes, frame)
