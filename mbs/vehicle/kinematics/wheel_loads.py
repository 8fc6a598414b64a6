"""Loads of springs, stops and bars at the contact centres, and their slopes, by virtual work.

With g_j = -Q . dq/dz_j the load on wheel centre j, and dz_i/dz_j the rise of contact centre i, vertical loads F at the
contact centres satisfy sum_i F_i dz_i/dz_j = g_j. As a wheel leans its contact centre rises relative to its centre; the
load on the lever of that is part of the wheel rate.
"""

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.kinematics.wheel_motion import wheel_motion
from mbs.vehicle.linkages.linkage import Linkage, Position

Array = NDArray[np.float64]

OWN = np.eye(3)[:2]
SHIFT = 1e-6  # m of wheel travel between which the slope of a force is taken


def wheel_loads(linkage: Linkage, at: Position, direction: Array) -> tuple[Array, Array]:
    """Loads of the left and the right wheel, and their slopes along a direction of travel.

    How the way of the linkage bends is exact; only the slope of the springs' forces is a central difference.

    `direction`: rates of the travels of the left and the right wheel, and of the rack, shape (3,).

    Returns
    -------
    loads : ndarray, shape (2,)
        N.
    slopes : ndarray, shape (2,)
        N/m.
    """
    v, force = at.tangent @ direction, linkage.force(at.q)
    force_slope = (linkage.force(at.q + SHIFT * v) - linkage.force(at.q - SHIFT * v)) / (2.0 * SHIFT)
    left, right, along, with_left, with_right = linkage.bends(
        at, np.column_stack([*OWN, direction, *(OWN + direction)])
    ).T
    bends = 0.5 * np.array([with_left - left - along, with_right - right - along])
    on_centres = -(force @ at.tangent[:, :2])
    on_centres_slope = -(force_slope @ at.tangent[:, :2] + bends @ force)
    rise, rise_slope = np.zeros((2, 2)), np.zeros((2, 2))
    for i in range(2):
        w = wheel_motion(linkage, at, i)
        lean, rate = w.axis[2], w.axis_rate[2]
        upright = float(np.sqrt(1.0 - lean**2))
        rise[i] = w.contact_rise[:2]
        axis_bends = bends @ linkage.triad(i)[1][0][2]
        rise_slope[i] = w.radius * (rate[:2] * (rate @ direction) / upright**3 + lean * axis_bends / upright)
    loads = np.linalg.solve(rise.T, on_centres)
    return np.asarray(loads), np.asarray(np.linalg.solve(rise.T, on_centres_slope - rise_slope.T @ loads))
