"""Overconstrained loops as they are drawn: every number of a drawing goes through a pen that rounds or shifts it."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mbs import Model
from mbs.model.body import Body
from mbs.scenes import bricard as scene

Array = NDArray[np.float64]
Pen = Callable[[Array], Array]


def exact(v: Array) -> Array:
    """The drawing as it should be."""
    return np.asarray(v, dtype=float)


def shifted(size: float, seed: int = 3) -> Pen:
    """Every number off by up to `size`, always in the same way."""
    random = np.random.default_rng(seed)
    return lambda v: np.asarray(v, dtype=float) + size * random.uniform(-1.0, 1.0, np.shape(v))


def _loop(m: Model, points: Array, axes: Array, pen: Pen, density: float = 2.0) -> list[Body]:
    """A closed chain of slender bars from joint to joint, the first one the ground."""
    bodies = [m.ground]
    for k in range(len(points) - 1):
        p, q = points[k], points[k + 1]
        length = float(np.linalg.norm(q - p))
        e = (q - p) / length
        mass = density * length
        inertia = mass * length**2 / 12.0 * (np.eye(3) - np.outer(e, e)) + 1e-3 * mass * length**2 * np.eye(3)
        bodies.append(m.body(f"link {k + 1}", mass=mass, com=0.5 * (p + q), inertia=inertia))
    for k, (p, u) in enumerate(zip(points, axes, strict=True)):
        m.revolute("ABCDEFGH"[k], bodies[k], bodies[(k + 1) % len(bodies)], point=pen(p), axis=pen(u))
    return bodies


def bennett_joints(a: float = 1.0, b: float = 1.5, alpha: float = 0.6, theta: float = 1.1) -> tuple[Array, Array]:
    """Points and axes of a Bennett loop: opposite links are alike and a / sin(alpha) = b / sin(beta)."""
    beta = np.arcsin(b * np.sin(alpha) / a)
    other = 2.0 * np.arctan2(np.sin(0.5 * (beta + alpha)), np.sin(0.5 * (beta - alpha)) * np.tan(0.5 * theta))
    T = np.eye(4)
    points, axes = [], []
    for turn, length, twist in ((theta, a, alpha), (other, b, beta), (-theta, a, alpha), (-other, b, beta)):
        points.append(T[:3, 3].copy())
        axes.append(T[:3, 2].copy())
        c, s, ct, st = np.cos(turn), np.sin(turn), np.cos(twist), np.sin(twist)
        T = T @ np.array(
            [[c, -s * ct, s * st, length * c], [s, c * ct, -c * st, length * s], [0.0, st, ct, 0.0], [0, 0, 0, 1]]
        )
    assert np.allclose(T, np.eye(4), atol=1e-12)
    return np.array(points), np.array(axes)


def bennett(pen: Pen = exact) -> Model:
    """Four bars, one freedom where Kutzbach counts -2."""
    m = Model("Bennett", dimension=3)
    points, axes = bennett_joints()
    bodies = _loop(m, points, axes, pen)
    _sensors(m, bodies[1], points[1])
    return m


def bricard(pen: Pen = exact) -> Model:
    """Bricard's loop of six equal bars with square twists."""
    m = Model("Bricard", dimension=3)
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    points = np.array(scene.POINTS, dtype=float) @ turn.T
    bodies = _loop(m, points, np.array(scene.AXES, dtype=float) @ turn.T, pen)
    _sensors(m, bodies[2], points[2])
    return m


def parallelogram(pen: Pen = exact) -> Model:
    """A parallelogram of hinges in space: three of its conditions say nothing new."""
    m = Model("parallelogram", dimension=3)
    points = np.array([[0, 0, 0], [0.3, 0, 0.4], [1.3, 0, 0.4], [1.0, 0, 0]])
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    bodies = _loop(m, points @ turn.T, np.array([[0, 1.0, 0]] * 4) @ turn.T, pen)
    _sensors(m, bodies[2], (points @ turn.T)[1])
    return m


