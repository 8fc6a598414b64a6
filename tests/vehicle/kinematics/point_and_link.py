"""Positions of the suspensions from their hard points alone, by SciPy's least squares on the poses of rigid uprights.

An independent model: no coordinates, rows or kernel of the engine. The unknowns of a body are its translation, m, and
its rotation vector, rad.
"""

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation


def moved(pose, points):
    """Positions of points of the design position at a pose (translation, rotation vector)."""
    return Rotation.from_rotvec(pose[3:]).apply(points) + pose[:3]


def mirrored(point, side):
    return np.array(point) * [1.0, side, 1.0]


class Upright:
    """One wheel of a double wishbone, MacPherson strut or lower-arm strut; `side` is 1 left and -1 right."""

    def __init__(self, axle, side):
        s = axle.suspension
        self.kind, self.side = s.kind, side
        self.p = {name: mirrored(point, side) for name, point in s.points}
        self.centre = mirrored(axle.wheel.centre, side)
        self.rod = "toe_link" if self.kind == "lower_arm_strut" else "tie_rod"
        self.pose = np.zeros(6)

    def at(self, travel, rack=0.0):
        """Set the pose to a wheel travel and a lateral displacement of the inner tie rod end, m, near the last pose."""
        fit = least_squares(self._off, self.pose, args=(travel, rack), xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale=0.1)
        assert np.abs(fit.fun).max() < 1e-12
        self.pose = fit.x
        return self

    def wheel(self):
        """Wheel centre, and unit vector of the wheel axis to the left."""
        return moved(self.pose, self.centre), Rotation.from_rotvec(self.pose[3:]).apply([0.0, 1.0, 0.0])

    def axis(self):
        """Two points of the steering axis, the lower one first."""
        upper = self.p["strut_top"] if self.kind != "double_wishbone" else moved(self.pose, self.p["upper_ball_joint"])
        return moved(self.pose, self.p["lower_ball_joint"]), upper

    def _off(self, pose, travel, rack):
        p = self.p

        def elongation(fixed, outer):
            return np.linalg.norm(moved(pose, p[outer]) - fixed) - np.linalg.norm(p[outer] - fixed)

        errors = [elongation(p[f"lower_pivot_{end}"], "lower_ball_joint") for end in ("front", "rear")]
        inner = p[f"{self.rod}_inner"]
        rack_end = inner + np.array([0.0, rack, 0.0])
        outer = f"{self.rod}_outer"
        errors.append(np.linalg.norm(moved(pose, p[outer]) - rack_end) - np.linalg.norm(p[outer] - inner))
        errors.append(moved(pose, self.centre)[2] - self.centre[2] - travel)
        if self.kind == "double_wishbone":
            errors += [elongation(p[f"upper_pivot_{end}"], "upper_ball_joint") for end in ("front", "rear")]
        else:
            foot = p["strut_lower" if self.kind == "macpherson" else "lower_ball_joint"]
            axis = p["strut_top"] - foot
            directions = np.linalg.svd(axis[None])[2][1:]  # perpendicular to the strut, fixed to the upright
            gap = p["strut_top"] - moved(pose, foot)
            errors += list(Rotation.from_rotvec(pose[3:]).apply(directions) @ gap)
        return np.array(errors)


class Beam:
    """Both halves of a twist beam."""

    def __init__(self, axle):
        self.points = axle.suspension.points
        self.centres = [mirrored(axle.wheel.centre, side) for side in (1, -1)]
        self.poses = np.zeros(12)

    def at(self, left, right):
        """Set the poses to two wheel travels, m, near the last poses."""
        fit = least_squares(self._off, self.poses, args=((left, right),), xtol=1e-15, ftol=1e-15, gtol=1e-15)
        assert np.abs(fit.fun).max() < 1e-12
        self.poses = fit.x
        return self

    def wheel(self, k):
        """Wheel centre, and unit vector of the wheel axis to the left; k is 0 left, 1 right."""
        pose = self.poses[6 * k : 6 * k + 6]
        return moved(pose, self.centres[k]), Rotation.from_rotvec(pose[3:]).apply([0.0, 1.0, 0.0])

    def _off(self, poses, travel):
        x, _, z = self.points.cross_beam
        middle, lines, errors = np.array([x, 0.0, z]), [], []
        for k, side in enumerate((1, -1)):
            pose = poses[6 * k : 6 * k + 6]
            pivot = mirrored(self.points.pivot, side)
            errors += list(moved(pose, pivot) - pivot)
            errors.append(moved(pose, self.centres[k])[2] - self.centres[k][2] - travel[k])
            lines.append((moved(pose, middle), Rotation.from_rotvec(pose[3:]).apply(np.eye(3))))
        (a, first), (b, second) = lines  # one axis: parallel, and each on the other
        errors += [second[1] @ first[0], second[1] @ first[2], (b - a) @ first[0], (b - a) @ first[2]]
        return np.array(errors)
