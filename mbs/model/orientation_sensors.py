"""Sensors of orientation: rotation of bodies, and angles."""

import numpy as np

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import one_of, shown
from mbs.common.errors import ModelError
from mbs.elements.spin_angle import SpinAngle
from mbs.kernel.header.enumerations import SensorType
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.sensor import Sensor
from mbs.model.sensor_arguments import component_number
from mbs.model.sensors import SensorVocabulary, order_number, spatial


class OrientationSensorVocabulary(SensorVocabulary):
    """Sensors of orientation. A body is a rigid one, or a node or the frame of a flexible one."""

    def sense_rotation(
        self, name: str, body: Body, component: str = "z", *, order: int = 0, unit: str = "", description: str = ""
    ) -> Sensor:
        """Component of the orientation quaternion of a body, or of its angular velocity in its own axes, rad/s.

        Parameters
        ----------
        component : {"w", "x", "y", "z"}
            Of the quaternion, whose scalar part is w; or of the angular velocity, along axes of the body that are those
            of the earth in the reference configuration. In the plane a body turns about z.
        order : {0, 1}
            Quaternion or angular velocity.

        Raises
        ------
        ModelError
            The body has no axes.
        """
        subject = f"sensor '{name}'"
        rate = order_number(order, 1, subject)
        self.owned(body, f"The {subject}")
        e = np.eye(self.dimension)
        if rate:
            if self.dimension == 2 and component != "z":
                raise ModelError(f"The component of {subject} is {shown(component)}; in the plane it must be 'z'.")
            k = component_number(component, 3, subject)
            signals = [s for i in (k + 1, k + 2) for s in spatial(body.vector(e[i % 3]))]
            unit = self._unit(unit, "rad/s")
            return self._sense(name, unit, description, SensorType.ANGULAR_RATE, signals, reals=[1.0])
        one_of(component, ("w", "x", "y", "z"), f"The component of {subject}")
        axes = [s for axis in e for s in spatial(body.vector(axis))]
        if self.dimension == 2:
            axes += [Affine(), Affine(), Affine({}, 1.0)]
        unit = self._unit(unit, "1")
        return self._sense(name, unit, description, SensorType.QUATERNION, axes, integers=["wxyz".index(component)])

    def sense_angle(
        self,
        name: str,
        of: Body | Spin | tuple[AffineVector, AffineVector, AffineVector],
        kind: str = "",
        *,
        unit: str = "rad",
        description: str = "",
    ) -> Sensor:
        """Angle of a body relative to the earth, of a wheel relative to its carrier, or between vectors, rad.

        The angle of a wheel is 0 at the start, positive as the rate of the spin counts, and not wrapped: the wheel is
        oriented like its carrier after a turn by it. (The coordinate of a spin differs: its rate is the absolute one.)
        The first call for a spin adds an element without force, whose states sum the angle step by step; methods for
        Systems without states then do not apply.

        Parameters
        ----------
        of : Body, Spin or (AffineVector, AffineVector, AffineVector)
            A body; a wheel of `Model.spin`; or vectors a, b, c in space for the angle from b to a about c,
            ``atan2((b x a) . c, a . b)``.
        kind : {"yaw", "pitch", "roll"}
            Of a body only, as ISO 8855 has them. Yaw: of its x axis in the earth's x-y plane, in the plane its
            rotation. Pitch: minus the arcsine of the z component of its x axis, positive nose down. Roll: the
            arctangent of the z components of its y and z axes, positive left side up.

        Raises
        ------
        ModelError
            The body has no axes, or this angle does not exist for it.
        """
        subject = f"The sensor '{name}'"
        if isinstance(of, Body):
            return self._cardan(name, of, kind, unit, description)
        if not isinstance(kind, str) or kind:
            raise ModelError(f"{subject} asks for {shown(kind)} of {shown(of)}; only bodies have yaw, pitch and roll.")
        if isinstance(of, Spin):
            self.owned_coordinate(of, subject)
            integers = [self._spin_angle_element(of), 0]
            return self._sense(name, unit, description, SensorType.ELEMENT_OUTPUT, integers=integers, reals=[1.0])
        if not isinstance(of, (list, tuple)) or len(of) != 3:
            raise ModelError(f"{subject} needs a body, a spin or three vectors, got {shown(of)}.")
        signals = [s for v in of for s in spatial(self.expressions(v, subject))]
        return self._sense(name, unit, description, SensorType.ANGLE_ABOUT, signals)

    def _spin_angle_element(self, spin: Spin) -> int:
        """Number of the element that sums the angle of a spin; it is added by the first call."""
        name, names = f"{spin.name}.angle", [record.name for record in self.elements]
        if name in names:
            return names.index(name)
        self.add(SpinAngle().record(name, spin.f, spin.g, spin.affine))
        return len(names)

    def _cardan(self, name: str, body: Body, kind: str, unit: str, description: str) -> Sensor:
        """Yaw, pitch or roll of a body."""
        one_of(kind, ("yaw", "pitch", "roll"), f"The kind of sensor '{name}'")
        self.owned(body, f"The sensor '{name}'")
        if self.dimension == 2 and kind != "yaw":
            raise ModelError(f"The sensor '{name}' needs a spatial model; in the plane a body has yaw only.")
        e = np.eye(self.dimension)
        x = body.vector(e[0])
        if kind == "yaw":
            return self._sense(name, unit, description, SensorType.ANGLE, [x[1], x[0]])
        if kind == "pitch":
            return self._sense(name, unit, description, SensorType.PITCH, [x[2]])
        return self._sense(name, unit, description, SensorType.ANGLE, [body.vector(e[1])[2], body.vector(e[2])[2]])
