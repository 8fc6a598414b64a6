"""Electric motor with a fixed ratio and an open differential."""

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.element import Element
from mbs.elements.integers import input_index
from mbs.elements.reals import NotNegative, Positive, Share
from mbs.elements.record import ElementRecord, Output
from mbs.elements.wheel_signals import carrier_signals


@dataclass(frozen=True)
class ElectricDrive(Element):
    """Drive of two wheels by an electric motor: constant torque, then constant power, then the limit speed.

    Speeds and torques are of the motor if nothing else is said. Its torque T is the throttle times
    ``min(T_max, P_max/|w|)``, to zero beyond the limit speed, minus the rest of the throttle times ``min(T_r, P_r/|w|)
    r(w)`` of regeneration, r an odd smooth step around standstill. With the ratio N both wheels have ``N T/2``, the
    carrier the reaction. The power of the battery is the power of the shaft divided by the efficiency, or times the
    efficiency if the torque works against the motion. The loss of the gears fades below 5 rad/s. The inertia J of the
    rotor is ``J N^2/2`` on each spin, see `Model.armature`.
    """

    max_torque: NotNegative
    """Largest torque of the motor, N m."""
    max_power: NotNegative
    """Largest power of the motor at its shaft, W."""
    ratio: Positive
    """Ratio of the speed of the motor to the mean speed of the wheels."""
    limit_speed: Positive = 1200.0
    """Speed of the motor beyond which its torque fades to zero within 5 %, rad/s."""
    efficiency: Share = 0.9
    """Efficiency between battery and shaft of the motor, both ways."""
    gear_efficiency: Share = 0.97
    """Efficiency between shaft and wheels, both ways."""
    regeneration_torque: NotNegative = 0.0
    """Torque of the motor that brakes with closed throttle, N m."""
    regeneration_power: NotNegative = 50e3
    """Largest power of regeneration, W."""
    regeneration_speed: Positive = 60.0
    """Speed of the motor below which regeneration fades, so that the car rests, rad/s."""
    reverse_torque: NotNegative = 0.5
    """Part of the largest torque available in reverse, a ratio."""
    reverse_speed: Positive = 250.0
    """Speed of the motor beyond which its torque fades in reverse, rad/s."""
    engage_speed: NotNegative = 8.0
    """Mean speed of the wheels up to which a direction against their motion engages, rad/s; beyond, the drive stays in
    neutral."""
    engage_time: Positive = 0.3
    """Time in which the torque fades out and in when the selector moves, s."""

    _noun = "a drive"
    _signals = (("left", 1), ("right", 1), ("f", 3), ("g", 3))
    _integers = (input_index("throttle", "the input"), input_index("selector", optional=True))
    _optional_states = (1.0, 1.0)
    _outputs = (
        Output("motor_speed", "rad/s", "speed of the motor", display_unit="rpm"),
        Output("motor_torque", "N m", "torque of the motor"),
        Output("wheel_torque", "N m", "torque on each of the two wheels"),
        Output("electric_power", "W", "power from the battery, negative in regeneration"),
        Output("gear", "1", "direction engaged: -1 reverse, 0 neutral, 1 drive", whole=True),
        Output("left_power", "W", "power on the left wheel"),
        Output("right_power", "W", "power on the right wheel"),
    )

    def record(
        self,
        name: str,
        left: Affine,
        right: Affine,
        f: AffineVector,
        g: AffineVector,
        throttle: int,
        selector: int | None = None,
    ) -> ElementRecord:
        """Make the record of the element for the kernel; the frame carries the reaction.

        Parameters
        ----------
        throttle : int
            Number of an input, 0 to 1.
        selector : int, optional
            Number of an input: -1 reverse, 0 neutral, 1 drive; without one the drive is in drive.
        """
        signals = (left, right, *carrier_signals(f, g, self._label(name)))
        return self._record(name, signals, (throttle, selector))
