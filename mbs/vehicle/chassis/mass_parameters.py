"""Mass, centre of mass and inertia of the chassis as parameters."""

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.chassis.section import Chassis

REALS = {"com": ("com_x", "com_y", "com_z"), "inertia": ("xx", "yy", "zz"), "products": ("xy", "xz", "yz")}
"""Of the engine, by field of the file."""


def write_inertia(b: CarBuilder, data: Chassis) -> None:
    """Let parameters write them.

    What they change rides on the frame that takes the forces of the ground, and loads a flexible chassis there; its own
    mass and modes stay.
    """
    _, axes, _ = b.chassis.contact_frame
    chassis = b.m.written_inertia(
        "chassis", b.chassis.place(data.com), axes, mass=data.mass, com=data.com, inertia=data.tensor
    )
    b.tie(data, "mass", chassis, "mass")
    for field, reals in REALS.items():
        for (path, value), real in zip(data.numbers(field).items(), reals, strict=True):
            b.tie(data, field, chassis, real, value=value, part=path.rpartition(".")[2])
