"""The shared scenes as trees of revolute joints whose loops are closed at points, and the result of a peer's run."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mbs.scenes import bricard, spatial_chain

Vector = NDArray[np.float64]
Y = np.array([0.0, 1.0, 0.0])
Z = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class PeerRun:
    """A run of another engine."""

    t: Vector
    """Times, s, shape (n,)."""
    positions: Vector
    """Output point at these times, m, shape (n, k)."""
    wall_s: float
    """Wall time of the steps, s."""
    finished: bool
    """Whether it reached its end."""


def sample_times(end: float, samples: int) -> Vector:
    """Ends of `samples` equal intervals and the start, s, shape (samples + 1,)."""
    return np.linspace(0.0, end, samples + 1)


@dataclass(frozen=True)
class Link:
    """A body and its revolute joint on a parent; the axes of all bodies are parallel at the start."""

    parent: int
    """Number of the body that carries the joint; 0: the ground."""
    position: Vector
    """Joint from the joint of the parent, m, shape (3,)."""
    axis: Vector
    """Unit vector along the joint's axis, shape (3,)."""
    centre: Vector
    """Centre of mass from the joint, m, shape (3,)."""
    inertia: Vector
    """Inertia about the centre of mass, kg m2, shape (3, 3)."""
    mass: float
    """kg."""
    rate: float = 0.0
    """Initial rate of the joint, rad/s."""


@dataclass(frozen=True)
class Closure:
    """Two points that coincide: bodies (0: the ground) and positions on them, m."""

    body_1: int
    point_1: Vector
    body_2: int
    point_2: Vector


@dataclass
class Tree:
    """A scene; its bodies are numbered from 1."""

    gravity: Vector
    """m/s2, shape (3,)."""
    body: int
    """Body of the output point."""
    point: Vector
    """Output point from the joint of its body, m, shape (3,)."""
    components: list[int]
    """Components of the output point that are compared."""
    links: list[Link] = field(default_factory=list)
    closures: list[Closure] = field(default_factory=list)

    def add(self, link: Link) -> int:
        """Add a body; returns its number."""
        self.links.append(link)
        return len(self.links)


def tree_of(scene: str) -> Tree:
    """Tree of a shared scene, by its name."""
    if "four_bar" in scene:
        return _four_bar(int(scene.rpartition("_")[2]) if scene[-1].isdigit() else 2)
    return _bricard() if scene == "bricard" else _chain()


def _four_bar(windows: int) -> Tree:
    right, inertia = np.array([1.0, 0.0, 0.0]), np.eye(3) / 12.0
    tree = Tree(-9.81 * Z, 1, Z, [0, 2])
    cranks, couplers = [], []
    for i in range(windows + 1):
        cranks.append(tree.add(Link(0, i * right, Y, 0.5 * Z, inertia, 1.0, 1.0)))
        if i < windows:
            couplers.append(tree.add(Link(cranks[i], Z, Y, 0.5 * right, inertia, 1.0, -1.0)))
    tree.closures += [Closure(couplers[i], right, cranks[i + 1], Z) for i in range(windows)]
    return tree


def _bricard() -> Tree:
    points, last = np.array(bricard.POINTS, float) * bricard.LENGTH, 0
    tree = Tree(-9.81 * Y, 2, points[2] - points[1], [0, 1, 2])
    for k in range(5):
        along = points[k + 1] - points[k]
        position = points[0] if k == 0 else points[k] - points[k - 1]
        inertia = _rod(along / bricard.LENGTH, bricard.MASS, bricard.LENGTH, bricard.SECTION)
        last = tree.add(Link(last, position, np.array(bricard.AXES[k], float), 0.5 * along, inertia, bricard.MASS))
    end, axis = points[5] - points[4], np.array(bricard.AXES[5], float)
    # two fixed points of the last axis: the revolute joint on the ground
    tree.closures += [Closure(last, end + s * axis, 0, points[5] + s * axis) for s in (0.0, 1.0)]
    return tree


def _chain() -> Tree:
    s, last = spatial_chain, 0
    along, square, across = s.directions()
    inertia = _rod(along, s.MASS, s.LENGTH, s.SECTION)
    tree = Tree(-9.81 * Z, s.LINKS, s.LENGTH * along, [0, 1, 2])
    for k in range(s.LINKS):
        position, axis = s.LENGTH * along if k else np.zeros(3), across if k % 2 == 0 else square
        rate = s.SPIN if k < 2 else 0.0
        last = tree.add(Link(last, position, axis, 0.5 * s.LENGTH * along, inertia, s.MASS, rate))
    return tree


def _rod(along: Vector, mass: float, length: float, side: float) -> Vector:
    """Inertia of a square rod about its centre, kg m2, shape (3, 3). `along`: unit vector; `side`: its section, m."""
    axial, transverse = mass * side**2 / 6.0, mass * (length**2 + side**2) / 12.0
    return np.asarray(transverse * np.eye(3) + (axial - transverse) * np.outer(along, along))
