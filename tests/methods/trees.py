"""Models with a spanning tree: branches with a slide, a weld and springs; a carriage; a closed spatial loop."""

import numpy as np

from mbs import Model
from mbs.scenes import bricard, spatial_chain

GRAVITY = 9.81
INERTIA = np.array([[0.02, 0.003, -0.001], [0.003, 0.05, 0.002], [-0.001, 0.002, 0.04]])  # three different moments


def branching(springs: bool) -> Model:
    """A trunk on a skew pin; on it a slider with a swinging tail, and an arm with a welded tip; spatial."""
    m = Model("branching", dimension=3)
    trunk = m.body("trunk", mass=2.0, com=(0.1, 0.0, -0.3), inertia=INERTIA)
    slider = m.body("slider", mass=0.7, com=(0.3, 0.1, -0.5), inertia=0.5 * INERTIA)
    tail = m.body("tail", mass=0.4, com=(0.5, 0.1, -0.7), inertia=(0.01, 0.01, 0.002))
    arm = m.body("arm", mass=0.9, com=(-0.2, 0.1, -0.5), inertia=0.4 * INERTIA)
    tip = m.body("tip", mass=0.3, com=(-0.4, 0.2, -0.6), inertia=0.1 * INERTIA)
    m.revolute("root", m.ground, trunk, point=(0.0, 0.0, 0.0), axis=(0.2, 1.0, 0.1))
    m.prismatic("slide", slider, trunk, axis=(1.0, 0.3, -0.2), point=(0.2, 0.05, -0.5))
    m.revolute("tail pin", tail, slider, point=(0.4, 0.1, -0.6), axis=(0.0, 0.6, 0.8))
    m.revolute("shoulder", trunk, arm, point=(0.0, 0.0, -0.4), axis=(1.0, 0.0, 0.5))
    m.weld("glue", arm, tip)
    if springs:
        m.spring_damper(
            "coil", (trunk, (0.1, 0.0, -0.3)), (slider, (0.3, 0.1, -0.5)), stiffness=60.0, damping=0.8, free_length=0.2
        )
        m.spring_damper("stay", (m.ground, (-0.5, 0.0, 0.0)), (tip, (-0.5, 0.2, -0.6)), stiffness=20.0, damping=0.3)
        push = m.input("push", unit="N", start=1.0, min=-5.0, max=5.0)
        m.force("push", tail, (0.6, 0.1, -0.8), inputs=[None, push, None], axes="body")
    _sense(m, tail, (0.6, 0.1, -0.8), "tail")
    _sense(m, tip, (-0.5, 0.2, -0.6), "tip")
    return m


def random_tree(seed: int) -> Model:
    """Up to twelve bodies on skew pins, slides and welds, some with a spring, some with a loop."""
    rng = np.random.default_rng(seed)
    m = Model(f"tree {seed}", dimension=3)
    bodies, centres = [m.ground], [np.zeros(3)]
    for k in range(int(rng.integers(4, 13))):
        parent = int(rng.integers(max(0, len(bodies) - 4), len(bodies)))
        point = centres[parent] + 0.3 * rng.standard_normal(3)
        centre = point + 0.3 * rng.standard_normal(3)
        moments = rng.uniform(0.05, 0.09, 3)
        axes = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        body = m.body(f"body {k}", mass=rng.uniform(0.5, 2.0), com=centre, inertia=axes @ np.diag(moments) @ axes.T)
        pair = (bodies[parent], body) if rng.random() < 0.5 else (body, bodies[parent])
        kind, axis = rng.random(), rng.standard_normal(3)
        if kind < 0.2:
            m.prismatic(f"joint {k}", *pair, axis=axis, point=point)
        elif kind < 0.3 and parent > 0:
            m.weld(f"joint {k}", *pair)
        else:
            m.revolute(f"joint {k}", *pair, point=point, axis=axis)
        bodies.append(body)
        centres.append(centre)
    if seed % 2:
        m.spring_damper("coil", (m.ground, (1.0, 1.0, 1.0)), (body, centre), stiffness=30.0, damping=1.0)
    if len(bodies) > 8:
        m.spherical("loop", bodies[7], bodies[1], point=centres[7])
    for c in "xyz":
        m.sense_position(c, body, None, c)
        m.sense_position(f"a{c}", body, None, c, order=2)
    return m


def measured(scene: str) -> Model:
    """The scene with velocities and accelerations of its output point."""
    m = {"chain": spatial_chain, "bricard": bricard}[scene].build()
    body = m.bodies[-1 if scene == "chain" else 1]
    point = (spatial_chain.LINKS * spatial_chain.LENGTH * spatial_chain.directions()[0], bricard.POINTS[2])
    _sense(m, body, point[scene == "bricard"], "end")
    return m


def pendulum(length: float, mass: float, spin_inertia: float, angle: float) -> Model:
    """A rigid body on a horizontal pin, turned by `angle` from hanging."""
    m = Model("pendulum", dimension=3, gravity=(0.0, 0.0, -GRAVITY))
    centre = length * np.array([np.sin(angle), 0.0, -np.cos(angle)])
    body = m.body("body", mass=mass, com=centre, inertia=spin_inertia * np.diag([0.7, 1.0, 0.6]))
    m.revolute("pin", m.ground, body, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    for c in "xz":
        m.sense_position(f"body.{c}", body, None, c)
    m.sense_joint("pin.z", "pin", "z")
    return m


def _sense(m: Model, body, point, name: str) -> None:
    for c in "xyz":
        m.sense_position(f"{name}.{c}", body, point, c)
        m.sense_position(f"{name}.v{c}", body, point, c, order=1)
        m.sense_position(f"{name}.a{c}", body, point, c, order=2)
    m.sense_energy(f"{name}.energy")