def redundant_rod(pen: Pen = exact, five: bool = False, rods: bool = False) -> Model:
    """Planar: parallel cranks carry a plate, one more than needed. With `five` their feet stand on a link that
    turns about the ground; with `rods` the last crank is a massless rod.
    """
    m = Model("redundant rod", dimension=2)
    arm = np.array([0.3, 0.4])
    feet = np.array([[0.0, 0.0], [1.0, 0.1], [2.0, -0.2]])
    if five:
        base = m.body("base", mass=1.0, com=(1.0, -0.5), inertia=0.2)
        m.revolute("pivot", m.ground, base, point=pen(np.array([0.7, -1.0])))
    else:
        base = m.ground
    plate = m.body("plate", mass=3.0, com=(1.0, 0.4), inertia=0.8)
    for k, foot in enumerate(feet):
        if rods and k == 2:
            m.distance("rod", (base, pen(foot)), (plate, pen(foot + arm)), length=float(pen(np.array([0.5]))[0]))
            continue
        crank = m.body(f"crank {k}", mass=0.5, com=foot + 0.5 * arm, inertia=0.02)
        m.revolute(f"foot {k}", base, crank, point=pen(foot))
        m.revolute(f"head {k}", crank, plate, point=pen(foot + arm))
    _sensors(m, plate, feet[0] + arm)
    return m


def _sensors(m: Model, body: Body, point: Array) -> None:
    for component in "xyz"[: m.dimension]:
        m.sense_position(component, body, point, component)
    m.sense_energy("energy")


def scissor_lift(pen: Pen, guide: str, turn: float, scale: float) -> Model:
    """Planar: crossed bars lift a plate that a driving function holds upright, as the bars do already."""
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, -s], [s, c]])
    m = Model("scissor lift", dimension=2, gravity=tuple(9.81 * scale * R @ (0.0, -1.0)))

    def at(x: float, y: float) -> Array:
        return scale * R @ pen(np.array([x, y]))

    def along(x: float, y: float) -> Array:
        return R @ pen(np.array([x, y]))

    middle, height = scale * R @ np.array([0.8, 0.3]), 0.6
    up, down = (m.body(name, mass=1.0, com=middle, inertia=0.2 * scale**2) for name in ("up", "down"))
    m.revolute("middle", up, down, point=at(0.8, 0.3))
    m.revolute("left", m.ground, up, point=at(0.0, 0.0))
    m.point_on_line("slide", (down, at(1.6, 0.0)), (m.ground, at(1.6, 0.0)), axis=along(1.0, 0.0))
    centre = scale * R @ np.array([0.8, height])
    plate = m.body("plate", mass=5.0, com=centre, inertia=scale**2)
    m.revolute("head", plate, down, point=at(0.0, height))
    over = 0.0 if guide == "head" else 1.6  # a line through the head: its end there is the head's but for the drawing
    m.point_on_line("top", (up, at(1.6, height)), (plate, at(over, height)), axis=along(1.0, 0.0))
    if guide == "line":
        m.point_on_line("guide", (plate, at(0.0, height)), (m.ground, at(0.0, 0.0)), axis=along(0.0, 1.0))
    else:
        m.prismatic("guide", plate, m.ground, axis=along(0.0, 1.0), point=at(0.0 if guide == "head" else 0.8, height))
    _sensors(m, plate, centre)
    return m


def three_short_cranks(pen: Pen, length: float) -> Model:
    """Planar: three parallel cranks that are short against the plate on them."""
    m = Model("three short cranks", dimension=2)
    plate = m.body("plate", mass=3.0, com=(1.0, 0.4), inertia=0.8)
    for k, foot in enumerate(np.array([[0.0, 0.0], [1.0, 0.1], [2.0, -0.2]])):
        crank = m.body(f"crank {k}", mass=0.5, com=foot, inertia=0.02)
        m.revolute(f"foot {k}", m.ground, crank, point=pen(foot))
        m.revolute(f"head {k}", crank, plate, point=pen(foot + np.array([0.0, length])))
    return m
