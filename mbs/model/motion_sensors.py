"""Sensors of points and coordinates, and their rates."""

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import number, shown
from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import SensorType
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.sensor import Sensor
from mbs.model.sensor_arguments import component_number
from mbs.model.sensors import RATE_UNITS, SensorVocabulary, order_number, spatial

SIGNALS = (SensorType.SIGNAL, SensorType.SIGNAL_RATE, SensorType.SIGNAL_SECOND_RATE)


class MotionSensorVocabulary(SensorVocabulary):
    """Sensors of positions, orientations, their rates, and coordinates."""

    def sense_position(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        component: str = "x",
        axes: Body | str = "earth",
        *,
        order: int = 0,
        unit: str = "",
        description: str = "",
    ) -> Sensor:
        """Component of the position of a point, m, of its velocity, m/s, or of its acceleration, m/s2.

        Velocity and acceleration are relative to the earth, resolved along the axes; the acceleration does not include
        gravity. A node of a flexible body is read without coordinates of its own.

        Parameters
        ----------
        point : array_like, shape (dimension,), optional
            Earth axes in the reference configuration, m; by default the centre of mass.
        component : {"x", "y", "z"}
            Along which of the axes.
        axes : {"earth", "body"} or Body
            Earth axes, or the moving axes of the body or of another one.
        order : {0, 1, 2}
            Position, velocity or acceleration.
        """
        subject = f"sensor '{name}'"
        k = order_number(order, 2, subject)
        unit = self._unit(unit, RATE_UNITS["m"][k])
        owner, position = self.owned(body, f"The {subject}"), body.com if point is None else point
        carried = owner.carried(position)
        type = SensorType.COMPONENT if carried is None else SensorType.CARRIED
        vectors = (owner.point(position),) if carried is None else carried
        i = component_number(component, self.dimension, subject)
        along = np.eye(self.dimension)[i]
        if isinstance(axes, str) and axes == "earth":
            if carried is None:
                return self._sense(name, unit, description, SIGNALS[k], [vectors[0][i]], reals=[1.0])
            axis = AffineVector(tuple(Affine({}, v) for v in along.tolist()))
        elif isinstance(axes, Body) or (isinstance(axes, str) and axes == "body"):
            axis = (self.owned(axes, f"The {subject}") if isinstance(axes, Body) else body).vector(along)
        else:
            raise ModelError(f"The axes of {subject} are {shown(axes)}; they must be 'earth', 'body' or a body.")
        signals = [s for vector in (*vectors, axis) for s in spatial(vector)]
        return self._sense(name, unit, description, type, signals, integers=[k])

    def sense_coordinate(
        self,
        name: str,
        coordinate: Coordinate | Affine,
        *,
        order: int = 0,
        scale: float = 1.0,
        unit: str = "",
        description: str = "",
        display_unit: str = "",
    ) -> Sensor:
        """A coordinate or an expression of coordinates, or one of its rates.

        Parameters
        ----------
        coordinate : Coordinate or Affine
            A relative angle, a spin, or an expression such as ``body.point(p)[2]``; of a flexible body
            ``body.combination(weights)``, with a row of `ReducedBody.recovery` a stress or a moment.
        order : {0, 1, 2}
            The value, its rate or its second rate.
        scale : float
            Factor on it.
        unit : str
            By default the unit of the coordinate, "1" for an expression: checks of a run then do not compare it.
        display_unit : str
            Customary unit in engineering, if that is not the unit.
        """
        k = order_number(order, 2, f"sensor '{name}'")
        expression = self.expression(coordinate, f"The sensor '{name}'")
        unit = self._unit(unit, RATE_UNITS[coordinate.unit][k] if isinstance(coordinate, Coordinate) else "1")
        factor = number(scale, f"The scale of sensor '{name}'")
        return self._sense(name, unit, description, SIGNALS[k], [expression], reals=[factor], display_unit=display_unit)
