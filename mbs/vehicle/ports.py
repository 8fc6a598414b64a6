"""Ports of a car: inputs by which other programs replace its drive, brakes or steering, also by an option."""

from typing import Literal, get_args

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


def chosen_ports(text: str) -> dict[str, str]:
    """Parse a list of ports such as ``torque,brakes=pressure``; return kinds by port, by default the first kind.

    Raises `ValueError` if the text is not such a list; the message names the ports and their kinds.
    """
    kinds_of = {name: _kinds(name) for name in PORTS}
    chosen: dict[str, str] = {}
    for item in text.split(","):
        name, equals, kind = (part.strip() for part in item.partition("="))
        kind = kind if equals else next(iter(kinds_of.get(name, ("",))))
        if name not in kinds_of or kind not in kinds_of[name] or name in chosen:
            offered = ", ".join(f"{port} ({' or '.join(kinds)})" for port, kinds in kinds_of.items())
            twice = f", where {name} stands twice" if name in chosen else ""
            raise ValueError(
                f"The ports are '{text}'{twice}; they must be a list such as torque,brakes=pressure out of {offered}."
            )
        chosen[name] = kind
    return chosen


def _kinds(name: str) -> tuple[str, ...]:
    """Kinds of a port, from the type of its field."""
    return get_args(get_args(Ports.model_fields[name].annotation)[0])
