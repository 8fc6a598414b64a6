"""Clearance between the outline of a car and the cones of a course."""

import numpy as np
from numpy.typing import NDArray

from hosts.driving.course import Course


def outline(
    x: NDArray[np.float64], y: NDArray[np.float64], yaw: NDArray[np.float64], length: float, width: float
) -> NDArray[np.float64]:
    """Corners of rectangles: front left, rear left, rear right, front right, m, shape (n, 4, 2).

    `x`, `y`, `yaw`: centre and heading in the same axes, m and rad, shape (n,); `length`, `width`: m.
    """
    ahead, aside = np.stack([np.cos(yaw), np.sin(yaw)], -1), np.stack([-np.sin(yaw), np.cos(yaw)], -1)
    signs = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * 0.5 * np.array([length, width])
    centre = np.stack([x, y], -1)
    return np.asarray(centre[:, None] + signs[:, :1] * ahead[:, None] + signs[:, 1:] * aside[:, None])


def clearance(
    course: Course,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    yaw: NDArray[np.float64],
    length: float,
    width: float,
) -> NDArray[np.float64]:
    """Distance of a car's outline from the cones along the edges of the lanes, m, shape (n,).

    `x`, `y`, `yaw`: centre of the outline and heading, m and rad, in the axes of the course, shape (n,); `length`,
    `width`: m. A negative distance is the depth by which cones are hit; between lanes the distance is infinite.

    Notes
    -----
    Two disjoint convex figures are closest at a corner of one of them: the distance is the smallest of those of the
    corners of the outline from the edges, and of the ends of the edges from the outline.
    """
    smallest = np.full(len(x), np.inf)
    corners = outline(x, y, yaw, length, width)
    for gate in course.gates:
        is_within = (corners[..., 0] >= gate.x_start) & (corners[..., 0] <= gate.x_end)
        beside = np.minimum(gate.y_left - corners[..., 1], corners[..., 1] - gate.y_right)
        smallest = np.minimum(smallest, np.where(is_within, beside, np.inf).min(axis=1))
        for end in (gate.x_start, gate.x_end):
            for edge in (gate.y_left, gate.y_right):
                dx, dy = end - x, edge - y
                ahead = np.abs(np.cos(yaw) * dx + np.sin(yaw) * dy) - 0.5 * length
                aside = np.abs(np.cos(yaw) * dy - np.sin(yaw) * dx) - 0.5 * width
                distance = np.hypot(np.maximum(ahead, 0.0), np.maximum(aside, 0.0))
                # Only cones beside the outline count, not those ahead of it or behind it.
                to_end = np.where(ahead <= 0.0, distance + np.minimum(np.maximum(ahead, aside), 0.0), np.inf)
                smallest = np.minimum(smallest, to_end)
    return smallest
