"""The modelling vocabulary: what an engineer writes, in earth axes in the reference configuration."""

from __future__ import annotations

from mbs.common.checks import number
from mbs.model.coordinate import Coordinate
from mbs.model.flexible_vocabulary import FlexibleVocabulary
from mbs.model.forces import ForceVocabulary
from mbs.model.joint_sensors import JointSensorVocabulary
from mbs.model.joint_vocabulary import JointVocabulary
from mbs.model.table_vocabulary import TableVocabulary
from mbs.model.transmission_vocabulary import TransmissionVocabulary


class Model(
    TransmissionVocabulary,
    JointVocabulary,
    TableVocabulary,
    ForceVocabulary,
    JointSensorVocabulary,
    FlexibleVocabulary,
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

    def initial_rate(self, coordinate: Coordinate, rate: float) -> None:
        """Start rate of a relative angle or a spin.

        Parameters
        ----------
        rate : float
            rad/s.
        """
        index = self.owned_coordinate(coordinate, "An initial rate").index
        self.coordinate_rates[index] = number(rate, f"The initial rate of '{coordinate.name}'")
