"""The PUMA 560 in SI units and its manoeuvre.

Link data: P. Corke, B. Armstrong-Helouvry, "A search for consensus among model parameters reported for the PUMA 560
robot", IEEE ICRA 1994, in standard Denavit-Hartenberg axes, ``T(i-1, i) = Rz(q_i) Tz(d) Tx(a) Rx(alpha)``; base axes
with z up. Mass and inertia of the waist are free but for its axial moment of 0.35 kg m2. The manoeuvre is of the
project: the paper (section 3.2) gives its three stages and their durations.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

GRAVITY = 9.81
START_DEG = (-30.0, -20.0, -60.0, 0.0, 30.0, 0.0)
"""Joint angles at the start, to which the manoeuvre returns."""
HAND_POINT = (0.05, 0.0, 0.20)
"""m, in the axes of link 6: on the gripper, off the roll axis."""
STAGES_S = (2.0, 4.0, 2.0)

FOREARM_EXCESS = 0.01
"""kg m2. No distribution of mass has the moments measured for the forearm (0.066, 0.086, 0.0125). Its rate about the
parallel axes of joints 2 and 3 is the rate of the sum of their angles, so a part of the moment about them belongs to
the angle of the forearm against the waist: the motion is the same."""


@dataclass(frozen=True)
class Link:
    """One link: Denavit-Hartenberg d, a in m and alpha in degrees; mass in kg, centre of mass in m and principal
    moments in kg m2 in link axes; inertia of its motor at the joint, kg m2."""

    name: str
    d: float
    a: float
    alpha_deg: float
    mass: float
    com: tuple[float, float, float]
    inertia: tuple[float, float, float]
    armature: float


LINKS = (
    Link("waist", 0.672, 0.0, 90.0, 10.0, (0.0, 0.0, 0.0), (0.35, 0.35, 0.35), 62.6111**2 * 200e-6),
    Link("upper arm", 0.0, 0.4318, 0.0, 17.4, (-0.3638, 0.006, 0.2275), (0.13, 0.524, 0.539), 107.815**2 * 200e-6),
    Link(
        "forearm",
        0.15005,
        0.0203,
        -90.0,
        4.8,
        (-0.0203, -0.0141, 0.070),
        (0.066, 0.086 - FOREARM_EXCESS, 0.0125),
        53.7063**2 * 200e-6,
    ),
    Link("wrist roll", 0.4318, 0.0, 90.0, 0.82, (0.0, 0.019, 0.0), (1.8e-3, 1.3e-3, 1.8e-3), 76.0364**2 * 33e-6),
    Link("wrist bend", 0.0, 0.0, -90.0, 0.34, (0.0, 0.0, 0.0), (0.3e-3, 0.4e-3, 0.3e-3), 71.923**2 * 33e-6),
    Link("hand", 0.0, 0.0, 0.0, 0.09, (0.0, 0.0, 0.032), (0.15e-3, 0.15e-3, 0.04e-3), 76.686**2 * 33e-6),
)


def frames(angles_deg: tuple[float, ...]) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Axes (columns of a matrix) and origin, m, of the base and of every link in base axes."""
    R, p = np.eye(3), np.zeros(3)
    frames_of_links = [(R, p)]
    for link, angle in zip(LINKS, angles_deg, strict=True):
        c, s = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
        ca, sa = np.cos(np.deg2rad(link.alpha_deg)), np.sin(np.deg2rad(link.alpha_deg))
        p = p + R @ np.array([link.a * c, link.a * s, link.d])
        R = R @ np.array([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0.0, sa, ca]])
        frames_of_links.append((R, p))
    return frames_of_links
