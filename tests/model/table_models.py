"""Models with bodies and numbers by table, and the same with joints."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mbs import Model, System, compile
from mbs.common.affine import AffineVector
from mbs.elements import BodyForce, HubWrench, Lift, ScalarSpringDamper, SpringDamper
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate

Array = NDArray[np.float64]
BASE, ARM, TIP = (0.3, 0.4, 0.5), (0.1, 0.2, 0.15), (0.05, 0.04, 0.06)
MASSES = 5.0, 2.0, 1.0
ELBOW, HAND = (0.0, 0.0, -1.0), (0.2, 0.1, -1.4)
SPIN = np.array([1.0, -0.5, 2.0])
SWING = 0.7
BEND = -0.9
AXES = (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)
WATCHED = tuple(f"{what}.{c}" for what in ("at", "rate", "second") for c in "xyz")
FIRST, SECOND = np.linspace(-2.0, 2.0, 161), np.linspace(-3.0, 3.0, 241)
"""Points of the angles of a chain."""


def rotations(axis: tuple[float, ...], angles: Array) -> Array:
    return Rotation.from_rotvec(np.multiply.outer(angles, axis)).as_matrix()


def watch(m: Model, base: Body, tip: Body, damping: float = 0.0) -> Model:
    for what, order in (("at", 0), ("rate", 1), ("second", 2)):
        for c in "xyz":
            m.sense_position(f"{what}.{c}", tip, HAND, c, order=order)
    for body, name in ((base, "base"), (tip, "tip")):
        for c in "xyz":
            m.sense_position(f"{name}.v{c}", body, body.com, c, order=1)
            m.sense_position(f"{name}.{c}", body, body.com, c)
            m.sense_rotation(f"{name}.w{c}", body, c, order=1)
        for c in "wxyz":
            m.sense_rotation(f"{name}.q{c}", body, c)
    for kind in ("kinetic", "gravity", "total"):
        m.sense_energy(kind, kind)
    ends = (base, (0.5, 0.2, 0.0)), (tip, HAND)
    spring = m.spring_damper("spring", *ends, stiffness=8.0, free_length=1.3, damping=damping)
    m.sense_element("spring", "spring", "length")
    m.sense_energy("work", "nonconservative", [spring])
    return m


def base_of(m: Model) -> Body:
    base = m.body("base", mass=MASSES[0], com=(0, 0, 0), inertia=BASE)
    m.initial_velocity(base, (0.1, 0.2, 0.3), SPIN)
    return base


def arm_by_table(m: Model, base: Body, swing: Coordinate, points: Array) -> Body:
    turned = rotations(AXES[0], points)
    return m.tabled_body(
        "arm",
        base=base,
        parameters=swing,
        axes=[points],
        places=turned @ ELBOW,
        rotations=turned,
        mass=MASSES[1],
        com=ELBOW,
        inertia=ARM,
    )


def one_by_table(n: int = 193, gravity: float = 9.81) -> System:
    """A pendulum on a free base."""
    m = Model("table", gravity=(0, 0, -gravity))
    base = base_of(m)
    return compile(watch(m, base, arm_by_table(m, base, m.travel("swing", rate=SWING), np.linspace(-2.4, 2.4, n))))


def one_by_joint(gravity: float = 9.81) -> System:
    m = Model("joint", gravity=(0, 0, -gravity))
    base = base_of(m)
    arm = m.body("arm", mass=MASSES[1], com=ELBOW, inertia=ARM)
    m.revolute("shoulder", base, arm, point=(0, 0, 0), axis=AXES[0])
    turn = SPIN + np.multiply(SWING, AXES[0])
    m.initial_velocity(arm, np.array((0.1, 0.2, 0.3)) + np.cross(turn, ELBOW), turn)
    return compile(watch(m, base, arm))


def chain(m: Model) -> tuple[Body, Body, Body, tuple[Coordinate, Coordinate]]:
    """Base, arm and tip, the last one over both angles, and these."""
    base = base_of(m)
    swing, bend = m.travel("swing", unit="rad", rate=SWING), m.travel("bend", unit="rad", rate=BEND)
    arm = arm_by_table(m, base, swing, FIRST)
    outer, inner = rotations(AXES[0], FIRST)[:, None], rotations(AXES[1], SECOND)[None]
    tip = m.tabled_body(
        "tip",
        base=base,
        parameters=(swing, bend),
        axes=(FIRST, SECOND),
        places=outer @ ELBOW + (outer @ inner) @ np.subtract(HAND, ELBOW),
        rotations=outer @ inner,
        mass=MASSES[2],
        com=HAND,
        inertia=TIP,
    )
    return base, arm, tip, (swing, bend)


def two_by_table(damping: float = 0.0, *, beside: bool = False) -> System:
    """A chain of two; `beside`: a spring from it to another body."""
    m = Model("tables")
    base, _, tip, _ = chain(m)
    if beside:
        other = m.body("beside", mass=1.0, com=(0.4, 0.3, -2.0), inertia=TIP)
        m.spring_damper("pull", (tip, HAND), (other, (0.3, 0.1, -2.1)), stiffness=6.0, free_length=0.4)
    return compile(watch(m, base, tip, damping))


def coupled(whole: bool) -> Model:
    """Elements that couple vectors of lookup-table bodies on two bases, lookup-table numbers and the spin of a wheel.

    `whole`: beside each of them a spring without stiffness on one component, or on so many numbers, that their tangents
    are not summed by vectors and numbers.
    """
    m = Model("coupled")
    _, arm, tip, angles = chain(m)
    rail = m.tabled_body(
        "rail",
        base=m.ground,
        parameters=angles[0],
        axes=[FIRST],
        places=np.outer(np.sin(FIRST), (0.3, 0.5, -0.2)),
        rotations=np.broadcast_to(np.eye(3), (len(FIRST), 3, 3)),
        mass=2.0,
        com=(0, 0, 0),
        inertia=(1, 1, 1),
    )
    level, other = (
        m.tabled_number(name, parameters=angles, axes=(FIRST, SECOND), values=values).affine
        for name, values in (
            ("level", np.sin(FIRST)[:, None] + 0.5 * SECOND**2),
            ("other", FIRST[:, None] * np.cos(SECOND) + 0.3 * SECOND),
        )
    )
    shape = {"mass": 0.4, "spin_inertia": 0.1, "diametral_inertia": 0.06}
    wheel = m.spin("wheel", carrier=tip, centre=HAND, axis=AXES[0], **shape).affine
    u = [m.input(f"u{i}", start=start).index for i, start in enumerate((3.0, -2.0, 4.0, 1.5, -2.5, 3.5))]
    hand, elbow, axes = tip.point(HAND), arm.point((0.1, 0.3, -0.8)), [tip.vector(e) for e in np.eye(3)]
    end = rail.point((0, 0, 0.5))
    springs = {
        "across": (20.0, 0.2, hand - elbow),
        "up": (8.0, 0.5, hand - AffineVector.constant((0.3, 0.2, 1.0))),
        "bridge": (9.0, 0.3, hand - end),
        "rail": (6.0, 0.1, end - AffineVector.constant((1.0, 1.0, 1.0))),
        "skew": (5.0, 0.2, AffineVector(tuple(k * c for k, c in enumerate(elbow.components, 1)))),
        "plane": (7.0, 0.4, AffineVector((level + wheel, other))),
    }
    for name, (k, length, gap) in springs.items():
        m.add(SpringDamper(k, free_length=length).record(name, gap))
    m.add(BodyForce(u[:3]).record("push", elbow, axes))
    m.add(Lift(5.0).record("lift", hand, axes[0], axes[2]))
    m.add(HubWrench(u).record("wrench", hand, axes[1], level + 2.0 * wheel))
    lone = [(hand - elbow).components[0], hand.components[1], end.components[2]]
    lone += [hand.components[2] + level, *(level + k * other for k in range(1, 6))]
    for n, signal in enumerate(lone if whole else ()):
        m.add(ScalarSpringDamper(0.0).record(f"none {n}", signal))
    return m


def two_by_joints() -> System:
    m = Model("joints")
    base = base_of(m)
    arm = m.body("arm", mass=MASSES[1], com=ELBOW, inertia=ARM)
    tip = m.body("tip", mass=MASSES[2], com=HAND, inertia=TIP)
    m.revolute("shoulder", base, arm, point=(0, 0, 0), axis=AXES[0])
    m.revolute("elbow", arm, tip, point=ELBOW, axis=AXES[1])
    turn = SPIN + np.multiply(SWING, AXES[0])
    further = turn + np.multiply(BEND, AXES[1])
    elbow = np.array((0.1, 0.2, 0.3)) + np.cross(turn, ELBOW)
    m.initial_velocity(arm, elbow, turn)
    m.initial_velocity(tip, elbow + np.cross(further, np.subtract(HAND, ELBOW)), further)
    return compile(watch(m, base, tip))


def number_model(points: Array, **more: Any) -> Model:
    """A body on a rail of the ground, x = s, and a torsional spring on the number s^2."""
    m = Model("number", gravity=(0, 0, 0))
    m.point_mass("elsewhere", mass=1.0, position=(0, 5, 0))
    s = m.travel("s", rate=1.0)
    zero = np.zeros_like(points)
    m.tabled_body(
        "cart",
        base=m.ground,
        parameters=s,
        axes=[points],
        places=np.column_stack([points, zero, zero]),
        rotations=np.broadcast_to(np.eye(3), (len(points), 3, 3)),
        mass=2.0,
        com=(0, 0, 0),
        inertia=(1, 1, 1),
    )
    square = m.tabled_number("square", parameters=s, axes=[points], values=points**2, **more)
    m.torsional_spring_damper("spring", square, stiffness=3.0)
    m.sense_coordinate("s", s)
    m.sense_coordinate("square", square)
    m.sense_coordinate("square.rate", square, order=1)
    m.sense_energy("total", "total")
    return m
