"""What a run says of the course that its driver followed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hosts.driving.driver import Driver
from hosts.driving.result import Result


def course_result(result: Result, driver: Driver) -> tuple[list[tuple[str, str]], NDArray[np.float64]]:
    """The row of the summary table that says whether the vehicle stayed inside the gates, none without its path; and
    the gates, of shape (gates, 4): first and last x, right and left y, m.
    """
    gates = np.array([(g.x_start, g.x_end, g.y_right, g.y_left) for g in driver.course.gates])
    if any(f"chassis.{name}" not in result for name in ("x", "y", "yaw")):
        return [], gates
    x, y, yaw = (result[f"chassis.{name}"] for name in ("x", "y", "yaw"))
    out = driver.course.corners_outside(x, y, yaw, driver.settings.vehicle_length, driver.settings.vehicle_width)
    return [(driver.course.name, f"passed, {-out:.2f} m to spare" if out <= 0.0 else f"missed by {out:.2f} m")], gates
