"""The modelling vocabulary: what an engineer writes, in earth axes in the reference configuration."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from numpy.typing import ArrayLike

from mbs.elements.record import ElementRecord
from mbs.model.angle import relative_angle
from mbs.model.anti_roll_bar import anti_roll_bar, arm_angles
from mbs.model.body import Body
from mbs.model.checks import not_negative
from mbs.model.constants import Constant, new_constant
from mbs.model.core import Coordinate
from mbs.model.flexible import FlexibleBody
from mbs.model.forces import ForceVocabulary
from mbs.model.guides import Guide, guide_input, guide_time, owned_guide
from mbs.model.inputs import Input, new_input
from mbs.model.joint_sensors import JointSensorVocabulary
from mbs.model.joints.distance import distance
from mbs.model.joints.drive import drive
from mbs.model.joints.gear import gear
from mbs.model.joints.joint import Joint
from mbs.model.joints.pin import pin
from mbs.model.joints.points import revolute, spherical, universal
from mbs.model.joints.rack import rack
from mbs.model.joints.rolling import rolling, skate
from mbs.model.joints.screw import Screw, screw
from mbs.model.joints.sliding import cylindrical, point_on_line, prismatic, weld
from mbs.model.parameters import Parameter, new_parameter
from mbs.model.slide import SlidingPoint
from mbs.model.spin import Spin, spin


class Model(ForceVocabulary, JointSensorVocabulary):
    """A mechanism: bodies, joints, forces, inputs and sensors.

    Points, axes and inertias are given in earth axes in the reference configuration, as read off a drawing. Where the
    drawing does not close, `point` (or `axis`) of a joint may be a pair, one per body; `compile` then closes the
    assembly.

    Parameters
    ----------
    name : str
    dimension : {2, 3}
        Planar (x, y) or spatial.
    gravity : array_like, shape (dimension,), optional
        m/s2; by default 9.81 along -y (planar) or -z (spatial).
    length : float, optional
        What the tolerance of `simulate` is relative to, m; by default the extent of bodies and joints as drawn.

    Examples
    --------
    >>> m = Model("pendulum", dimension=2)
    >>> rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=1.0 / 12.0)
    >>> joint = m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    """

    # --- joints ---
    def _join(self, joint: Joint) -> Joint:
        self.unique("joint", joint.name)
        self.joints.append(joint)
        return joint

    def revolute(self, name: str, body_1: Body, body_2: Body, *, point: Any, axis: Any = None) -> Joint:
        """Shared point and (spatial) shared axis."""
        return self._join(revolute(self, name, body_1, body_2, point, axis))

    def spherical(self, name: str, body_1: Body, body_2: Body, *, point: Any) -> Joint:
        """Shared point."""
        return self._join(spherical(self, name, body_1, body_2, point))

    def universal(
        self, name: str, body_1: Body, body_2: Body, *, point: Any, axis_1: ArrayLike, axis_2: ArrayLike
    ) -> Joint:
        """Shared point; the angle between axis_1 (of body 1) and axis_2 (of body 2) is constant."""
        return self._join(universal(self, name, body_1, body_2, point, axis_1, axis_2))

    def prismatic(self, name: str, body_1: Body, body_2: Body, *, axis: ArrayLike, point: Any = None) -> Joint:
        """Shared orientation; the point of body 1 slides along the axis of body 2."""
        return self._join(prismatic(self, name, body_1, body_2, point, axis))

    def cylindrical(self, name: str, body_1: Body, body_2: Body, *, point: Any, axis: ArrayLike) -> Joint:
        """Shared axis along which the point of body 1 slides and about which the bodies turn."""
        return self._join(cylindrical(self, name, body_1, body_2, point, axis))

    def weld(self, name: str, body_1: Body, body_2: Body) -> Joint:
        """The bodies move as one."""
        return self._join(weld(self, name, body_1, body_2))

    def point_on_line(self, name: str, end_1: tuple[Body, Any], end_2: tuple[Body, Any], *, axis: ArrayLike) -> Joint:
        """The point of body 1 stays on a line fixed in body 2; ends are (body, point)."""
        return self._join(point_on_line(self, name, end_1, end_2, axis))

    def distance(self, name: str, end_1: Any, end_2: Any, *, length: float | None = None) -> Joint:
        """Constant distance, m (default: as drawn): a massless rod. Ends: (body, point), a point mass or a sliding
        point.
        """
        return self._join(distance(self, name, end_1, end_2, length))

    def drive(self, name: str, driven: Any, guide: Guide) -> Joint:
        """A coordinate, a component of a point, or the distance of a pair of ends follows a guide."""
        return self._join(drive(self, name, driven, guide))

    def pin(self, name: str, body: Body, point: ArrayLike | None = None, *, on: bool = False) -> Joint:
        """Hold a point of a body (default: its centre of mass) by a switch of the same name, which a running
        `Simulation` turns on and off: it stays where it is at that moment. `on`: from the start, where it is drawn.
        """
        return self._join(pin(self, name, body, point, on))

    def rolling(
        self,
        name: str,
        wheel: Body | Spin,
        *,
        radius: float,
        centre: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        level: float = 0.0,
    ) -> Joint:
        """A wheel with a knife edge that rolls without slip on a level plane; it always touches.

        Parameters
        ----------
        name : str
        wheel : Body or Spin
            A rigid body, or a spin on its carrier.
        radius : float
            m.
        centre, axis : array_like, shape (3,)
            As drawn, in earth axes, m and without unit; of a body, a spin has them.
        level : float
            Height z of the plane, m.

        Raises
        ------
        ModelError
            The wheel lies flat, misses the plane by more than a thousandth of its radius, or is no rigid body of this
            spatial model.
        """
        return self._join(rolling(self, name, wheel, radius, centre, axis, level))

    def skate(
        self, name: str, body: Body, *, point: ArrayLike, direction: ArrayLike, switch: bool | None = None
    ) -> Joint:
        """A knife edge: a point of a body moves along a direction of the body only, seen from above.

        Parameters
        ----------
        name : str
        body : Body
            A rigid body.
        point, direction : array_like, shape (2,) or (3,)
            As drawn, in earth axes, m and without unit; the height is free.
        switch : bool, optional
            With a switch of the same name, on or off at the start.

        Raises
        ------
        ModelError
            The direction is upright, or the body is not a rigid one of this model.
        """
        return self._join(skate(self, name, body, point, direction, switch))

    # --- transmissions ---
    def gear(self, name: str, wheel_1: Coordinate, wheel_2: Coordinate, *, ratio: float) -> Joint:
        """Two wheels that turn in a constant ratio.

        Parameters
        ----------
        name : str
        wheel_1, wheel_2 : Coordinate
            Relative angles of the wheels against what carries them, or spins.
        ratio : float
            Turns of the first wheel for one of the second, each against its carrier; negative where they turn opposite
            ways about the axes of their angles (-z2/z1 for external teeth on parallel axes).

        Raises
        ------
        ModelError
            The ratio is zero or not finite, or both wheels are one.
        """
        return self._join(gear(self, name, wheel_1, wheel_2, ratio))

    def rack(
        self,
        name: str,
        pinion: Coordinate,
        body: Body,
        *,
        carrier: Body,
        axis: ArrayLike,
        radius: float,
        point: ArrayLike | None = None,
    ) -> Joint:
        """A rack that slides on a carrier by the radius of a pinion per radian; it guides nothing (see `prismatic`).

        Parameters
        ----------
        name : str
        pinion : Coordinate
            Relative angle of the pinion against the carrier, or a spin on it.
        body, carrier : Body
            The rack and what it slides on.
        axis : array_like, shape (dimension,)
            Direction of the slide, fixed in the carrier, earth axes as drawn.
        radius : float
            m per rad; negative where the rack goes against `axis` when the pinion turns positively.
        point : array_like, shape (dimension,), optional
            Of the rack, as drawn, m; by default its centre of mass.

        Raises
        ------
        ModelError
            The radius is zero or not finite, the carrier is a point mass, the rack is the ground or the carrier.
        """
        return self._join(rack(self, name, pinion, body, carrier, axis, radius, point))

    def screw(self, name: str, body_1: Body, body_2: Body, *, point: ArrayLike, axis: ArrayLike, pitch: float) -> Screw:
        """Shared axis along which body 1 moves by `pitch`, m, per turn against body 2; a right-hand thread is positive.

        The joint's `angle` is that turn, rad, a coordinate for sensors and torques.
        """
        joint, angle = screw(self, name, body_1, body_2, point, axis, pitch)
        self._join(joint)
        self._join(angle)
        return joint

    def anti_roll_bar(
        self,
        name: str,
        left: Coordinate | Body,
        right: Coordinate | Body,
        *,
        stiffness: float,
        damping: float = 0.0,
        carrier: Body | None = None,
        axis: ArrayLike | None = None,
        free_twist: float | None = None,
        mirrored: bool = False,
    ) -> ElementRecord:
        """A torsion spring between two arms; its torque on the left one is the output ``force`` of the element.

        Drop links between the arms and the suspension are `distance` joints; without them the arms are those of the
        suspension.

        Parameters
        ----------
        name : str
        left, right : Coordinate or Body
            Relative angles of the arms, or the arms themselves, which turn on `carrier` about `axis`.
        stiffness, damping : float
            N m/rad and N m s/rad of the twist.
        carrier : Body, optional
            With arms given as bodies: what they turn on.
        axis : array_like, shape (3,), optional
            With arms given as bodies, in space.
        free_twist : float, optional
            Twist without torque, rad; by default as drawn.
        mirrored : bool
            The angles count opposite ways (mirrored axes): the twist is their sum instead of left minus right.

        Raises
        ------
        ModelError
            The arms are one, are of two kinds or a spin, or the carrier is missing or superfluous.
        ValueError
            The stiffness is not positive or the damping negative.
        """
        angles, joints = arm_angles(self, name, (left, right), carrier, axis)
        bar = anti_roll_bar(self, name, angles, stiffness, damping, free_twist, mirrored)
        for joint in joints:
            self._join(joint)
        return bar

    # --- coordinates ---
    def relative_angle(
        self, name: str, body_1: Body, body_2: Body, *, axis: ArrayLike | None = None, zero: float = 0.0
    ) -> Coordinate:
        """Angle of body 2 against body 1 about the axis, unwrapped, as one more coordinate; `zero` is its reading,
        rad, in the reference configuration."""
        coordinate, joint = relative_angle(self, name, body_1, body_2, axis, zero)
        self._join(joint)
        return coordinate

    def armature(self, name: str, coordinate: Coordinate, *, inertia: float) -> None:
        """Inertia, kg m2, that turns with a relative angle (a motor behind a gear, seen at the joint)."""
        self.unique("armature", name)
        self.owned_coordinate(coordinate, f"The armature '{name}'")
        value = not_negative(inertia, f"The inertia of armature '{name}'")
        self.inertias[coordinate.index] = self.inertias.get(coordinate.index, 0.0) + value

    def spin(
        self,
        name: str,
        *,
        carrier: Body,
        centre: ArrayLike,
        axis: ArrayLike,
        mass: float,
        spin_inertia: float,
        diametral_inertia: float,
        rolling_radius: float = 0.0,
    ) -> Spin:
        """An axisymmetric wheel as one coordinate, its absolute axial rate; mass in kg, inertias in kg m2.

        `rolling_radius` (m) gives the spin when an initial pose has a speed.
        """
        return spin(self, name, carrier, centre, axis, mass, spin_inertia, diametral_inertia, rolling_radius)

    # --- guides, inputs, parameters ---
    def input(
        self,
        name: str,
        *,
        start: float = 0.0,
        min: float = -math.inf,
        max: float = math.inf,
        unit: str = "1",
        description: str = "",
    ) -> Input:
        """A number that a host sets."""
        return new_input(self, name, start, min, max, unit, description)

    def guide_input(self, name: str, *, input: Input, gain: float = 1.0, frequency: float, unit: str = "1") -> Guide:
        """A motion that follows gain * input through a critically damped filter of the given frequency, Hz."""
        return guide_input(self, name, input, gain, frequency, unit)

    def guide_time(self, name: str, motion: Any, *, unit: str = "1") -> Guide:
        """A motion in time: a PPoly of degree 5 or less, or (times, values)."""
        return guide_time(self, name, motion, unit)

    def slide(self, name: str, body: Body, *, point: ArrayLike, direction: ArrayLike, guide: Guide) -> SlidingPoint:
        """A point that a guide (m) slides along a direction fixed in a body (of a flexible one, in its floating frame);
        an end of `distance`.
        """
        self.unique("slide", name)
        what = f"slide '{name}'"
        index = owned_guide(self, guide, f"The {what}").index
        start = self.anchor(body, point, what)
        turning = body.frame if isinstance(body, FlexibleBody) else body
        return SlidingPoint(name, body, start, self.anchor_axis(turning, direction, what), index)

    def parameter(
        self,
        name: str,
        value: float,
        min: float,
        max: float,
        unit: str = "1",
        description: str = "",
        *,
        targets: Sequence[tuple[Any, Any, float]],
    ) -> Parameter:
        """A tunable number; each target is (element or guide, name of its real, scale)."""
        return new_parameter(self, name, value, min, max, unit, description, targets)

    def constant(self, name: str, value: float, unit: str = "1", description: str = "") -> Constant:
        """A number about the model that its users need and its equations do not, such as a wheelbase.

        An FMU has it as a constant; it is no output and takes no part in a run.

        Parameters
        ----------
        name : str
            Unique, such as ``vehicle.wheelbase``.
        value : float
            Finite, in `unit`.
        unit : str
            SI unit.
        description : str
            One sentence.

        Returns
        -------
        Constant

        Raises
        ------
        ModelError
            If the name is empty or given twice, or the value is no finite number.
        """
        return new_constant(self, name, value, unit, description)
