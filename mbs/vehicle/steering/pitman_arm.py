"""Steering box with a Pitman arm, a centre link and an idler arm, without compliance and without mass."""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mbs.model.joint_ends import End
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.model.records import DrivingFunction
from mbs.vehicle.axes import LEFT, UP
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import (
    ArmAngle,
    Frequency,
    Point,
    PrescribedFriction,
    RoadWheelAngle,
    SteeringBox,
)
from mbs.vehicle.side import Point as Coordinates
from mbs.vehicle.side import Side, TieRodEnd
from mbs.vehicle.steering.four_bar import FourBar
from mbs.vehicle.steering.steering_outputs import WHEEL_ANGLE, demand_outputs, tie_ratio, wheel_outputs
from mbs.vehicle.steering.steering_section import Steered, SteeringSection, column_friction

MIN_ARM = 0.03  # m
MIN_LINK = 0.1  # m
MIN_SINE = math.sin(math.radians(10.0))  # of the angle to a dead point
MIN_AXIS_COSINE = math.cos(math.radians(60.0))  # of the angle of the axes from upright
SPACING = 0.01  # rad, between rows of the tables: displacements are accurate to 1e-11 m
LINK = "steering_link_x", "steering_link_y", "steering_link_angle"
"""Outputs of the pose of the centre link."""


