"""Forces and moments of other programs on the hub of a wheel, in place of its tyre."""

from mbs.elements.hub_wrench import HubWrench
from mbs.model.carried_parts import Spin
from mbs.model.records import Role
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.port_inputs import new_port
from mbs.vehicle.tyres import Tyre

LARGEST = {"F": ("N", 2e5, "force"), "M": ("N.m", 5e4, "moment")}
"""Unit, end of the range and word by the letter."""


def hub_port(b: CarBuilder, wheel: str, spin: Spin, tyre: Tyre, inertia: float) -> None:
    """Add inputs, their element, and constants of the wheel for a tyre model in another program.

    `wheel`: its name, as "FL"; `tyre`: the one left out, to which that of the other program is taken to be
    similar; `inertia`: of the wheel about its axis, kg m2.
    """
    by_slip, stiffness, settling, fading = tyre.carcass
    lever = tyre.radius**2 / inertia
    figures = (settling, fading, 1.0 / (by_slip * lever), stiffness * lever)
    channels: list[int] = []
    for letter, (unit, largest, quantity) in LARGEST.items():
        for c in "xyz":
            text = f"{quantity} of the tyre on the hub along the earth's {c} axis, about the centre of the wheel"
            name = f"wheel_{wheel}.hub_{letter}{c}"
            watched = () if channels else (Role.HUB, f"wheel_{wheel}.earth_vx")
            channel = new_port(b, name, -largest, largest, unit, text, *watched, figures=() if channels else figures)
            channels.append(channel.index)
    b.m.add(HubWrench(channels).record(f"port hub {wheel}", spin.centre, spin.axis, spin.coordinate))

    def outputs() -> None:
        for k, c in enumerate("xyz"):
            text = f"rate of the spin axis along the earth's {c} axis"
            name = f"wheel_{wheel}.axis_rate_{c}"
            b.m.sense_coordinate(name, spin.axis[k], order=1, unit="1/s", description=text)
        b.m.sense_element(f"wheel_{wheel}.hub_power", f"port hub {wheel}", "power")

    b.port_senses.append(outputs)
