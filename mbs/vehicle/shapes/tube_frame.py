"""Shapes of a frame of tubes: its tubes and a floor between the lowest of its joints."""

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from mbs.vehicle.chassis.frames.tubes import TubularFrame
from mbs.vehicle.shapes.appearance import BARE_STEEL, CAST_STEEL, FRAME_PAINT, Looks

FRAME_TUBE = "frame tube"
"""Name of the shapes of the tubes, which closed bodies hide; absent if the frame is a flexible body."""
FLOOR_RANGE = 0.05  # m above the lowest joint: joints in this range carry the floor


def tube_frame_shapes(looks: Looks, frame: TubularFrame, *, bends: bool) -> None:
    """Draw the tubes, unless they are drawn as beams, and the floor.

    `frame`: frame of the tables of the car; `bends`: whether the chassis is a flexible body, whose beams are
    drawn.
    """
    joints = frame.joint_places()
    paint = FRAME_PAINT if looks.car.chassis.body in ("auto", "open") else CAST_STEEL
    if not bends:
        for tube in frame.frame(carried_masses=False)[1]:
            points = [(looks.chassis, joints[name]) for name in (tube.start, tube.end)]
            radius = 0.5 * frame.section.sections[tube.section].diameter
            looks.shape(looks.chassis, "tube", points=points, radius=radius, name=FRAME_TUBE, **paint)
    positions = np.array(list(joints.values()))
    low = positions[positions[:, 2] < positions[:, 2].min() + FLOOR_RANGE]
    try:
        corners = low[ConvexHull(low[:, :2]).vertices]
    except (QhullError, ValueError):  # no area
        return
    looks.shape(looks.chassis, "plate", points=[(looks.chassis, p) for p in corners], thickness=0.004, **BARE_STEEL)
