"""The modelling vocabulary: what an engineer writes, in earth axes in the reference configuration."""

from __future__ import annotations

import math

from numpy.typing import ArrayLike

from mbs.common.checks import not_negative, number, positive, shown
from mbs.elements.record import ElementRecord
from mbs.model.air import AirVocabulary
from mbs.model.angle import relative_angle
from mbs.model.anti_roll_bar import anti_roll_bar, arm_angles
from mbs.model.body import Body
from mbs.model.channel_sensors import ChannelSensorVocabulary
from mbs.model.coordinate import Coordinate
from mbs.model.force_sensors import ForceSensorVocabulary
from mbs.model.forces import ForceVocabulary
from mbs.model.guides import GuideVocabulary
from mbs.model.inputs import new_input
from mbs.model.joint_sensors import JointSensorVocabulary
from mbs.model.motion_sensors import MotionSensorVocabulary
from mbs.model.orientation_sensors import OrientationSensorVocabulary
from mbs.model.parameters import ParameterVocabulary
from mbs.model.records import Armature, Input
from mbs.model.road_vocabulary import RoadVocabulary
from mbs.model.sliding_shapes import SlidingVocabulary
from mbs.model.spin import SpinVocabulary
from mbs.model.table_vocabulary import TableVocabulary
from mbs.model.transmission_vocabulary import TransmissionVocabulary


