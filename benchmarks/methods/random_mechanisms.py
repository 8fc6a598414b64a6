"""Random planar and spatial mechanisms with drives and springs, some through dead centres."""

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

import mbs
from benchmarks.references.rigid_mechanism import GROUND, Joint, Link, Mechanism, Spring

Array = NDArray[np.float64]
PLANE_NORMAL = np.array([0.0, 0.0, 1.0])
NEARLY_EQUAL = 0.3  # fraction of loops that pass close to a dead centre
DEAD_CENTRE_DIFFERENCE = (1e-3, 0.05)  # relative difference of their arms at the dead centre


def random_mechanism(rng: np.random.Generator, dimension: int | None = None) -> tuple[str, Mechanism]:
    """The kind of a random mechanism, and the mechanism; `dimension`: 2, 3, or either."""
    kinds = [kind for kind in KINDS if dimension is None or dimension == (3 if "spatial" in kind else 2)]
    kind = str(rng.choice(kinds))
    return kind, KINDS[kind](rng)


def model_of(d: Mechanism, rates: bool = False) -> mbs.Model:
    """Model of the engine of a mechanism.

    Sensors are positions of the tips, or if `rates` angular velocities, the torque of the drive, and constant or
    prescribed quantities.
    """
    down = (0.0, -d.gravity) if d.dimension == 2 else (0.0, 0.0, -d.gravity)
    m = mbs.Model("random", dimension=d.dimension, gravity=down)
    bodies = [
        m.point_mass(f"b{i}", mass=k.mass, position=k.com)
        if k.inertia is None
        else m.body(f"b{i}", mass=k.mass, com=k.com, inertia=k.inertia)
        for i, k in enumerate(d.links)
    ]
    body_of = {GROUND: m.ground, **dict(enumerate(bodies))}
    for i, j in enumerate(d.joints):
        first, second, name = body_of[j.first], body_of[j.second], f"j{i}"
        if j.kind == "pin":
            m.pin(name, first, j.point, on=j.closed[0] <= 0.0)
        elif j.kind == "line":
            m.point_on_line(name, (first, j.point), (m.ground, j.point), axis=j.axis)
        elif j.kind == "ball" or d.dimension == 2:
            (m.spherical if j.kind == "ball" else m.revolute)(name, second, first, point=j.point)
        else:
            m.revolute(name, second, first, point=j.point, axis=j.axis)
    for i, s in enumerate(d.springs):
        ends = (body_of[s.first], s.point_1), (body_of[s.second], s.point_2)
        m.spring_damper(f"s{i}", *ends, stiffness=s.stiffness, damping=s.damping, free_length=s.length)
    axis = {} if d.dimension == 2 else {"axis": d.joints[0].axis}
    if d.torque or d.drive is not None:
        angle = m.relative_angle("angle", m.ground, bodies[0], **axis)
        if d.torque:
            m.torque_on("motor", angle, input=m.input("torque", start=d.torque))
        if d.drive is not None:
            drive = m.drive("drive", angle, m.guide_time("guide", d.drive, unit="rad"))
            if rates:
                m.sense_coordinate("motor.angle", angle)
                m.sense_joint("motor.torque", drive, "drive")
    if d.drive is None and d.rate:
        angular = d.rate if d.dimension == 2 else d.rate * d.joints[0].axis
        arm = d.links[0].com - d.joints[0].point
        linear = d.rate * np.array([-arm[1], arm[0]]) if d.dimension == 2 else np.cross(angular, arm)
        m.initial_velocity(bodies[0], linear=linear, angular=angular)
    for c in "xyz"[: d.dimension] if rates else "":
        m.sense_position(f"pin.{c}", bodies[0], d.joints[0].point, c)
    for i, c in itertools.product(range(len(bodies)), "xyz" if d.dimension == 3 else "z") if rates else ():
        m.sense_rotation(f"rate{i}.{c}", bodies[i], c, order=1)
    for i, c in itertools.product(range(len(bodies)), "xyz"[: d.dimension]) if not rates else ():
        m.sense_position(f"tip{i}.{c}", bodies[i], None if d.links[i].inertia is None else d.tips[i], c)
    return m


