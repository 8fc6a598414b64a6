"""Sources of sensor values from the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

from enum import IntEnum

from mbs.kernel.header.enumerations import SensorType


class SensorReads(IntEnum):
    """Source of the value of a sensor."""

    MOTION = 0
    INPUTS = 1
    FORCES = 2
    SOLVER = 3
    ROWS = 4


SENSOR_READS = {
    SensorType.SIGNAL: SensorReads.MOTION,
    SensorType.SIGNAL_RATE: SensorReads.MOTION,
    SensorType.SIGNAL_SECOND_RATE: SensorReads.FORCES,
    SensorType.COMPONENT: SensorReads.MOTION,
    SensorType.ANGLE: SensorReads.MOTION,
    SensorType.PITCH: SensorReads.MOTION,
    SensorType.ANGULAR_RATE: SensorReads.MOTION,
    SensorType.QUATERNION: SensorReads.MOTION,
    SensorType.ELEMENT_OUTPUT: SensorReads.FORCES,
    SensorType.REACTION: SensorReads.ROWS,
    SensorType.ENERGY: SensorReads.FORCES,
    SensorType.INPUT: SensorReads.INPUTS,
    SensorType.DRIVING: SensorReads.INPUTS,
    SensorType.SOLVER: SensorReads.SOLVER,
    SensorType.NORM: SensorReads.MOTION,
    SensorType.DIRECTION: SensorReads.MOTION,
    SensorType.ANGLE_ABOUT: SensorReads.MOTION,
    SensorType.QUASI_STATIC: SensorReads.ROWS,
    SensorType.REACTION_PRODUCTS: SensorReads.ROWS,
    SensorType.WORK: SensorReads.FORCES,
    SensorType.MASS: SensorReads.MOTION,
    SensorType.DRIVING_EXCESS: SensorReads.INPUTS,
    SensorType.REACTION_BY_TABLE: SensorReads.ROWS,
    SensorType.DRIVING_WORK: SensorReads.FORCES,
    SensorType.SCALED_INPUT: SensorReads.INPUTS,
    SensorType.CARRIED: SensorReads.MOTION,
}