class Model(
    TransmissionVocabulary,
    TableVocabulary,
    ForceVocabulary,
    AirVocabulary,
    RoadVocabulary,
    MotionSensorVocabulary,
    OrientationSensorVocabulary,
    ForceSensorVocabulary,
    JointSensorVocabulary,
    ChannelSensorVocabulary,
    SlidingVocabulary,
    SpinVocabulary,
    GuideVocabulary,
    ParameterVocabulary,
):
    """A mechanism: bodies, joints, forces, inputs and sensors.

    Points, axes and inertias are given in earth axes in the reference configuration, as read off a drawing. Where the
    drawing does not close, `point` (or `axis`) of a joint may be a pair, one per body; `compile` then closes the
    assembly.

    Names are unique among things of one kind, and what is handed to a model must be one of its own. Otherwise, and
    where an argument is not what it must be, a call raises `ModelError` (`ArgumentTypeError` for a thing of another
    class), one sentence with the name and the value, and changes nothing.

    Parameters
    ----------
    name : str
        Name of the model; it goes into the System and into messages.
    dimension : {2, 3}
        Planar (x, y) or spatial.
    gravity : array_like, shape (dimension,), optional
        m/s2; by default 9.81 along -y (planar) or -z (spatial).
    length : float, optional
        What the tolerance of `simulate` is relative to, m; by default the extent of bodies and joints as drawn.

    Attributes
    ----------
    ground : Body
        The earth, for joints, forces and sensors.
    floating : bool
        Set it where the whole scene may be placed by a `Pose`: nothing ties it to the ground but roads.
    start_in_equilibrium : bool
        Set it to start in the static equilibrium instead of as drawn.
    with_ports : callable, optional
        Makes the same model with ports, which computes the sensors that this one leaves out; it is called when one of
        them is first read. Set it last: with what is added later there is none.
    stop_time, step : float
        What an FMU of the System proposes as its stop time and its step, s.
    default_shapes : bool
        Set it to False to draw nothing but what `shape` says and the beams of flexible bodies.

    Raises
    ------
    ModelError
        The name is empty, or the dimension is neither 2 nor 3.

    Examples
    --------
    >>> m = Model("pendulum", dimension=2)
    >>> rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=1.0 / 12.0)
    >>> joint = m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    """

    def __init__(
        self, name: str, dimension: int = 3, gravity: ArrayLike | None = None, *, length: float | None = None
    ) -> None:
        super().__init__(name, dimension, gravity, length)
        self.coordinate_rates: dict[int, float] = {}

    # --- coordinates ---
    def relative_angle(
        self, name: str, body_1: Body, body_2: Body, *, axis: ArrayLike | None = None, zero: float = 0.0
    ) -> Coordinate:
        """Angle of body 2 against body 1 about an axis, not wrapped, as one more coordinate.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies with axes, or the ground.
        axis : array_like, shape (3,), optional
            In space only: earth axes in the reference configuration, of any length.
        zero : float
            The angle in the reference configuration, rad.

        Raises
        ------
        ModelError
            The bodies are the same or have no axes, or the axis is missing in space or given in the plane.
        """
        coordinate, joint = relative_angle(self, name, body_1, body_2, axis, zero)
        self._join(joint)
        return coordinate

    def initial_rate(self, coordinate: Coordinate, rate: float) -> None:
        """Start rate of a relative angle or a spin.

        Parameters
        ----------
        rate : float
            rad/s.
        """
        index = self.owned_coordinate(coordinate, "An initial rate").index
        self.coordinate_rates[index] = number(rate, f"The initial rate of '{coordinate.name}'")

    def armature(self, name: str, coordinate: Coordinate, *, inertia: float, ratio: float = 1.0) -> Armature:
        """Inertia that turns with a relative angle, such as the rotor of a motor behind a gear.

        Its moment on what carries it is left out: the rotor is small, or the carrier turns slowly.

        Parameters
        ----------
        coordinate : Coordinate
            A relative angle or a spin of this model.
        inertia : float
            About its own axis, kg m2; `inertia` times ``ratio**2`` is added to what the coordinate has already.
        ratio : float
            Its turns for one of the coordinate. A fixed parameter may write it.
        """
        self.owned_coordinate(coordinate, f"The armature '{name}'")
        own = not_negative(inertia, f"The inertia of armature '{name}'")
        turns = positive(ratio, f"The ratio of armature '{name}'")
        new = Armature(self.unique("armature", name), coordinate.affine, own, turns)
        self.inertias[coordinate.index] = self.inertias.get(coordinate.index, 0.0) + own * turns * turns
        self.armatures.append(new)
        return new

    def shaft(self, name: str, *, inertia: float = 0.0) -> Coordinate:
        """A shaft that turns in something else, as one coordinate: its angle, from 0 as drawn.

        What carries it takes no reaction of its inertia and does not turn it: the angle and the inertia are small, or
        the carrier turns slowly.

        Parameters
        ----------
        inertia : float
            kg m2; without one something must hold or weigh it, such as a rack or a drive.
        """
        value = not_negative(inertia, f"The inertia of shaft {shown(name)}")
        index = self.new_coordinate(self.unique("shaft", name), "angle", 0.0)
        self.inertias[index] = value
        return Coordinate(name, index, "rad")

    def anti_roll_bar(
        self,
        name: str,
        left: Coordinate | Body,
        right: Coordinate | Body,
        *,
        stiffness: float,
        damping: float = 0.0,
        stiffness_factor: float = 1.0,
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
        left, right : Coordinate or Body
            Relative angles of the arms, or the arms themselves, which turn on `carrier` about `axis`.
        stiffness, damping : float
            N m/rad and N m s/rad of the twist.
        stiffness_factor : float
            Factor on the stiffness, for a parameter.
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
            The arms are the same, a body and an angle, or a spin; or bodies are given without a carrier.
        """
        angles, joints = arm_angles(self, name, (left, right), carrier, axis)
        bar = anti_roll_bar(self, name, angles, stiffness, damping, stiffness_factor, free_twist, mirrored)
        for joint in joints:
            self._join(joint)
        return bar

    # --- inputs, guides, parameters ---
    def input(
        self,
        name: str,
        *,
        start: float = 0.0,
        min: float = -math.inf,
        max: float = math.inf,
        unit: str = "1",
        description: str = "",
        whole: bool = False,
        port: bool = False,
    ) -> Input:
        """A number that a host sets.

        Parameters
        ----------
        start : float
            Value at the start, in `unit`.
        min, max : float
            Limits, in `unit`; values beyond them are refused. They may be infinite.
        unit : str
            "1" for a pure number.
        whole : bool
            Whether it takes whole numbers only, such as the position of a lever: an integer of an FMU. Over time it
            keeps a value until the next one.
        port : bool
            Whether another program sets it at every step: an FMU then holds its last value, with one warning, where a
            value is not finite, and says before the first step if it was not set.
        """
        return new_input(self, name, start, min, max, unit, description, whole, port)
