"""Ports of a car: inputs by which other programs replace its drive, its brakes or its steering."""

from typing import Literal

from pydantic import Field

from mbs.vehicle.names import Name
from mbs.vehicle.quantities import BrakePressure, Frequency, Point
from mbs.vehicle.section import Section

PORTS = ("torque", "brakes", "steering", "road", "tyre", "forces", "wind", "gear", "clutch", "outputs")


class Ports(Section):
    """Inputs at which other programs take the place of parts of the car; without any it is driven by its pedals.

    What a port replaces is left out of the model, with its inputs, outputs and parameters; of an electric drive at
    half shafts the rotor stays with the wheels, and its ratio with it.
    """

    torque: Literal["half_shafts", "hub_motors"] | None = None
    """Torques on the wheels instead of the drive: their reaction is on the chassis, or on the wheels' carriers."""
    brakes: Literal["torque", "pressure"] | None = None
    """Torques, or pressures of brakes in the wheels, instead of the brake pedal; the hand brake stays."""
    steering: Literal["rack_position", "rack_force"] | None = None
    """Travel of a `rack_by_angle` instead of the driver's demands, or force on the rack of a `column` beside them."""
    road: Literal["planes"] | None = None
    """Height, normal and friction of the road at points that other programs were asked for, instead of the road."""
    tyre: Literal["hub"] | None = None
    """Forces and moments on the hubs of the wheels, earth axes, instead of the tyres."""
    forces: Literal["earth", "vehicle"] | None = None
    """Forces and torques on the chassis at `force_points`, along these axes."""
    wind: Literal["speed"] | None = None
    """Speed and heading of air that moves over the ground."""
    gear: Literal["request"] | None = None
    """A forward gear that is asked for, beside an `automatic` drive, which shifts by itself if none is."""
    clutch: Literal["pedal"] | None = None
    """A clutch behind the converter of an `automatic` drive: the part 1 - pedal of its largest torque in a gear."""
    outputs: Literal["loops"] | None = None
    """No input: the outputs that come with any port, of a car that is as it was."""
    force_points: dict[Name, Point] = Field(default_factory=dict)
    """Where the forces act, as drawn, such as a hitch; left and right are as given; by default the reference point."""
    full_pressure: BrakePressure = 10e6
    """Pressure in the brakes of the wheels at which they have the torque of the full pedal."""
    rack_frequency: Frequency = 50.0
    """Of the critically damped follower between the port of the rack's travel and the rack."""

    @property
    def any(self) -> bool:
        """Whether there is a port."""
        return any(getattr(self, name) is not None for name in PORTS)
