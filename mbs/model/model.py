"""Modelling vocabulary, in earth axes in the reference configuration."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ali3.plausibility import Plausibility, Summarised, plausibility_of
from mbs.common.checks import Vector, is_number, number, positive, shown, vector
from mbs.common.errors import ModelError
from mbs.model.air import AirVocabulary
from mbs.model.body import Body
from mbs.model.channel_sensors import ChannelSensorVocabulary
from mbs.model.constants import ConstantVocabulary
from mbs.model.contact_vocabulary import ContactVocabulary
from mbs.model.coordinate import Coordinate
from mbs.model.drive_vocabulary import DriveVocabulary
from mbs.model.driving_vocabulary import SpecialDrivingFunctionVocabulary
from mbs.model.energy_sensors import EnergySensorVocabulary
from mbs.model.flexible import FlexibleBody
from mbs.model.flexible_vocabulary import FlexibleVocabulary
from mbs.model.forces import ForceVocabulary
from mbs.model.inputs import InputVocabulary
from mbs.model.joint_sensors import JointSensorVocabulary
from mbs.model.joint_vocabulary import JointVocabulary
from mbs.model.motion_sensors import MotionSensorVocabulary
from mbs.model.orientation_sensors import OrientationSensorVocabulary
from mbs.model.parameters import ParameterVocabulary
from mbs.model.point_mass import PointMass
from mbs.model.road_vocabulary import RoadVocabulary
from mbs.model.sliding_shapes import SlidingVocabulary
from mbs.model.spin import SpinVocabulary
from mbs.model.springs import SpringVocabulary
from mbs.model.table_vocabulary import TableVocabulary


class Model(
    Summarised,
    JointVocabulary,
    SpringVocabulary,
    ForceVocabulary,
    AirVocabulary,
    RoadVocabulary,
    ContactVocabulary,
    SpinVocabulary,
    DriveVocabulary,
    TableVocabulary,
    FlexibleVocabulary,
    InputVocabulary,
    SpecialDrivingFunctionVocabulary,
    ParameterVocabulary,
    ConstantVocabulary,
    MotionSensorVocabulary,
    OrientationSensorVocabulary,
    EnergySensorVocabulary,
    ChannelSensorVocabulary,
    JointSensorVocabulary,
    SlidingVocabulary,
):
    """A mechanism: bodies, joints, forces, inputs and sensors.

    Points, axes and inertias are given in earth axes in the reference configuration, as read off a drawing. Where the
    drawing does not close, `point` (or `axis`) of a joint may be a pair, one per body; `compile` then closes the
    assembly.

    Names are unique within a kind, such as bodies or joints, and arguments from a model must be from this one.
    Otherwise, or if an argument is not valid, a call raises `ModelError` (`ArgumentTypeError` for an object of another
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
        Length to which the tolerance of `simulate` is relative, m; by default the extent of bodies and joints as drawn.

    Attributes
    ----------
    ground : Body
        The earth, for joints, forces and sensors.
    floating : bool
        Set it if the whole scene may be placed by a `Pose`: nothing ties it to the ground but roads.
    start_in_equilibrium : bool
        Set it to start in the static equilibrium instead of as drawn.
    with_ports : callable, optional
        Makes the same model with ports, which computes the sensors that this one leaves out; it is called when one of
        them is first read. Set it last: adding anything later removes it.
    stop_time, step : float
        Stop time and step that an FMU of the System proposes, s.
    default_shapes : bool
        Set it to False to draw nothing but the shapes of `shape` and the beams of flexible bodies.

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

    def initial_rate(self, coordinate: Coordinate, rate: float) -> None:
        """Start rate of a relative angle or a spin.

        Velocities that are not given follow from the joints: where these leave several, the start takes the one with
        the least kinetic energy, as after an impulse on this coordinate alone. The lower rod of a double pendulum whose
        upper one is given a rate turns back. Give the other rates too, 0 for a coordinate at rest, to start otherwise.

        Parameters
        ----------
        rate : float
            rad/s.
        """
        index = self.owned_coordinate(coordinate, "An initial rate").index
        self.coordinate_rates[index] = number(rate, f"The initial rate of '{coordinate.name}'")

    def point_mass(self, name: str, *, mass: float, position: ArrayLike) -> PointMass:
        """A particle.

        Parameters
        ----------
        mass : float
            kg.
        position : array_like, shape (dimension,)
            In earth axes in the reference configuration, m.
        """
        m = positive(mass, f"The mass of point mass {shown(name)}")
        centre = vector(position, self.dimension, f"the position of point mass {shown(name)}")
        new = PointMass(self, self.unique("body", name), centre, len(self.coordinates))
        new.add_mass(m, centre, np.zeros((3, 3)))
        self._register(new)
        return new

    def initial_velocity(self, body: Body, linear: ArrayLike | None = None, angular: ArrayLike | None = None) -> None:
        """Start velocity of a body: of its centre of mass, its angular velocity, or both.

        A part that is given again replaces the former one. A part that is not given in any call follows from the
        joints: of all velocities that have the given part, the start takes the one with the least kinetic energy, and
        a free body turns or moves only as given. Without both the body starts at rest. The joints remove no more of
        the given part than they must. Where several given velocities contradict each other through the joints the
        start has mass-weighted means, and `print(system)` and every run report the numbers.

        Parameters
        ----------
        body : Body
            Of this model; not the ground and not a node of a flexible body.
        linear : array_like, shape (dimension,), optional
            Velocity of its centre of mass, earth axes, m/s.
        angular : float or array_like, shape (3,), optional
            Angular velocity, earth axes, rad/s; planar a number.
        """
        subject = f"initial velocity of body {shown(getattr(body, 'name', body))}"
        self.owned(body, f"The {subject}")
        if body.is_ground or body.is_lookup_table or body.is_node:
            raise ModelError(f"'{body.name}' cannot have an initial velocity of its own; give it to a body.")
        d, size = self.dimension, 1 if self.dimension == 2 else 3
        if linear is None and angular is None:
            linear, angular = np.zeros(d), np.zeros(size)
        v = None if linear is None else vector(linear, d, f"the linear {subject}")
        w = None if angular is None else _angular(angular, size, f"the angular {subject}")
        if body.is_point and v is None:
            raise ModelError(f"The {subject} is angular; a point mass has a linear one only.")
        given = self.body_velocities.get(body.number, (None, None))
        self.body_velocities[body.number] = (given[0] if v is None else v, given[1] if w is None else w)


def _angular(value: ArrayLike, size: int, subject: str) -> Vector:
    """Angular velocity, shape (size,), rad/s; in the plane a number is accepted."""
    return vector([value] if size == 1 and is_number(value) else value, size, subject)


@plausibility_of.register
def _plausibility_of_model(model: Model) -> list[Plausibility]:
    """Plausibility of the flexible bodies of a model."""
    bodies = [b for b in model.bodies if isinstance(b, FlexibleBody) and isinstance(b.reduced, Summarised)]
    return [
        replace(plausibility, title=f"flexible body '{b.name}'")
        for b in bodies
        for plausibility in plausibility_of(b.reduced)
    ]
