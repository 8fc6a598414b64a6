"""Loads of springs, stops and bars at the contact centres, and their slopes, by virtual work.

With the loads g_j = -Q . dq/dz_j on the wheel centres and the rises dz_i/dz_j of the contact centres, the vertical
loads F at the contact centres satisfy sum_i F_i dz_i/dz_j = g_j. The contact centre of an inclined wheel rises relative
to the wheel centre; the load times the change of this rise is part of the wheel rate.
"""

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.kinematics.wheel_motion import wheel_motion
from mbs.vehicle.linkages.linkage import Linkage, Position

Array = NDArray[np.float64]

SINGLE = np.eye(3)[:2]
SHIFT = 1e-6  # m, of wheel travel, for the central difference of forces


def wheel_loads(linkage: Linkage, position: Position, direction: Array) -> tuple[Array, Array]:
    """Loads of the left and the right wheel, and their slopes along a direction of travel.

    The second derivatives of the linkage are exact; only the slope of the spring forces is a central difference.

    `direction`: rates of the travels of the left and the right wheel, and of the rack, shape (3,).

    Returns
    -------
    loads : ndarray, shape (2,)
        N.
    slopes : ndarray, shape (2,)
        N/m.
    """
    v, force = position.tangent @ direction, linkage.force(position.q)
    force_slope = (linkage.force(position.q + SHIFT * v) - linkage.force(position.q - SHIFT * v)) / (2.0 * SHIFT)
    left, right, along_direction, left_and_direction, right_and_direction = linkage.second_derivatives(
        position, np.column_stack([*SINGLE, direction, *(SINGLE + direction)])
    ).T
    mixed_derivatives = 0.5 * np.array(
        [left_and_direction - left - along_direction, right_and_direction - right - along_direction]
    )
    centre_loads = -(force @ position.tangent[:, :2])
    centre_load_slopes = -(force_slope @ position.tangent[:, :2] + mixed_derivatives @ force)
    rise, rise_slope = np.zeros((2, 2)), np.zeros((2, 2))
    for i in range(2):
        w = wheel_motion(linkage, position, i)
        axis_z, axis_z_rate = w.axis[2], w.axis_rate[2]
        cosine = float(np.sqrt(1.0 - axis_z**2))
        rise[i] = w.contact_rise[:2]
        axis_second_derivatives = mixed_derivatives @ linkage.triad(i)[1][0][2]
        rise_slope[i] = w.radius * (
            axis_z_rate[:2] * (axis_z_rate @ direction) / cosine**3 + axis_z * axis_second_derivatives / cosine
        )
    loads = np.linalg.solve(rise.T, centre_loads)
    return np.asarray(loads), np.asarray(np.linalg.solve(rise.T, centre_load_slopes - rise_slope.T @ loads))
