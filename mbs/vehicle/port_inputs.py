"""Inputs that other programs set in place of the driver or of parts of a car."""

from mbs.model.inputs import new_input
from mbs.model.records import Input, Role
from mbs.vehicle.builder import CarBuilder

LARGEST_TORQUE, LARGEST_PRESSURE = 1e4, 4e7  # N m, Pa: ends of the ranges of the ports of brakes


def new_port(
    b: CarBuilder,
    name: str,
    least: float,
    largest: float,
    unit: str,
    description: str,
    role: Role = Role.NONE,
    near: str = "",
    *,
    whole: bool = False,
    figures: tuple[float, ...] = (),
) -> Input:
    """An input that another program sets, 0 until then.

    `least`, `largest`: ends of its range, at which larger values are held, in `unit`; `role`, `near`, `figures`:
    what an FMU watches it for, by which sensor, and what it must know; `whole`: whether it is a whole number.
    """
    limits = 0.0, least, largest, unit, description
    channel = new_input(b.m, name, *limits, whole, True, role, near, figures=figures)
    b.port_inputs.append(channel)
    return channel


def brake_port(b: CarBuilder, wheel: str) -> Input:
    """The input of the brake of a wheel."""
    if b.ports.brakes == "torque":
        text = "largest torque that the brake of the wheel can hold, which turns neither way by itself"
        return new_port(b, f"wheel_{wheel}.brake_torque_demand", 0.0, LARGEST_TORQUE, "N.m", text)
    text = "pressure in the brake of the wheel"
    return new_port(b, f"wheel_{wheel}.brake_pressure", 0.0, LARGEST_PRESSURE, "Pa", text)


def gear_port(b: CarBuilder, gears: int) -> int:
    """Number of the input of the forward gear. `gears`: how many there are."""
    text = "forward gear that is asked for; 0: as the drive shifts by itself"
    return new_port(b, "gear_request", 0.0, float(gears), "1", text, whole=True).index


def clutch_port(b: CarBuilder) -> int:
    """Number of the input of the clutch."""
    text = "clutch pedal: 0 released, 1 pressed, where nothing of the drive's torque is left"
    return new_port(b, "clutch", 0.0, 1.0, "1", text).index
