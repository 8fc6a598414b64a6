"""Element type numbers: part of the System file, equal to the enum in `mbs/kernel/src/elements/element.h`."""

from enum import IntEnum


class ElementType(IntEnum):
    """Force elements the kernel knows."""

    SPRING_DAMPER = 1
    SCALAR_SPRING_DAMPER = 2
    INPUT_FORCE = 3
    BODY_FORCE = 4
    BODY_TORQUE = 5
    GYROSCOPIC_SPIN = 6
    DRAG = 7
    TYRE = 8
    BRAKE = 9
    AUTOMATIC_DRIVE = 10
    CONTACT_POINTS = 11
    SPIN_TORQUE = 12
