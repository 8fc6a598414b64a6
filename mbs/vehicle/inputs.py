"""Inputs of a car: of its driver, and at ports, where other programs take the place of driver or parts."""

from mbs.model.inputs import new_input
from mbs.model.model import Model
from mbs.model.records import Input, Role
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.ports import Ports

MAX_TORQUE = 1e4
"""End of the range of the torque demand of a brake, N m."""
MAX_PRESSURE = 4e7
"""End of the range of the pressure of a brake, Pa."""


def driver_inputs(m: Model, ports: Ports) -> dict[str, Input]:
    """Add the inputs of the driver, except for parts that ports replace; return them by name."""
    inputs = {}
    if ports.steering != "rack_position":
        inputs["steering"] = m.input("steering", min=-1.0, max=1.0, description="steering, positive to the left")
    if ports.torque is None:
        inputs["throttle"] = m.input("throttle", min=0.0, max=1.0, description="throttle pedal")
    if ports.brakes is None:
        inputs["brake"] = m.input("brake", min=0.0, max=1.0, description="brake pedal")
    text = "hand brake on the rear wheels"
    inputs["hand_brake"] = m.input("hand_brake", min=0.0, max=1.0, description=text)
    if ports.torque is None:
        text = "selector: -1 reverse, 0 neutral, 1 drive"
        inputs["selector"] = m.input("selector", start=1.0, min=-1.0, max=1.0, description=text, whole=True)
    return inputs


def new_port(
    b: CarBuilder,
    name: str,
    minimum: float,
    maximum: float,
    unit: str,
    description: str,
    role: Role = Role.NONE,
    near: str = "",
    *,
    whole: bool = False,
    figures: tuple[float, ...] = (),
) -> Input:
    """Add an input that another program sets; it is 0 until then.

    `minimum`, `maximum`: ends of its range in `unit`, to which values are clamped; `role`, `near`, `figures`: check of
    the input in an FMU, the sensor it is compared with, and numbers for the check; `whole`: whether it is an integer.
    """
    limits = 0.0, minimum, maximum, unit, description
    channel = new_input(b.m, name, *limits, whole, True, role, near, figures=figures)
    b.port_inputs.append(channel)
    return channel


def brake_port(b: CarBuilder, wheel: str) -> Input:
    """Add the input of the brake of a wheel: its torque or its pressure, by the kind of the port."""
    if b.ports.brakes == "torque":
        text = "largest torque that the brake of the wheel can hold, which turns in neither direction by itself"
        return new_port(b, f"wheel_{wheel}.brake_torque_demand", 0.0, MAX_TORQUE, "N.m", text)
    text = "pressure in the brake of the wheel"
    return new_port(b, f"wheel_{wheel}.brake_pressure", 0.0, MAX_PRESSURE, "Pa", text)