def _bar(rng: np.random.Generator, a: Array, b: Array) -> Link:
    """A link between two points, of random mass; the smallest mass is a fiftieth of the largest."""
    mass = float(10.0 ** rng.uniform(-0.7, 1.0))
    length = float(np.linalg.norm(b - a))
    transverse = mass * length**2 * rng.uniform(0.08, 0.2)
    if len(a) == 2:
        return Link(0.5 * (a + b), mass, transverse)
    along = (b - a) / length
    axial = transverse * rng.uniform(0.2, 0.8)
    return Link(0.5 * (a + b), mass, transverse * np.eye(3) + (axial - transverse) * np.outer(along, along))


def _with_loads(rng: np.random.Generator, d: Mechanism) -> Mechanism:
    """The mechanism with random springs, dampers, initial rate, and a drive or a torque."""
    values = {f: getattr(d, f) for f in d.__dataclass_fields__}
    size = d.size
    total = sum(k.mass for k in d.links)
    springs = []
    for _ in range(int(rng.choice([0, 1, 2], p=[0.35, 0.45, 0.2]))):
        i = int(rng.integers(len(d.links)))
        anchor = d.tips[i] + rng.normal(0.0, 0.5 * size, d.dimension)
        length = float(np.linalg.norm(anchor - d.tips[i]))
        stiffness = total * 9.81 / size * float(10.0 ** rng.uniform(-0.5, 2.0))
        damping = float(rng.choice([0.0, rng.uniform(0.02, 0.3)])) * float(np.sqrt(stiffness * total))
        springs.append(Spring(i, d.tips[i], GROUND, anchor, stiffness, damping, length * rng.uniform(0.5, 1.2)))
    driven = rng.random() < 0.3
    scale = float(np.sqrt(9.81 / size))
    values |= {
        "springs": springs,
        "rate": float(rng.normal(0.0, 2.0) * scale),
        "torque": 0.0 if driven or rng.random() < 0.6 else float(rng.normal(0.0, 0.5) * total * 9.81 * size),
    }
    drive = (float(rng.uniform(-2.0, 2.0) * scale), float(rng.uniform(-0.3, 0.3) * scale**2)) if driven else ()
    values["span"] = span = float(rng.uniform(1.0, 3.0))
    values["drive"] = PPoly(np.array([*drive[::-1], 0.0])[:, None], [0.0, 2.0 * span]) if driven else None
    return Mechanism(**values)


def _without_loads(dimension: int, links: list[Link], joints: list[Joint], tips: list[Array]) -> Mechanism:
    return Mechanism(dimension, links, joints, [], tips, 0.0, 0.0, None, 1.0)


def _intersection(a: Array, ra: float, b: Array, rb: float, side: float) -> Array | None:
    """Intersection of the circles about a and b with radii ra and rb, m, on one side; None: none, or nearly tangent."""
    gap = b - a
    l = float(np.linalg.norm(gap))
    x = (ra**2 - rb**2 + l**2) / (2.0 * l)
    if ra**2 - x**2 <= (0.05 * ra) ** 2:
        return None
    e = gap / l
    return a + x * e + side * np.sqrt(ra**2 - x**2) * np.array([-e[1], e[0]])


def _lengths(rng: np.random.Generator, near: tuple[float, float] | None) -> Array:
    """Lengths of crank, coupler, rocker and frame of a four-bar, m.

    Some are close to a dead centre, and all if `near`, the range of the relative difference of the arms, is given.
    """
    r = 10.0 ** rng.uniform(-0.6, 0.3, 4)
    if rng.random() < NEARLY_EQUAL or near is not None:
        factor = 1.0 + rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(*np.log10(near or DEAD_CENTRE_DIFFERENCE))
        r[2] = (r[0] + r[3] - r[1]) * factor if r[0] + r[3] > 1.1 * r[1] else r[1] + (r[3] - r[0]) * factor
    return np.abs(r)


