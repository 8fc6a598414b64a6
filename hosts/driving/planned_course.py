"""Plans the line of least curvature through the cones of a course."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.optimize import linprog
from scipy.sparse import csr_array, hstack, vstack

from hosts.common.errors import HostError
from hosts.driving.course import Course

BEHIND = 30.0  # m of straight behind the last lane
KNOTS = 2.0  # m between knots of the spline
DEGREE = 5  # of the spline
STATIONS = 9  # along the car, at which its sides must keep clear of the cones
SAMPLES = 0.5  # m between samples of curvature and clearance
ROOM_LEFT = 0.5  # share of the clearance of the car that remains for errors of the driver
BEND_LENGTH = 3.0  # m; weight of the largest rate of the curvature along x against the largest curvature
SMOOTHNESS = 0.01  # weight of the sum of all rates, which makes the solution unique


@dataclass(frozen=True)
class PlannedCourse(Course):
    """A course with a given line."""

    line: Callable[[float], tuple[float, float, float]]
    """Function of x, m: y, m, its slope and second derivative, 1/m."""

    def path(self, x: float) -> tuple[float, float, float]:
        y, slope, bend = self.line(x)
        return y, slope, bend / (1.0 + slope**2) ** 1.5


@lru_cache(maxsize=32)
def planned(course: Course, begin: float, length: float, width: float) -> PlannedCourse:
    """The course with the line of least curvature.

    `begin`: end of the straight line in the middle of the first lane, m; `length`, `width`: outline of the car, whose
    centre follows the line, m. Raises `HostError` if a car of this width does not fit through.

    Notes
    -----
    A quintic spline y(x), whose largest second derivative and, weighted, third derivative are least, while both sides
    of the car, y + a y' ± width / 2 for a along the car, keep half of the clearance of each lane. For slopes that are
    small against one this is a linear program.
    """
    for k, gate in enumerate(course.gates):
        if gate.y_left - gate.y_right <= width:
            raise HostError(
                f"{course.name}: lane {k + 1} is {gate.y_left - gate.y_right:.3g} m wide; a car of {width:.3g} m "
                "does not fit in."
            )
    end = course.gates[-1].x_end + BEHIND
    inner = np.linspace(begin, end, round((end - begin) / KNOTS) + 1)
    knots = np.concatenate([np.full(DEGREE, begin), inner, np.full(DEGREE, end)])
    number = len(knots) - DEGREE - 1
    spline = BSpline(knots, np.eye(number), DEGREE)
    x = np.linspace(begin, end, round((end - begin) / SAMPLES) + 1)
    matrix, bounds = _inequalities(course, x, spline, length, width)
    ends = csr_array(np.vstack([spline(at, nu) for at in (begin, end) for nu in (0, 1, 2)]))
    fixed = np.array([course.gates[0].centre, 0.0, 0.0, course.gates[-1].centre, 0.0, 0.0])
    cost = np.concatenate([np.zeros(number), [1.0, BEND_LENGTH], np.full(len(x), SMOOTHNESS * SAMPLES)])
    solve: Any = linprog
    result = solve(
        cost,
        matrix,
        bounds,
        hstack([ends, csr_array((6, 2 + len(x)))]),
        fixed,
        [(None, None)] * number + [(0.0, None)] * (2 + len(x)),
    )
    if not result.success:
        raise HostError(f"{course.name}: no line was found through it for a car of {length:.3g} m: {result.message}")
    line = BSpline(knots, result.x[:number], DEGREE)
    first, second = line.derivative(1), line.derivative(2)

    def at(place: float) -> tuple[float, float, float]:
        place = min(max(place, begin), end)
        return float(line(place)), float(first(place)), float(second(place))

    return PlannedCourse(course.name, course.gates, at)


def _inequalities(
    course: Course, x: NDArray[np.float64], spline: BSpline, length: float, width: float
) -> tuple[csr_array, NDArray[np.float64]]:
    """Matrix A and bounds b of A u <= b for the linear program.

    Unknowns u: coefficients of the spline, largest second and third derivative, and magnitude of the third derivative
    at each sample. `x`: samples, m; `spline`: its basis; `length`, `width`: as for `planned`.
    """
    values, slopes, bends, changes = (csr_array(spline(x, nu)) for nu in range(4))
    rows, bounds = [], []

    def demand(matrix: csr_array, column: tuple[float, float], most: NDArray[np.float64]) -> None:
        height = matrix.shape[0]
        rows.append(hstack([matrix, csr_array(np.tile(column, (height, 1))), csr_array((height, len(x)))]))
        bounds.append(most)

    none = np.zeros(len(x))
    for sign in (1.0, -1.0):
        demand(sign * bends, (-1.0, 0.0), none)
        demand(sign * changes, (0.0, -1.0), none)
        rows.append(hstack([sign * changes, csr_array((len(x), 2)), csr_array(-np.eye(len(x)))]))
        bounds.append(none)
    for along in np.linspace(-0.5 * length, 0.5 * length, STATIONS):
        for gate in course.gates:
            within = (x + along >= gate.x_start) & (x + along <= gate.x_end)
            sides = (values + along * slopes)[within]
            room = 0.5 * (gate.y_left - gate.y_right - width) * (1.0 - ROOM_LEFT)
            demand(sides, (0.0, 0.0), np.full(sides.shape[0], gate.centre + room))
            demand(-sides, (0.0, 0.0), np.full(sides.shape[0], room - gate.centre))
    return vstack(rows), np.concatenate(bounds)
