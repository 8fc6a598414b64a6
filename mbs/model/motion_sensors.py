"""Sensors of motion: places, distances, directions and coordinates, and their rates."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import number, shown
from mbs.common.errors import ModelError
from mbs.elements.spin_angle import SpinAngle
from mbs.kernel.header import SensorType
from mbs.model.body import Body
from mbs.model.carried import Spin
from mbs.model.coordinate import Coordinate
from mbs.model.sensor import Sensor
from mbs.model.sensors import RATE_UNITS, SIGNALS, SensorBase, component_number, order_number, spatial


class MotionSensorVocabulary(SensorBase):
    """What can be read of the motion. Values are in SI units; a unit that is given is only written to files."""

    def sense_position(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        component: str = "x",
        axes: Body | str = "earth",
        unit: str = "m",
        description: str = "",
    ) -> Sensor:
        """Component of the position of a point, m.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            Of this model.
        point : array_like, shape (dimension,), optional
            Earth axes in the reference configuration, m; by default the centre of mass.
        component : {"x", "y", "z"}
            Along which axis.
        axes : {"earth", "body"} or Body
            Earth axes, or the moving axes of the body or of another one.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, a body is not of this model, or the component or the axes are none.
        """
        return self._moving(name, body, point, component, axes, 0, unit, description)

    def sense_velocity(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        component: str = "x",
        axes: Body | str = "earth",
        unit: str = "m/s",
        description: str = "",
    ) -> Sensor:
        """Component of the velocity of a point, m/s.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            Of this model.
        point : array_like, shape (dimension,), optional
            Earth axes in the reference configuration, m; by default the centre of mass.
        component : {"x", "y", "z"}
            Along which axis.
        axes : {"earth", "body"} or Body
            Earth axes, or the moving axes of the body or of another one.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, a body is not of this model, or the component or the axes are none.
        """
        return self._moving(name, body, point, component, axes, 1, unit, description)

    def sense_acceleration(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        component: str = "x",
        axes: Body | str = "earth",
        unit: str = "m/s2",
        description: str = "",
    ) -> Sensor:
        """Component of the acceleration of a point without that of gravity, m/s2.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        body : Body
            Of this model.
        point : array_like, shape (dimension,), optional
            Earth axes in the reference configuration, m; by default the centre of mass.
        component : {"x", "y", "z"}
            Along which axis.
        axes : {"earth", "body"} or Body
            Earth axes, or the moving axes of the body or of another one.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, a body is not of this model, or the component or the axes are none.
        """
        return self._moving(name, body, point, component, axes, 2, unit, description)

    def sense_component(
        self, name: str, vector: AffineVector, axis: AffineVector, order: int = 0, unit: str = "", description: str = ""
    ) -> Sensor:
        """Component of a vector between points, or of one of its rates, along a moving axis.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        vector : AffineVector
            Such as ``body_1.point(p) - body_2.point(q)``, m.
        axis : AffineVector
            A unit vector of a body, such as ``body.vector((1, 0, 0))``.
        order : {0, 1, 2}
            Of the vector, its rate or its second rate in the earth.
        unit, description : str
            For files, plots and hosts; by default m, m/s or m/s2.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, the vectors are not of this model, or the order is none.
        """
        what = f"sensor '{name}'"
        k = order_number(order, 2, what)
        signals = [
            *spatial(self.expressions(vector, f"The {what}")),
            *spatial(self.expressions(axis, f"The {what}")),
        ]
        return self._sense(
            name, self._unit(unit, RATE_UNITS["m"][k]), description, SensorType.COMPONENT, signals, integers=[k]
        )

    def sense_coordinate(
        self,
        name: str,
        coordinate: Coordinate | Affine,
        order: int = 0,
        scale: float = 1.0,
        unit: str = "",
        description: str = "",
        display_unit: str = "",
    ) -> Sensor:
        """A coordinate or an expression of coordinates, or one of its rates.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        coordinate : Coordinate or Affine
            A relative angle, a spin, or an expression such as ``body.point(p)[2]``.
        order : {0, 1, 2}
            The value, its rate or its second rate.
        scale : float
            Factor on it.
        unit, description : str
            For files, plots and hosts; by default that of the coordinate, "1" of an expression.
        display_unit : str
            What engineers read it in, if that is not the unit.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, the coordinate is not of this model, or the order is none.
        """
        k = order_number(order, 2, f"sensor '{name}'")
        expression = self.expression(coordinate, f"The sensor '{name}'")
        unit = self._unit(unit, RATE_UNITS[coordinate.unit][k] if isinstance(coordinate, Coordinate) else "1")
        factor = number(scale, f"The scale of sensor '{name}'")
        return self._sense(name, unit, description, SIGNALS[k], [expression], reals=[factor], display_unit=display_unit)

    def sense_spin_angle(self, name: str, spin: Spin, unit: str = "rad", description: str = "") -> Sensor:
        """Angle by which a wheel of `Model.spin` has turned on its carrier since the start, rad, not wrapped.

        0 at the start, positive as the rate of the spin counts. The wheel is oriented like its carrier after a turn by
        the angle about the axis. The coordinate of the spin is not that angle: its rate is the absolute one. The first
        call for a spin adds an element without force, whose states sum the angle over the steps; methods for Systems
        without states then do not apply.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        spin : Spin
            Of this model.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, or the spin is not one of this model.
        """
        if not isinstance(spin, Spin):
            raise ModelError(f"The sensor '{name}' needs a spin, got {shown(spin)}.")
        self.owned_coordinate(spin, f"The sensor '{name}'")
        element = f"{spin.name}.angle"
        known = [record.name for record in self.elements]
        if element not in known:
            self.add(SpinAngle().record(element, spin.f, spin.g, spin.affine))
            known.append(element)
        return self._sense(
            name, unit, description, SensorType.ELEMENT_OUTPUT, integers=[known.index(element), 0], reals=[1.0]
        )

    def sense_norm(
        self, name: str, vector: AffineVector, order: int = 0, unit: str = "", description: str = ""
    ) -> Sensor:
        """Length of a vector or of its rate: the distance of two points, the speed of a point.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        vector : AffineVector
            A point, or a difference of points, m.
        order : {0, 1}
            Of the vector or of its rate in the earth.
        unit, description : str
            For files, plots and hosts; by default m or m/s.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, the vector is not of this model, or the order is none.
        """
        k = order_number(order, 1, f"sensor '{name}'")
        signals = list(self.expressions(vector, f"The sensor '{name}'").components)
        return self._sense(
            name, self._unit(unit, RATE_UNITS["m"][k]), description, SensorType.NORM, signals, integers=[k, len(vector)]
        )

    def sense_direction(
        self,
        name: str,
        point: AffineVector,
        axis_1: AffineVector,
        axis_2: AffineVector,
        order: int = 1,
        unit: str = "rad",
        description: str = "",
    ) -> Sensor:
        """Direction of the velocity of a point in moving axes, atan2(axis_2 . v, axis_1 . v), rad: a side-slip angle.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        point : AffineVector
            Such as ``body.point(p)``.
        axis_1, axis_2 : AffineVector
            Unit vectors of a body, square to each other.
        order : {0, 1}
            Direction of the vector itself, or of its rate.
        unit, description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, a vector is not of this model, or the order is none.
        """
        what = f"sensor '{name}'"
        k = order_number(order, 1, what)
        signals = [s for v in (point, axis_1, axis_2) for s in spatial(self.expressions(v, f"The {what}"))]
        return self._sense(name, unit, description, SensorType.DIRECTION, signals, integers=[k])

    def _moving(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None,
        component: str,
        axes: Body | str,
        order: int,
        unit: str,
        description: str,
    ) -> Sensor:
        what = f"sensor '{name}'"
        p = self.owned(body, f"The {what}").point(body.com if point is None else point)
        k = component_number(component, self.dimension, what)
        if isinstance(axes, str) and axes == "earth":
            return self._sense(name, unit, description, SIGNALS[order], [p[k]], reals=[1.0])
        if (isinstance(axes, str) and axes != "body") or not isinstance(axes, (str, Body)):
            raise ModelError(f"The axes of {what} are {shown(axes)}; they must be 'earth', 'body' or a body.")
        turning = body if isinstance(axes, str) else self.owned(axes, f"The {what}")
        axis = turning.vector(np.eye(self.dimension)[k])
        return self._sense(
            name, unit, description, SensorType.COMPONENT, [*spatial(p), *spatial(axis)], integers=[order]
        )
