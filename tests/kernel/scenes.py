"""Systems written by hand, shared by the kernel tests."""

import numpy as np

from mbs.kernel.header.enumerations import DrivingFunctionType, ElementType, SensorType

from .system_builder import Element, Row, SystemBuilder, distance_row

GRAVITY = 9.81


def pendulum() -> SystemBuilder:
    """A01: 1 kg on a massless rod of 1 m, starting horizontally at rest; sensors x, y, total energy."""
    b = SystemBuilder(
        np.eye(2), [-1.0, 0.0], gravity=[0.0, -GRAVITY], rows=[distance_row((0.0, 0.0), (0, 1), 1.0, True)]
    )
    x, y = b.signal({0: 1.0}), b.signal({1: 1.0})
    b.sensors = [(SensorType.SIGNAL, [x], [1.0]), (SensorType.SIGNAL, [y], [1.0]), (SensorType.ENERGY, [3], [])]
    return b


def four_bar(windows: int = 2, groups: list[int] | None = None) -> SystemBuilder:
    """A02 in the coordinates of the crank tips B_i: uniform links of 1 m and 1 kg, cranks upright, tips at 1 m/s.

    Sensors: x, y of the first tip, total energy.
    """
    n = windows + 1
    M = np.zeros((2 * n, 2 * n))
    Q = np.zeros(2 * n)
    for i in range(n):
        M[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] += np.eye(2) / 3
        Q[2 * i + 1] -= 0.5 * GRAVITY
    for i in range(windows):
        a, b = slice(2 * i, 2 * i + 2), slice(2 * i + 2, 2 * i + 4)
        for p, q, part in ((a, a, 3), (b, b, 3), (a, b, 6), (b, a, 6)):
            M[p, q] += np.eye(2) / part
        Q[[2 * i + 1, 2 * i + 3]] -= 0.5 * GRAVITY
    rows = [distance_row((float(i), 0.0), (2 * i, 2 * i + 1), 1.0, True) for i in range(n)]
    rows += [distance_row((2 * i, 2 * i + 1), (2 * i + 2, 2 * i + 3), 1.0, False) for i in range(windows)]
    q0 = np.array([[i, 1.0] for i in range(n)]).ravel()
    builder = SystemBuilder(M, q0, np.tile([1.0, 0.0], n), Q, rows, groups)
    x, y = builder.signal({0: 1.0}), builder.signal({1: 1.0})
    builder.sensors = [(SensorType.SIGNAL, [x], [1.0]), (SensorType.SIGNAL, [y], [1.0]), (SensorType.ENERGY, [3], [])]
    return builder


def sleigh() -> SystemBuilder:
    """A planar body (centre r, unit vector a) on a knife edge 0.3 m behind its centre, with a wheel of radius 0.2 m
    whose angle rolls with the way along a; pushed by an input. Sensors: x, y of the edge, angle, total energy.
    """
    arm = 0.3
    rows = [
        Row(-0.5, quad={(2, 2): 0.5, (3, 3): 0.5}),
        Row(0.0, rates={(2, 1): 1.0, (2, 3): -arm, (3, 0): -1.0, (3, 2): arm}),  # a_x p_y' - a_y p_x', p = r - arm a
        Row(0.0, lin={4: 0.2}, rates={(2, 0): -1.0, (3, 1): -1.0}),
    ]
    mass, velocity = np.diag([2.0, 2.0, 0.5, 0.5, 0.01]), [0.5, 0.3, 0.0, 1.0, 2.5]
    b = SystemBuilder(mass, [arm, 0.0, 1.0, 0.0, 0.0], velocity, rows=rows, groups=[2, 3])
    b.inputs = [(0.0, -5.0, 5.0)]
    x, y, angle = b.signal({0: 1.0, 2: -arm}), b.signal({1: 1.0, 3: -arm}), b.signal({4: 1.0})
    b.elements = [Element(ElementType.INPUT_FORCE, [x], [1.0], [0])]
    b.sensors = [
        (SensorType.SIGNAL, [x], [1.0]),
        (SensorType.SIGNAL, [y], [1.0]),
        (SensorType.SIGNAL, [angle], [1.0]),
        (SensorType.ENERGY, [3], []),
    ]
    return b


def everything() -> SystemBuilder:
    """Two planar points with a spring, a distance and an angle row, two driving functions, input and parameter."""
    M = np.diag([1.0, 2.0, 1.5, 2.5, 0.0])
    rows = [
        distance_row((0, 1), (2, 3), 1.25, False),
        Row(0.0, theta=4, angle=[(2, -1, 1.0, 0.0), (0, -1, -1.0, 0.0), (3, -1, 0.0, 1.0), (1, -1, 0.0, -1.0)]),
        Row(
            -1.0,
            {0: 1.0, 1: 0.5},
            {},
            guided=[(0, 1, 1, -1, 0.3), (0, 2, -1, -1, 0.2), (1, 2, 1, 0, 0.1), (1, 1, 0, 0, 0.4)],
        ),
    ]
    q0 = [0.8, 0.3, 1.55, 1.3, np.arctan2(1.0, 0.75)]
    b = SystemBuilder(M, q0, [0.1, -0.2, 0.3, 0.2, 0.0], [0.0, -9.81 * 2, 0.0, -9.81 * 2.5, 0.0], rows, [2, 1, 2])
    b.inputs = [(0.0, -1.0, 1.0)]
    quintic = [0.0, 0.0, 0.0, 10.0, -15.0, 6.0]
    b.guides = [
        (DrivingFunctionType.OF_INPUT, 0, [20.0, 0.5, 0.0]),
        (DrivingFunctionType.OF_TIME, -1, [2.0, 0.0, 1.0, 2.0, *quintic, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ]
    dx, dy = b.signal({0: -1.0, 2: 1.0}), b.signal({1: -1.0, 3: 1.0}, 0.5)
    b.elements = [
        Element(ElementType.SPRING_DAMPER, [dx, dy], [400.0, 20.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1e9, 0.0], outputs=4)
    ]
    b.parameters = [(400.0, 0.0, 1000.0, [(0, 0, 1.0)])]
    b.sensors = [
        (SensorType.SIGNAL, [dx], [1.0]),
        (SensorType.ELEMENT_OUTPUT, [0, 1], [1.0]),
        (SensorType.INPUT, [0], []),
        (SensorType.DRIVING, [0, 0], [1.0]),
        (SensorType.ENERGY, [3], []),
        (SensorType.REACTION, [1, 0], [1.0]),
        (SensorType.WORK, [1, 1, 0], []),
    ]
    return b
