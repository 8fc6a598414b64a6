"""Types and codes from the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

from enum import IntEnum


class Status(IntEnum):
    """Codes of `ali3_status`: how a call of the kernel ended."""

    OK = 0
    BAD_ARGUMENT = 1
    BAD_FILE = 2
    BAD_STATE = 3
    NO_MEMORY = 4
    NOT_INITIALISED = 5
    NOT_ASSEMBLED = 6
    NOT_CONVERGED = 7
    SINGULAR = 8
    NOT_FINITE = 9
    WRONG_METHOD = 10
    START_REFUSED = 11
    UNRESOLVED = 12
    NO_TREE = 13
    TOO_STIFF = 14
    TOO_FAR = 15
    NO_EQUILIBRIUM = 16
    BRANCH_CHANGED = 17
    FIXED_PARAMETER = 18
    BAD_ROAD = 19
    ROAD_LOST = 20
    TOO_MUCH_WORK = 21
    WHEEL_IN_ROAD = 22
    BAD_NORMAL = 23
    BEYOND_TABLE = 24
    BAD_INERTIA = 25
    TURNS_TOO_FAR = 26


class Cause(IntEnum):
    """`ali3_cause`: cause of a refusal."""

    CALL = 0
    START = 1
    STEP = 2
    EQUATIONS = 3


class SolverValue(IntEnum):
    """Diagnostics of the solver."""

    ITERATIONS = 0
    VIOLATION = 1
    RESIDUAL = 2
    FACTORIZATIONS = 3
    HALVINGS = 4
    STATUS = 5
    ENERGY_ERROR = 6
    ENERGY_BALANCE = 7
    CAPPED = 8


class ParameterTarget(IntEnum):
    """Target of a parameter."""

    ELEMENT = 0
    DRIVING = 1
    ROAD = 2
    PAYLOAD = 3
    SWITCH = 4
    ARMATURE = 5
    INERTIA = 6
    SENSOR = 7
    AXIS = 8


class DrivingFunctionType(IntEnum):
    """Types of driving functions."""

    OF_TIME = 0
    OF_INPUT = 1
    OF_TWO_INPUTS = 2
    BY_TABLE = 3


class RoadType(IntEnum):
    """Types of roads."""

    PLANE = 0
    KERB = 1
    GRID = 2
    PORT = 3


class JudgedUnit(IntEnum):
    """`ali3_judged.unit`."""

    M = 0
    RAD = 1
    COORDINATE = 2
    N = 3
    M_S = 4
    RAD_S = 5
    N_M = 6
    PA = 7


class JudgedKind(IntEnum):
    """Bits of `ali3_judged.kind`."""

    PLACE = 1
    LOAD = 2
    ALWAYS = 4
    WRAPPED = 8


class SensorType(IntEnum):
    """Types of sensors."""

    SIGNAL = 0
    SIGNAL_RATE = 1
    SIGNAL_SECOND_RATE = 2
    COMPONENT = 3
    ANGLE = 4
    PITCH = 5
    ANGULAR_RATE = 6
    QUATERNION = 7
    ELEMENT_OUTPUT = 8
    REACTION = 9
    ENERGY = 10
    INPUT = 11
    DRIVING = 12
    SOLVER = 13
    NORM = 14
    DIRECTION = 15
    ANGLE_ABOUT = 16
    QUASI_STATIC = 17
    REACTION_PRODUCTS = 18
    WORK = 19
    MASS = 20
    DRIVING_EXCESS = 21
    REACTION_BY_TABLE = 22
    DRIVING_WORK = 23
    SCALED_INPUT = 24
    CARRIED = 25


class ElementType(IntEnum):
    """Types of force elements."""

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
    ELECTRIC_DRIVE = 13
    SPRING_DAMPER_TABLE = 14
    LIFT = 15
    COORDINATE_FRICTION = 16
    TORSION_BAR = 17
    SPIN_ANGLE = 18
    MAGIC_TYRE = 19
    WIND_DRAG = 20
    HUB_WRENCH = 21