def _loop(
    rng: np.random.Generator, near: tuple[float, float] | None = None
) -> tuple[list[Link], list[Joint], list[Array], Array, Array]:
    """Links, joints and tips of a four-bar, and the ends of its coupler."""
    while True:
        crank, coupler, rocker, frame = _lengths(rng, near)
        angle = rng.uniform(0.0, 2.0 * np.pi)
        a, d = np.zeros(2), np.array([frame, 0.0])
        b = crank * np.array([np.cos(angle), np.sin(angle)])
        c = _intersection(b, coupler, d, rocker, float(rng.choice([-1.0, 1.0])))
        if c is not None:
            break
    links = [_bar(rng, a, b), _bar(rng, b, c), _bar(rng, c, d)]
    joints = [
        Joint("hinge", 0, GROUND, a, PLANE_NORMAL),
        Joint("hinge", 1, 0, b, PLANE_NORMAL),
        Joint("hinge", 2, 1, c, PLANE_NORMAL),
        Joint("hinge", 2, GROUND, d, PLANE_NORMAL),
    ]
    return links, joints, [b, c, c], b, c


def four_bar(rng: np.random.Generator, near: tuple[float, float] | None = None) -> Mechanism:
    """A four-bar of any of Grashof's types; `near`: relative difference of its arms at a dead centre."""
    links, joints, tips, _, _ = _loop(rng, near)
    return _with_loads(rng, _without_loads(2, links, joints, tips))


def four_bar_with_pendulum(rng: np.random.Generator) -> Mechanism:
    """A pendulum on the coupler of a four-bar."""
    links, joints, tips, b, c = _loop(rng)
    hook = b + rng.uniform(0.2, 1.2) * (c - b)
    end = hook + rng.uniform(0.2, 1.0) * _direction(rng, 2)
    links.append(_bar(rng, hook, end))
    joints.append(Joint("hinge", 3, 1, hook, PLANE_NORMAL))
    return _with_loads(rng, _without_loads(2, links, joints, [*tips, end]))


def six_bar(rng: np.random.Generator) -> Mechanism:
    """A four-bar and a dyad between its coupler and the ground (Stephenson's third kind)."""
    while True:
        links, joints, tips, b, c = _loop(rng)
        e = 0.5 * (b + c) + rng.normal(0.0, 0.3, 2)
        g = rng.normal(0.0, 1.0, 2)
        f = _intersection(
            e, float(rng.uniform(0.3, 1.5)), g, float(rng.uniform(0.3, 1.5)), float(rng.choice([-1.0, 1.0]))
        )
        if f is not None:
            break
    links += [_bar(rng, e, f), _bar(rng, f, g)]
    joints += [
        Joint("hinge", 3, 1, e, PLANE_NORMAL),
        Joint("hinge", 4, 3, f, PLANE_NORMAL),
        Joint("hinge", 4, GROUND, g, PLANE_NORMAL),
    ]
    return _with_loads(rng, _without_loads(2, links, joints, [*tips, f, f]))


def slider_crank(rng: np.random.Generator) -> Mechanism:
    """A slider-crank with or without offset; in some the rod is nearly as long as the crank."""
    crank = float(10.0 ** rng.uniform(-0.7, 0.0))
    near = rng.random() < NEARLY_EQUAL
    rod = crank * float(1.0 + 10.0 ** rng.uniform(*np.log10(DEAD_CENTRE_DIFFERENCE)) if near else rng.uniform(1.2, 4.0))
    offset = 0.0 if near or rng.random() < 0.5 else float(rng.uniform(-0.5, 0.5)) * (rod - crank)
    angle = float(rng.uniform(0.0, 2.0 * np.pi))
    b = crank * np.array([np.cos(angle), np.sin(angle)])
    c = np.array([b[0] + np.sqrt(rod**2 - (b[1] - offset) ** 2), offset])
    links = [_bar(rng, np.zeros(2), b), _bar(rng, b, c), Link(c, float(10.0 ** rng.uniform(-0.7, 1.0)), None)]
    joints = [
        Joint("hinge", 0, GROUND, np.zeros(2), PLANE_NORMAL),
        Joint("hinge", 1, 0, b, PLANE_NORMAL),
        Joint("ball", 1, 2, c, PLANE_NORMAL),
        Joint("line", 2, GROUND, c, np.array([1.0, 0.0])),
    ]
    return _with_loads(rng, _without_loads(2, links, joints, [b, 0.5 * (b + c), c]))


