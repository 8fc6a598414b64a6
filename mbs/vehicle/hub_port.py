"""Port for forces and moments of another program on the hub of a wheel, instead of its tyre."""

from typing import Any

from mbs.elements.hub_wrench import HubWrench
from mbs.model.carried_parts import Spin
from mbs.model.records import Role
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.inputs import new_port
from mbs.vehicle.tyres import Tyre

INPUT_RANGES = {"F": ("N", 2e5, "force"), "M": ("N.m", 5e4, "moment")}
"""Unit, largest value and quantity of the inputs, by the letter in their names."""


def hub_port(b: CarBuilder, wheel: str, spin: Spin, tyre: Tyre, inertia: float) -> None:
    """Add the inputs, their element and the outputs for a tyre model of another program.

    `wheel`: its name, such as "FL"; `tyre`: the replaced one, which determines numbers for the check of the inputs;
    `inertia`: moment of inertia of the wheel about its axis, kg m2.
    """
    slip_stiffness, stiffness, settling, fading = tyre.carcass
    inverse_inertia = tyre.radius**2 / inertia
    figures = (settling, fading, 1.0 / (slip_stiffness * inverse_inertia), stiffness * inverse_inertia)
    near = f"wheel_{wheel}.earth_vx"
    channels: list[int] = []
    for letter, (unit, largest, quantity) in INPUT_RANGES.items():
        for c in "xyz":
            text = f"{quantity} of the tyre on the hub along the earth's {c} axis, about the centre of the wheel"
            # the first input carries the check of all six
            check: dict[str, Any] = {} if channels else {"role": Role.HUB, "near": near, "figures": figures}
            port = new_port(b, f"wheel_{wheel}.hub_{letter}{c}", -largest, largest, unit, text, **check)
            channels.append(port.index)
    b.m.add(HubWrench(channels).record(f"port hub {wheel}", spin.centre, spin.axis, spin.coordinate))

    def outputs() -> None:
        """Add the outputs for the other program."""
        text = "rate of the spin axis along the earth's {} axis"
        b.sense_components(f"wheel_{wheel}.axis_rate_{{}}", spin.axis, "1/s", text, order=1)
        b.m.sense_element(f"wheel_{wheel}.hub_power", f"port hub {wheel}", "power")

    b.port_senses.append(outputs)
