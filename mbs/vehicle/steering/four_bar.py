"""Planar linkage of Pitman arm, centre link and idler arm: positions as functions of the angle of the arm.

Points in the plane of the linkage are complex numbers. The joint of the arm turned by phi about P is
``A = P + (A0 - P) e^(i phi)``; the joint B of link and idler arm is the intersection of circles about A and about the
pivot I of the idler arm, on the side of the drawing. The rates follow from the velocity of B, which is perpendicular to
the idler arm.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FourBar:
    """A linkage as drawn."""

    pivot: complex
    """Joint of the Pitman arm and the chassis, m."""
    joint: complex
    """Joint of the Pitman arm and the link, m."""
    idler_pivot: complex
    """Joint of the idler arm and the chassis, m."""
    idler_joint: complex
    """Joint of the idler arm and the link, m."""

    def turned(self, phi: Array) -> tuple[Array, Array, Array]:
        """Joint of the arm and rotation of the link at angles of the arm.

        `phi`: rad, from the drawing, shape (n,).

        Returns
        -------
        joint : ndarray of complex, shape (n,)
            Position, m; NaN if the linkage does not close.
        turn, rate : ndarray, shape (n,)
            Rotation of the link, rad, and its derivative by the angle of the arm; NaN if the linkage does not close.
        """
        lever, link = self.joint - self.pivot, self.idler_joint - self.joint
        idler = self.idler_joint - self.idler_pivot
        joint = self.pivot + lever * np.exp(1j * phi)
        gap = self.idler_pivot - joint
        along = (abs(link) ** 2 - abs(idler) ** 2 + np.abs(gap) ** 2) / (2.0 * np.abs(gap))
        with np.errstate(invalid="ignore"):
            across = np.sign(_cross(self.idler_pivot - self.joint, link)) * np.sqrt(abs(link) ** 2 - along**2)
            turned_link = gap / np.abs(gap) * (along + 1j * across)
            turn = np.angle(turned_link / link)
            idler_arm = joint + turned_link - self.idler_pivot
            rate = -_cross(idler_arm, joint - self.pivot) / _cross(idler_arm, turned_link)
        return joint, turn, rate

    def lever(self, phi: Array) -> Array:
        """Cosine of the angle of the arm from straight ahead or back, positive as drawn, shape (n,).

        `phi`: angle of the Pitman arm, rad, shape (n,).
        """
        arm = self.joint - self.pivot
        return np.asarray(np.copysign(1.0, arm.real) * np.real(arm * np.exp(1j * phi)) / abs(arm))

    def transmission(self, phi: Array) -> Array:
        """Sine of the angle between link and idler arm, positive as drawn, shape (n,): 0 at a dead point, NaN beyond.

        `phi`: angle of the Pitman arm, rad, shape (n,).
        """
        joint, turn, _ = self.turned(phi)
        link = (self.idler_joint - self.joint) * np.exp(1j * turn)
        idler = joint + link - self.idler_pivot
        drawn_sign = np.sign(_cross(self.idler_joint - self.joint, self.idler_joint - self.idler_pivot))
        return np.asarray(drawn_sign * _cross(link, idler) / np.abs(link * idler))

    def carried(self, point: complex, phi: Array) -> tuple[Array, Array]:
        """Displacement (n,) of a point of the link, m, and its derivative by the angle of the arm, both complex.

        `point`: position as drawn, m; `phi`: angle of the Pitman arm, rad, shape (n,).
        """
        joint, turn, rate = self.turned(phi)
        arm = (point - self.joint) * np.exp(1j * turn)
        return joint + arm - point, 1j * (joint - self.pivot + rate * arm)


def _cross(a: Array | complex, b: Array | complex) -> Array:
    """Cross product of vectors as complex numbers."""
    return np.asarray(np.imag(np.conj(a) * b))
