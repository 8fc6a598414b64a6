"""Mass, centre of mass and inertia of the chassis as parameters."""

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.chassis.section import Chassis

MODEL_NUMBERS = {"com": ("com_x", "com_y", "com_z"), "inertia": ("xx", "yy", "zz"), "products": ("xy", "xz", "yz")}
"""Numbers of the chassis in the model, by field of the file."""


def write_inertia(b: CarBuilder, data: Chassis) -> None:
    """Make the mass properties of the chassis parameters.

    A change acts on the contact frame, so that it loads a flexible chassis; the mass and the modes of its frame stay.
    """
    _, axes, _ = b.chassis.contact_frame
    chassis = b.m.written_inertia(
        "chassis", b.chassis.place(data.com), axes, mass=data.mass, com=data.com, inertia=data.tensor
    )
    b.tie(data, "mass", chassis, "mass")
    for field, names in MODEL_NUMBERS.items():
        for (path, value), name in zip(data.numbers(field).items(), names, strict=True):
            b.tie(data, field, chassis, name, value=value, part=path.rpartition(".")[2])
