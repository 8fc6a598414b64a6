"""Methods and report codes from the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

from enum import IntEnum


class Update(IntEnum):
    """`ali3_settings.update`."""

    LINEARISED = 0
    PAPER = 1


class Predictor(IntEnum):
    """`ali3_settings.predictor`."""

    PARABOLA = 0
    ACCELERATION = 1


class BranchKind(IntEnum):
    """`ali3_report.branch_kind`."""

    NONE = 0
    LEFT = 1
    JUMP = 2


class Balance(IntEnum):
    """`ali3_report.balance`."""

    KEPT = 0
    OPEN = 1
    WRONG = 2


class MethodNumber(IntEnum):
    """`ali3_settings.method`."""

    ALI3P = 0
    GENERALISED_ALPHA = 1
    ENERGY_MOMENTUM = 2
    ENERGY_MOMENTUM_4 = 3
    RUNGE_KUTTA_8 = 4
    SEMI_RECURSIVE = 5
    SEMI_RECURSIVE_4 = 6
    RADAU_5 = 7


METHOD_ORDERS = {
    MethodNumber.ALI3P: 2,
    MethodNumber.GENERALISED_ALPHA: 1,
    MethodNumber.ENERGY_MOMENTUM: 2,
    MethodNumber.ENERGY_MOMENTUM_4: 3,
    MethodNumber.RUNGE_KUTTA_8: 8,
    MethodNumber.SEMI_RECURSIVE: 8,
    MethodNumber.SEMI_RECURSIVE_4: 4,
    MethodNumber.RADAU_5: 5,
}
"""Orders of the methods with variable steps."""
