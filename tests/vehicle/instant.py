"""Velocities of suspensions at the design position, from their hard points by linear algebra, without the engine.

The left wheel moves against the chassis by a twist: velocity v of the origin and angular velocity w, so that a point p
moves with v + w x p.
"""

import numpy as np


def point(table, name):
    return np.array(getattr(table, name))


def velocity(twist, p):
    return twist[:3] + np.cross(twist[3:], p)


def moves_along(p, n):
    """Row of the twist for n . (v + w x p) = 0: p has no velocity along n."""
    return np.concatenate([n, np.cross(p, n)])


def macpherson(points):
    """Twist of the upright of a MacPherson strut with arbitrary length; `per_travel` scales it."""
    p = {name: np.array(value) for name, value in points}
    axis = p["lower_pivot_front"] - p["lower_pivot_rear"]
    arm = np.cross(axis, p["lower_ball_joint"] - p["lower_pivot_rear"])  # direction in which the ball joint moves
    strut = p["strut_top"] - p["strut_lower"]
    rows = [moves_along(p["lower_ball_joint"], n) for n in _across(arm)]
    rows += [moves_along(p["strut_top"], n) for n in _across(strut)]
    rows.append(moves_along(p["tie_rod_outer"], p["tie_rod_outer"] - p["tie_rod_inner"]))
    return np.linalg.svd(np.array(rows))[2][-1]


def twist_beam(points, mode):
    """Twist of the left half in bump, or in roll about the line from its pivot through the middle of the shear axis."""
    pivot, beam = point(points, "pivot"), point(points, "cross_beam")
    axis = np.array([0.0, 1.0, 0.0]) if mode == "bump" else np.array([beam[0], 0.0, beam[2]]) - pivot
    return np.concatenate([-np.cross(axis, pivot), axis])


def per_travel(twist, centre):
    """The twist scaled to unit vertical velocity of the wheel centre."""
    return twist / velocity(twist, np.array(centre))[2]


def contact(centre):
    return np.array([centre[0], centre[1], 0.0])


def lever_rate(bar, twist):
    """Angular velocity about +y of a lever of the anti-roll bar for a twist of the upright."""
    pivot, end, link = (point(bar.points, name) for name in ("pivot", "lever_end", "link_end"))
    rod = link - end
    direction = np.cross((0.0, 1.0, 0.0), end - np.array([pivot[0], end[1], pivot[2]]))
    return velocity(twist, link) @ rod / (direction @ rod)


def _across(v):
    """Two orthonormal vectors perpendicular to v."""
    return np.linalg.svd(v[None])[2][1:]
