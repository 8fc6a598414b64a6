"""Small structures the tests share."""

import numpy as np

from mbs.flexible.frame import Beam, Frame
from mbs.flexible.material import Material
from mbs.flexible.section import Section, tube

STEEL = Material(2.1e11, 0.3, 7850.0)
TUBE = tube(0.04, 0.002)


def straight(
    elements: int,
    length: float = 1.5,
    section: Section = TUBE,
    theory: str = "euler_bernoulli",
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0),
    material: Material = STEEL,
) -> Frame:
    """A straight beam of equal elements from the origin."""
    along = np.asarray(direction) / np.linalg.norm(direction)
    positions = np.linspace(0.0, length, elements + 1)[:, None] * along
    beams = [Beam(i, i + 1, section, material) for i in range(elements)]
    return Frame(positions, beams, theory=theory)


def portal() -> Frame:
    """A small space frame of nine nodes without any symmetry, with masses."""
    positions = [
        (0.0, 0.0, 0.0),
        (0.3, 0.05, 0.02),
        (0.6, 0.0, 0.05),
        (0.6, 0.4, 0.0),
        (0.25, 0.45, -0.03),
        (0.0, 0.4, 0.0),
        (0.02, 0.2, 0.3),
        (0.3, 0.25, 0.35),
        (0.62, 0.2, 0.28),
    ]
    pairs = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (0, 6), (5, 6), (6, 7), (7, 8), (8, 2), (8, 3), (1, 7)]
    beams = [Beam(i, j, TUBE, STEEL) for i, j in pairs]
    return Frame(np.array(positions), beams, {2: 1.5, 7: 3.0, 4: 0.7}, [f"N{i}" for i in range(9)])