class PitmanArm(SteeringSection):
    """Steering box whose Pitman arm moves a centre link, which an idler arm guides and the tie rods hang on.

    Both arms turn about parallel axes. The inner ends of the tie rods are fixed in the link, each in its place as
    drawn. Arms and link have no mass of their own: it belongs to the chassis, as with a rack that follows the
    steering wheel.
    """

    motion: ClassVar[str] = "steering_arm_angle"
    without_travel: ClassVar[str] = "which has no rack"

    kind: Literal["pitman_arm"]
    """Names this template."""
    arm_pivot: Point
    """Point of the axis of the Pitman arm, on whichever side of the car it is."""
    arm_joint: Point
    """Joint of the Pitman arm and the centre link."""
    idler_pivot: Point | None = None
    """Point of the axis of the idler arm; by default the mirror image of arm_pivot."""
    idler_joint: Point | None = None
    """Joint of the idler arm and the centre link; by default the mirror image of arm_joint."""
    arm_axis_top: Point | None = None
    """Another point of the axis of the Pitman arm, above arm_pivot, if the axis is not upright; the axis of the
    idler arm is parallel to it."""
    ratio: SteeringBox
    """Angle of the steering wheel per angle of the Pitman arm."""
    arm_angle_max: ArmAngle
    """Angle of the Pitman arm to each side at steering = 1."""
    frequency: Frequency
    """Of the critically damped follower between the demanded angle and the arm."""
    front_wheel_angle_max: RoadWheelAngle
    """Mean steering angle of the front wheels at full lock."""
    friction: PrescribedFriction = 0.0
    """Friction of box and column, at the steering wheel."""

    def faults(self) -> Iterator[str]:
        """Faults of an inclined axis, of short arms or links, and of a dead point before full lock."""
        if not self.axis[2] >= MIN_AXIS_COSINE * math.hypot(*self.axis) > 0.0:
            yield (
                f"{self.key('arm_axis_top')} is {list(self.arm_axis_top or ())} and {self.key('arm_pivot')} "
                f"{list(self.arm_pivot)}; the first must be above the second, 60 deg or less from upright."
            )
            return
        bar = self.four_bar
        for name, a, b, least in (
            ("arm_joint", bar.pivot, bar.joint, MIN_ARM),
            ("idler_joint", bar.idler_pivot, bar.idler_joint, MIN_ARM),
            ("idler_joint", bar.joint, bar.idler_joint, MIN_LINK),
        ):
            if not abs(b - a) >= least:
                other_name = "arm_joint" if least == MIN_LINK else name.replace("joint", "pivot")
                yield (
                    f"{self.key(name)} is {abs(b - a):.3g} m from {self.key(other_name)} across the axes; it must be "
                    f"{least:g} m or more."
                )
                return
        for sign in (1.0, -1.0):
            phi = sign * np.linspace(0.0, self.arm_angle_max, 400)
            for margin, limit in (
                (bar.lever(phi), "the arm points aside, where it moves the link to the side no more"),
                (bar.transmission(phi), "link and idler arm are in one line, in which they lock"),
            ):
                locking = ~(margin >= MIN_SINE)
                if locking.any():
                    yield (
                        f"{self.key('arm_angle_max')} is {self.arm_angle_max:g} rad, but at "
                        f"{abs(phi[int(np.argmax(locking))]):.3g} rad to one side of the drawing less than 10 deg are "
                        f"left to where {limit}; turn the arm less, or move the joints."
                    )
                    return

    @property
    def axis(self) -> Coordinates:
        """Vector along both axes, upwards, m."""
        if self.arm_axis_top is None:
            return UP
        x, y, z = np.subtract(self.arm_axis_top, self.arm_pivot).tolist()
        return x, y, z

    @cached_property
    def plane(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Unit vectors of the plane of the linkage: nearest to the forward direction and to the left."""
        up = np.array(self.axis) / math.hypot(*self.axis)
        left = np.array(LEFT) - up[1] * up
        left /= np.linalg.norm(left)
        return np.cross(left, up), left

    @cached_property
    def four_bar(self) -> FourBar:
        """The linkage in its plane."""
        return FourBar(*(self.in_plane(point) for point in (self.arm_pivot, self.arm_joint, *self.idler)))

    @property
    def idler(self) -> tuple[Coordinates, Coordinates]:
        """Pivot and joint of the idler arm, m."""
        (x, y, z), (u, v, w) = self.arm_pivot, self.arm_joint
        return self.idler_pivot or (x, -y, z), self.idler_joint or (u, -v, w)

    def in_plane(self, point: Coordinates) -> complex:
        """Projection of a point on the plane of the linkage, m; the real part is ahead. `point`: position as drawn,
        m."""
        ahead, left = self.plane
        return complex(ahead @ np.array(point), left @ np.array(point))

    @property
    def wheel_angle_max(self) -> float:
        """As in the base class, by the ratio of the steering box."""
        return self.ratio * self.arm_angle_max

    @property
    def full(self) -> float:
        """Angle of the arm at full lock, rad."""
        return self.arm_angle_max

    @property
    def lateral_travel(self) -> tuple[str, float]:
        """Key path and lateral travel of the end of the arm at full lock, m."""
        lever = self.four_bar.joint - self.four_bar.pivot
        return self.key("arm_angle_max"), abs(lever.real) * math.sin(self.arm_angle_max)

    def wheel_at(self, motion: float) -> tuple[float, float]:
        """As in the base class, by the ratio of the steering box."""
        return self.ratio * motion, self.ratio

    def signed(self, way: float) -> float:
        """1: the angle of the arm is positive to the left."""
        return 1.0

    def turn(self, way: float) -> float:
        """Right-handed rotation of the arm per angle to the left, 1 or -1. `way`: as in `signed`."""
        return way * math.copysign(1.0, (self.four_bar.joint - self.four_bar.pivot).real)

    def ends(self, b: CarBuilder, guide: DrivingFunction, way: float) -> TieRodEnd:
        """Points of the link, moved in its plane by tables against the angle of the arm."""

        angles, turn = self._angles, self.turn(way)

        def end(side: Side, point: Coordinates) -> End:
            prefix = f"steering link {side.wheel}"
            link_motion, rate = self.four_bar.carried(self.in_plane(point), turn * angles)
            guides = [
                b.m.guide_table(
                    f"{prefix} {name}",
                    guide,
                    np.column_stack([angles, component(link_motion)]),
                    slopes=turn * component(rate),
                    unit="m",
                )
                for name, component in (("x", np.real), ("y", np.imag))
            ]
            return b.m.slide(prefix, b.chassis.body, point=point, direction=np.array(self.plane), guide=guides)

        return end

    @property
    def _angles(self) -> NDArray[np.float64]:
        """Angles of the arm in the rows of the tables, rad."""
        return np.linspace(-self.full, self.full, 2 * math.ceil(self.full / SPACING) + 1)

    def build(self, b: CarBuilder, way: float) -> Steered:
        """Add the steering box; the linkage is added with the tie rods. `way`: as in `signed`."""
        m, full = b.m, self.arm_angle_max
        demand = self.angle_demand(m)
        arm = m.guide_inputs(
            "steering arm",
            inputs=(b.inputs["steering"], demand),
            gains=(full, 1.0 / self.ratio),
            limits=(-full, full),
            frequency=self.frequency,
            unit="rad",
        )
        if self.friction > 0.0:
            column_friction(m, arm, 1.0 / self.ratio, self.friction)

        sense_guide = m.sense_guide

        def outputs() -> None:
            text = "angle of the Pitman arm, positive if it steers to the left"
            sense_guide("steering_arm_angle", arm, description=text)
            sense_guide("steering_wheel_angle", arm, scale=self.ratio, description=WHEEL_ANGLE)
            self._link_outputs(m, arm, way)

        def torque_outputs() -> None:
            wheel_outputs(m, arm, 1.0 / self.ratio, self.ratio)
            text = "torque of the tie rods on the Pitman arm, positive if it would steer to the left"
            sense_guide("steering_arm_torque", arm, "force", joints=_rods(m), scale=-1.0, description=text)
            demand_outputs(m, demand, arm, self.ratio)
            if self.friction == 0.0:  # with friction the ratio is in an equation, which has no parameters
                tie_ratio(b, self, "ratio", arm, 1.0, inverse=True)

        return Steered(self.ends(b, arm, way), outputs, torque_outputs)

    def _link_outputs(self, m: Model, arm: DrivingFunction, way: float) -> None:
        """Add the outputs of the pose of the centre link."""
        turn, angles = self.turn(way), self._angles
        _, rotation, rate = self.four_bar.turned(turn * angles)
        rotation = np.column_stack([angles, rotation])
        link = m.guide_table("steering link", arm, rotation, slopes=turn * rate, unit="rad")
        slide = _rods(m)[0].slide
        assert slide is not None, "from `_rods`"
        (_, ahead), (_, aside) = slide[1].ways
        for name, guide, text in (
            (LINK[0], m.guides[ahead], "way ahead of the left tie rod's end in the plane of the steering linkage"),
            (
                LINK[1],
                m.guides[aside],
                "way to the left of the left tie rod's end in the plane of the steering linkage",
            ),
            (LINK[2], link, "turn of the centre link in the plane of the steering linkage, positive to the left"),
        ):
            m.sense_guide(name, guide, description=text)


def _rods(m: Model) -> list[Joint]:
    """The tie rods, left one first."""
    return [joint for joint in m.joints if joint.slide is not None]
