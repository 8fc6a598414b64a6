"""The modelling vocabulary: what an engineer writes, in earth axes in the reference configuration."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from numpy.typing import ArrayLike
from scipy.interpolate import PPoly

from mbs.common.checks import not_negative, number, positive, shown
from mbs.elements.record import ElementRecord
from mbs.model.air import AirVocabulary
from mbs.model.angle import relative_angle
from mbs.model.anti_roll_bar import anti_roll_bar, arm_angles
from mbs.model.body import Body
from mbs.model.carried import SlidingPoint, Spin, WrittenAxis
from mbs.model.channel_sensors import ChannelSensorVocabulary
from mbs.model.constants import new_constant
from mbs.model.coordinate import Coordinate
from mbs.model.flexible import FlexibleBody
from mbs.model.force_sensors import ForceSensorVocabulary
from mbs.model.forces import ForceVocabulary
from mbs.model.guides import at_right_angles, guide_input, guide_inputs, guide_table, guide_time, owned_guide
from mbs.model.inputs import new_input
from mbs.model.joint_sensors import JointSensorVocabulary
from mbs.model.motion_sensors import MotionSensorVocabulary
from mbs.model.orientation_sensors import OrientationSensorVocabulary
from mbs.model.parameters import Target, new_parameter
from mbs.model.records import Armature, Constant, Guide, Input, Parameter
from mbs.model.road_vocabulary import RoadVocabulary
from mbs.model.sliding_shapes import SlidingVocabulary
from mbs.model.spin import spin
from mbs.model.table_vocabulary import TableVocabulary
from mbs.model.transmission_vocabulary import TransmissionVocabulary
from mbs.model.written_axis import new_written_axis


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
        """An axisymmetric wheel as one coordinate, its absolute axial rate.

        Mass and diametral inertia are added to the carrier.

        Parameters
        ----------
        name : str
            Name of the coordinate; unique among the spins.
        carrier : Body
            A rigid body of a spatial model.
        centre, axis : array_like, shape (3,)
            Earth axes in the reference configuration, m and of any length.
        mass : float
            kg.
        spin_inertia, diametral_inertia : float
            About the axis and across it, kg m2.
        rolling_radius : float
            Radius that gives the spin when an initial pose has a speed, m; 0: none.

        Raises
        ------
        ModelError
            The model is planar, the carrier is not rigid, or no wheel has these inertias.
        """
        return spin(self, name, carrier, centre, axis, mass, spin_inertia, diametral_inertia, rolling_radius)

    def written_axis(self, spin: Spin, *, leaning: float = 0.0) -> WrittenAxis:
        """Let parameters turn the axis of a wheel on its carrier, about the centre of the wheel.

        A parameter writes to its ``azimuth``, the angle of the axis about the vertical of the drawing from y to -x, or
        its ``elevation`` above the level there, both in rad, and is fixed. Steps cost nothing while both are as drawn.

        Parameters
        ----------
        spin : Spin
            What `Model.spin` returned.
        leaning : float
            By how much its rolling radius grows with 1 over the cosine of the elevation, m: a hub that stays at its
            height is farther from where a leaning wheel stands.

        Raises
        ------
        ModelError
            The axis stands upright.
        """
        return new_written_axis(self, spin, leaning)

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

    def guide_input(self, name: str, *, input: Input, gain: float = 1.0, frequency: float, unit: str = "1") -> Guide:
        """A prescribed motion that follows ``gain * input`` through a critically damped filter.

        Parameters
        ----------
        gain : float
            Of the filter, in units of the guide per unit of the input.
        frequency : float
            Of the filter, Hz.
        unit : str
            Of the guide, rad or m.
        """
        return guide_input(self, name, input, gain, frequency, unit)

    def guide_inputs(
        self,
        name: str,
        *,
        inputs: tuple[Input, Input],
        gains: tuple[float, float],
        limits: tuple[float, float],
        frequency: float,
        unit: str = "1",
    ) -> Guide:
        """A prescribed motion that follows the sum of two inputs, held between two limits, through the filter of
        `guide_input`.

        Parameters
        ----------
        gains : tuple of float
            Of each input, in units of the guide per unit of the input.
        limits : tuple of float
            Between which the sum is held, in units of the guide; the "excess" of `sense_guide` is what they take away.
        frequency : float
            Of the filter, Hz.
        unit : str
            Of the guide, rad or m.

        Raises
        ------
        ModelError
            The limits are the wrong way round, or the frequency is not positive.
        """
        return guide_inputs(self, name, inputs, gains, limits, frequency, unit)

    def guide_time(self, name: str, motion: PPoly | tuple[ArrayLike, ArrayLike], *, unit: str = "1") -> Guide:
        """A prescribed motion in time.

        Parameters
        ----------
        motion : scipy.interpolate.PPoly or (times, values)
            Pieces of degree 5 or less over s; or points, of shape (n,) each, through which a cubic spline goes that
            begins and ends at rest.
        unit : str
            Of the guide, rad or m.

        Raises
        ------
        ModelError
            The degree is above 5, or the times do not rise.
        """
        return guide_time(self, name, motion, unit)

    def guide_table(
        self, name: str, source: Guide, table: ArrayLike, *, slopes: ArrayLike | None = None, unit: str = "1"
    ) -> Guide:
        """A motion that follows another guide by a curve, such as a rack the steering wheel.

        Parameters
        ----------
        source : Guide
            That it follows, not by a table itself.
        table : array_like, shape (n, 2)
            Rows of the value of `source`, rising, and of the guide. Between them a monotone cubic with continuous
            slope, beyond them a straight line.
        slopes : array_like, shape (n,), optional
            At the rows, where they are known; the cubics are then not held monotone.
        unit : str
            Of the guide, rad or m.

        Raises
        ------
        ModelError
            Fewer than two rows, the first column does not rise, or not as many slopes as rows.
        """
        return guide_table(self, name, source, table, slopes, unit)

    def slide(
        self,
        name: str,
        body: Body,
        *,
        point: ArrayLike,
        direction: ArrayLike | Sequence[ArrayLike],
        guide: Guide | Sequence[Guide],
    ) -> SlidingPoint:
        """A point that a guide slides along a direction fixed in a body, such as the rack of a car.

        Parameters
        ----------
        body : Body
            Of a flexible one its floating frame is meant.
        point : array_like, shape (dimension,)
            Where it is when the guide is 0, m, earth axes in the reference configuration.
        direction : array_like, shape (dimension,) or (n, dimension)
            Along what it slides, of any length, in the same axes; several are at right angles to each other.
        guide : Guide or sequence of Guide
            m; one for each direction.

        Returns
        -------
        SlidingPoint
            An end of `distance`.

        Raises
        ------
        ModelError
            Directions are not at right angles, or there are not as many as guides.
        """
        what = f"slide '{name}'"
        several: Any = guide if isinstance(guide, (list, tuple)) else [guide]
        guides = [owned_guide(self, g, f"The {what}") for g in several]
        start = self.anchor(body, point, what)
        turning = body.frame if isinstance(body, FlexibleBody) else body
        rows = at_right_angles(direction, len(guides), self.dimension, what) if several is guide else [direction]
        ways = tuple((self.anchor_axis(turning, row, what), g.index) for row, g in zip(rows, guides, strict=True))
        return SlidingPoint(self.unique("slide", name), body, start, ways)

    def parameter(
        self,
        name: str,
        value: float,
        min: float,
        max: float,
        unit: str = "1",
        description: str = "",
        *,
        targets: Sequence[Target],
        tunable: bool = True,
        works: tuple[float, float] | None = None,
    ) -> Parameter:
        """A number that is set without compiling again: it is written to elements, guides, roads and payloads.

        Parameters
        ----------
        value : float
            As the model is compiled, in `unit`.
        min, max : float
            Limits, in `unit`.
        unit : str
            "1" for a pure number.
        targets : sequence of (owner, real, scale) or (owner, real, scale, offset)
            ``value * scale + offset`` is written to the real of the owner: an element, a guide of an input, or their
            name, and one of its `real_names`; ("road", number) and the name or number of a real of the road; or a
            payload and "mass", an armature and "ratio"; or the name of a switch and "on", which takes 0 or 1. A real
            belongs to one parameter.
        tunable : bool
            Whether it may be set while the model moves; False: before the start only, as masses of payloads, ratios of
            armatures and switches must be.
        works : (float, float), optional
            Least and largest value, in `unit`, with which the model does what it is made for; an FMU and a
            `Simulation` say so when another is set.

        Raises
        ------
        ModelError
            The value is not between the limits, a target does not exist or is another parameter's, or what it writes at
            one of the limits is no value that the target can have.
        """
        return new_parameter(self, name, value, min, max, unit, description, targets, tunable, works)

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
        """
        return new_constant(self, name, value, unit, description)
