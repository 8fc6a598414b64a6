"""Sensors of orientation: angles of bodies and between vectors, and angular rates."""

from __future__ import annotations

import numpy as np

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import one_of
from mbs.common.errors import ModelError
from mbs.kernel.header import SensorType
from mbs.model.body import Body
from mbs.model.sensor import Sensor
from mbs.model.sensors import SensorBase, component_number, spatial


class OrientationSensorVocabulary(SensorBase):
    """What can be read of the orientation. Values are in SI units; a unit that is given is only written to files."""

    def sense_angular_rate(
        self, name: str, body: Body, component: str = "z", unit: str = "rad/s", description: str = ""
    ) -> Sensor:
        """Component of the angular velocity of a body in its own axes, rad/s.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            A rigid body, a node of a flexible one or the frame of it.
        component : {"x", "y", "z"}
            Along which axis of the body: the earth axes in the reference configuration. In the plane it is z.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, the body has no axes or is not of this model, or the component is none.
        """
        self.owned(body, f"The sensor '{name}'")
        k = component_number("z" if self.dimension == 2 else component, 3, f"sensor '{name}'")
        e = np.eye(self.dimension)
        a, b = body.vector(e[(k + 1) % 3]), body.vector(e[(k + 2) % 3])
        return self._sense(name, unit, description, SensorType.ANGULAR_RATE, [*spatial(a), *spatial(b)], reals=[1.0])

    def sense_yaw(self, name: str, body: Body, unit: str = "rad", description: str = "") -> Sensor:
        """Angle of a body's x axis in the earth's x-y plane, rad; in the plane its rotation.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            With axes.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, or the body has no axes or is not of this model.
        """
        a = self.owned(body, f"The sensor '{name}'").vector(np.eye(self.dimension)[0])
        return self._sense(name, unit, description, SensorType.ANGLE, [a[1], a[0]])

    def sense_pitch(self, name: str, body: Body, unit: str = "rad", description: str = "") -> Sensor:
        """Minus the arcsine of the z component of a body's x axis, rad: positive nose down.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            With axes, in a spatial model.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The model is planar, the name is taken, or the body has no axes or is not of this model.
        """
        self._spatial_only(name)
        x = self.owned(body, f"The sensor '{name}'").vector((1.0, 0.0, 0.0))
        return self._sense(name, unit, description, SensorType.PITCH, [x[2]])

    def sense_roll(self, name: str, body: Body, unit: str = "rad", description: str = "") -> Sensor:
        """Arctangent of the z components of a body's y and z axes, rad: positive left side up.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            With axes, in a spatial model.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The model is planar, the name is taken, or the body has no axes or is not of this model.
        """
        self._spatial_only(name)
        self.owned(body, f"The sensor '{name}'")
        signals = [body.vector((0.0, 1.0, 0.0))[2], body.vector((0.0, 0.0, 1.0))[2]]
        return self._sense(name, unit, description, SensorType.ANGLE, signals)

    def sense_quaternion(
        self, name: str, body: Body, component: str = "w", unit: str = "1", description: str = ""
    ) -> Sensor:
        """Component of the orientation quaternion of a body.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            With axes; in the plane it turns about z.
        component : {"w", "x", "y", "z"}
            The scalar part is w.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, the component is none, or the body has no axes or is not of this model.
        """
        one_of(component, ("w", "x", "y", "z"), f"The component of sensor '{name}'")
        self.owned(body, f"The sensor '{name}'")
        if self.dimension == 2:
            nought, one = Affine({}, 0.0), Affine({}, 1.0)
            in_plane = [[*body.vector(e).components, nought] for e in np.eye(2)]
            axes = [*in_plane[0], *in_plane[1], nought, nought, one]
        else:
            axes = [s for e in np.eye(3) for s in body.vector(e).components]
        return self._sense(name, unit, description, SensorType.QUATERNION, axes, integers=["wxyz".index(component)])

    def sense_angle_between(
        self, name: str, a: AffineVector, b: AffineVector, c: AffineVector, unit: str = "rad", description: str = ""
    ) -> Sensor:
        """Angle from one vector to another about a third, atan2((b x a) . c, a . b), rad.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        a, b, c : AffineVector
            Vectors of bodies in space: the angle is from b to a about c.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, or a vector is not of this model.
        """
        signals = [s for v in (a, b, c) for s in spatial(self.expressions(v, f"The sensor '{name}'"))]
        return self._sense(name, unit, description, SensorType.ANGLE_ABOUT, signals)

    def _spatial_only(self, name: str) -> None:
        if self.dimension == 2:
            raise ModelError(f"The sensor '{name}' needs a spatial model; in the plane use sense_yaw.")
