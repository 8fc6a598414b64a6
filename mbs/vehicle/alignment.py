"""Alignment of the wheels of an axle: toe and camber as set."""

from collections.abc import Iterator
from math import cos, sin

import numpy as np

from mbs.vehicle.quantities import AlignmentAngle
from mbs.vehicle.section import Section
from mbs.vehicle.side import Point, Side


class Alignment(Section):
    """Toe and camber of the wheels of an axle as drawn, by the axes of their hubs; the hard points stay.

    Signs of ISO 8855, of each wheel against the car that stands as drawn.
    """

    toe_left: AlignmentAngle = 0.0
    """Toe angle of the left wheel, positive with its front inwards."""
    toe_right: AlignmentAngle = 0.0
    """Toe angle of the right wheel, positive with its front inwards."""
    camber_left: AlignmentAngle = 0.0
    """Camber angle of the left wheel, positive with its top outwards."""
    camber_right: AlignmentAngle = 0.0
    """Camber angle of the right wheel, positive with its top outwards."""

    def axes(self, side: Side) -> Iterator[Point]:
        """Unit vectors of a wheel as drawn: forward, along its axis to the left, and up in its plane."""
        toe, camber = getattr(self, f"toe_{side.name}"), getattr(self, f"camber_{side.name}")
        steer, lean = -side.sign * toe, -side.sign * camber
        forward = np.array([cos(steer), sin(steer), 0.0])
        left = np.array([-sin(steer) * cos(lean), cos(steer) * cos(lean), sin(lean)])
        for axis in (forward, left, np.cross(forward, left)):
            x, y, z = (float(v) + 0.0 for v in axis)  # no zero has a sign
            yield x, y, z
