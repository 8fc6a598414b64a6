"""Inputs at the ports of a car: demands that other programs set instead of the driver or of parts of the car."""

from mbs.model.inputs import new_input
from mbs.model.records import Input, Role
from mbs.vehicle.builder import CarBuilder

MAX_TORQUE = 1e4
"""End of the range of the torque demand of a brake, N m."""
MAX_PRESSURE = 4e7
"""End of the range of the pressure of a brake, Pa."""


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
        text = "largest torque that the brake of the wheel can hold, which turns neither way by itself"
        return new_port(b, f"wheel_{wheel}.brake_torque_demand", 0.0, MAX_TORQUE, "N.m", text)
    text = "pressure in the brake of the wheel"
    return new_port(b, f"wheel_{wheel}.brake_pressure", 0.0, MAX_PRESSURE, "Pa", text)


def gear_port(b: CarBuilder, gears: int) -> int:
    """Add the input of the forward gear and return its number. `gears`: count of forward gears."""
    text = "forward gear that is asked for; 0: as the drive shifts by itself"
    return new_port(b, "gear_request", 0.0, float(gears), "1", text, whole=True).index


def clutch_port(b: CarBuilder) -> int:
    """Add the input of the clutch and return its number."""
    text = "clutch pedal: 0 released, 1 pressed, where nothing of the drive's torque is left"
    return new_port(b, "clutch", 0.0, 1.0, "1", text).index