def _direction(rng: np.random.Generator, d: int) -> Array:
    """A random unit vector (d,)."""
    v = rng.normal(0.0, 1.0, d)
    return np.asarray(v / np.linalg.norm(v))


def chain(rng: np.random.Generator, d: int) -> Mechanism:
    """One to three links, each on the previous one. `d`: dimension."""
    start, links, joints, tips = np.zeros(d), [], [], []
    for i in range(int(rng.integers(1, 4))):
        end = start + rng.uniform(0.2, 1.0) * _direction(rng, d)
        links.append(_bar(rng, start, end))
        kind = "hinge" if d == 2 or i == 0 or rng.random() < 0.5 else "ball"
        axis = PLANE_NORMAL if d == 2 else _direction(rng, 3)
        joints.append(Joint(kind, i, i - 1 if i else GROUND, start, axis))
        tips.append(end)
        start = end
    return _with_loads(rng, _without_loads(d, links, joints, tips))


def _spatial_crank(rng: np.random.Generator) -> tuple[Array, Array]:
    """Axis and arm of a random crank, (3,) each."""
    axis = _direction(rng, 3)
    arm = np.cross(axis, _direction(rng, 3))
    return axis, np.asarray(rng.uniform(0.1, 0.5) * arm / np.linalg.norm(arm))


def spatial_four_bar(rng: np.random.Generator) -> Mechanism:
    """Two cranks about skew axes and a rod with two ball joints."""
    (u, arm_1), (v, arm_2) = _spatial_crank(rng), _spatial_crank(rng)
    a, d = np.zeros(3), rng.normal(0.0, 0.7, 3)
    b, c = a + arm_1, d + arm_2
    links = [_bar(rng, a, b), _bar(rng, b, c), _bar(rng, c, d)]
    joints = [
        Joint("hinge", 0, GROUND, a, u),
        Joint("ball", 1, 0, b, u),
        Joint("ball", 1, 2, c, v),
        Joint("hinge", 2, GROUND, d, v),
    ]
    return _with_loads(rng, _without_loads(3, links, joints, [b, 0.5 * (b + c), c]))


def spatial_slider_crank(rng: np.random.Generator) -> Mechanism:
    """A crank, a rod with two ball joints and a particle on a line."""
    axis, arm = _spatial_crank(rng)
    c = rng.normal(0.0, 0.8, 3)
    links = [_bar(rng, np.zeros(3), arm), _bar(rng, arm, c), Link(c, float(10.0 ** rng.uniform(-0.7, 1.0)), None)]
    joints = [
        Joint("hinge", 0, GROUND, np.zeros(3), axis),
        Joint("ball", 1, 0, arm, axis),
        Joint("ball", 1, 2, c, axis),
        Joint("line", 2, GROUND, c, _direction(rng, 3)),
    ]
    return _with_loads(rng, _without_loads(3, links, joints, [arm, 0.5 * (arm + c), c]))


KINDS: dict[str, Callable[[np.random.Generator], Mechanism]] = {
    "four-bar": four_bar,
    "slider-crank": slider_crank,
    "six-bar": six_bar,
    "four-bar with pendulum": four_bar_with_pendulum,
    "chain": lambda r: chain(r, 2),
    "spatial chain": lambda r: chain(r, 3),
    "spatial four-bar": spatial_four_bar,
    "spatial slider-crank": spatial_slider_crank,
}
