"""Two public robots as tables, written as URDF files."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

QUARTER = 1.5707963267948966


class Link(NamedTuple):
    """A link and the turning joint above it."""

    xyz: tuple[float, ...]
    rpy: tuple[float, ...]
    """`xyz`, `rpy`: frame of the joint in that of the link before, m and rad."""
    axis: tuple[float, ...]
    """In that frame."""
    mass: float
    com: tuple[float, ...]
    """`mass`, `com`: in kg, m."""
    inertia: tuple[float, ...]
    """xx, xy, xz, yy, yz, zz about the centre of mass, kg m2."""


def _round(a: float, c: float) -> tuple[float, ...]:
    return a, 0.0, 0.0, a, 0.0, c


X, Y, Z, NONE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
UR5 = [
    Link((0.0, 0.0, 0.089159), NONE, Z, 3.7, NONE, _round(0.010267495893, 0.00666)),
    Link((0.0, 0.13585, 0.0), (0.0, QUARTER, 0.0), Y, 8.393, (0.0, 0.0, 0.28), _round(0.22689067591, 0.0151074)),
    Link((0.0, -0.1197, 0.425), NONE, Y, 2.275, (0.0, 0.0, 0.25), _round(0.049443313556, 0.004095)),
    Link((0.0, 0.0, 0.39225), (0.0, QUARTER, 0.0), Y, 1.219, NONE, _round(0.111172755531, 0.21942)),
    Link((0.0, 0.093, 0.0), NONE, Z, 1.219, NONE, _round(0.111172755531, 0.21942)),
    Link((0.0, 0.0, 0.09465), NONE, Y, 0.1879, NONE, _round(0.0171364731454, 0.033822)),
]
"""Universal Robots UR5: `ur_description` of ROS-Industrial (BSD licence), as in example-robot-data 6.0.0."""

PANDA = [
    Link(
        *((0.0, 0.0, 0.333), NONE, Z, 4.970684, (0.003875, 0.002081, -0.04762)),
        (0.70337, -0.000139, 0.006772, 0.70661, 0.019169, 0.009117),
    ),
    Link(
        *(NONE, (-QUARTER, 0.0, 0.0), Z, 0.646926, (-0.003141, -0.02872, 0.003495)),
        (0.007962, -0.003925, 0.010254, 0.02811, 0.000704, 0.025995),
    ),
    Link(
        *((0.0, -0.316, 0.0), (QUARTER, 0.0, 0.0), Z, 3.228604, (0.027518, 0.039252, -0.066502)),
        (0.037242, -0.004761, -0.011396, 0.036155, -0.012805, 0.01083),
    ),
    Link(
        *((0.0825, 0.0, 0.0), (QUARTER, 0.0, 0.0), Z, 3.587895, (-0.05317, 0.104419, 0.027454)),
        (0.025853, 0.007796, -0.001332, 0.019552, 0.008641, 0.028323),
    ),
    Link(
        *((-0.0825, 0.384, 0.0), (-QUARTER, 0.0, 0.0), Z, 1.225946, (-0.011953, 0.041065, -0.038437)),
        (0.035549, -0.002117, -0.004037, 0.029474, 0.000229, 0.008627),
    ),
    Link(
        *(NONE, (QUARTER, 0.0, 0.0), Z, 1.666555, (0.060149, -0.014117, -0.010517)),
        (0.001964, 0.000109, -0.001158, 0.004354, 0.000341, 0.005433),
    ),
    Link(
        *((0.088, 0.0, 0.0), (QUARTER, 0.0, 0.0), Z, 0.735522, (0.010517, -0.004252, 0.061597)),
        (0.012516, -0.000428, -0.001196, 0.010027, -0.000741, 0.004815),
    ),
]
"""Franka Emika Panda without its hand: inertias identified by C. Gaz et al., IEEE RA-L 4(4), 2019, 4147-4154, as in
example-robot-data 6.0.0."""

ROBOTS = {"ur5": UR5, "panda": PANDA}


def write_urdf(links: list[Link], file: Path, extra: str = "") -> Path:
    """A URDF file of a chain on a base without mass, with a tool without mass; joints are joint_1, joint_2, ..."""
    lines = ['<robot name="robot">', '<link name="link_0"/>']
    for k, link in enumerate(links, start=1):
        names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        inertia = " ".join(f'{n}="{v!r}"' for n, v in zip(names, link.inertia, strict=True))
        lines += [
            f'<link name="link_{k}"><inertial><origin xyz="{_text(link.com)}"/><mass value="{link.mass!r}"/>'
            f"<inertia {inertia}/></inertial></link>",
            f'<joint name="joint_{k}" type="revolute"><parent link="link_{k - 1}"/><child link="link_{k}"/>'
            f'<origin xyz="{_text(link.xyz)}" rpy="{_text(link.rpy)}"/><axis xyz="{_text(link.axis)}"/>'
            '<limit lower="-6.3" upper="6.3" effort="150" velocity="3"/></joint>',
        ]
    lines += [
        '<link name="tool"/><joint name="flange" type="fixed">',
        f'<parent link="link_{len(links)}"/><child link="tool"/><origin xyz="0 0 0.1"/></joint>{extra}</robot>',
    ]
    file.write_text("\n".join(lines), encoding="utf-8")
    return file


def states(name: str) -> np.ndarray:
    """Angles, rates and accelerations of the joints in eight states; shape (8, 3, joints)."""
    spread = np.array([2.5, 2.0, 8.0])[:, None]  # rad, rad/s, rad/s2
    random = np.random.default_rng(25).uniform(-1.0, 1.0, (8, 3, len(ROBOTS[name])))
    return np.asarray(random * spread)


def _text(values: tuple[float, ...]) -> str:
    return " ".join(map(repr, values))
