"""The shared scenes in Pinocchio: trees of revolute joints, loops closed by points of its constrained dynamics.

Pinocchio has no integrator: the Runge-Kutta method of order 4 is a loop in Python over its accelerations. Only the time
of these compiled calls counts. Baumgarte's stabilisation is its own.
"""

from __future__ import annotations

import time

import numpy as np
import pinocchio as pin

from benchmarks.peers.trees import PeerRun, Tree, Vector, sample_times, tree_of

INTEGRATORS = ("RK4", "RK4, corrected")
CORRECTION = 0.2  # Baumgarte's stabilisation has the time constant h / CORRECTION
PROXIMAL = {"bricard": (1e-6, 1e-6, 3)}  # accuracy, damping and iterations for the redundant rows of loops
OTHER_LOOPS = 1e-10, 1e-10, 10
MAX_RATE = 1e3  # rad/s: above it the motion has diverged
Loops = list[pin.RigidConstraintModel]
Proximal = tuple[float, float, int]


def run(scene: str, h: float, end: float, samples: int, integrator: str) -> PeerRun:
    """Run a scene; only the steps count in the wall time."""
    if integrator not in integrators(scene):
        raise ValueError(f"{integrator!r} is not for {scene}")
    tree = tree_of(scene)
    model, loops = _build(tree)
    data, steps = model.createData(), round(end / samples / h)
    rate = CORRECTION / h if "corrected" in integrator else 0.0
    acceleration = _Acceleration(model, data, loops, rate, PROXIMAL.get(scene, OTHER_LOOPS))
    q, v = np.zeros(model.nq), np.array([link.rate for link in tree.links])
    states = [(q, v)]
    for _ in range(samples):
        for _ in range(steps):
            q, v = _runge_kutta_step(acceleration, q, v, h)
        states.append((q, v))
        if not np.abs(v).max() < MAX_RATE:
            break
    positions = []
    for q, v in states:
        pin.forwardKinematics(model, data, q, v)
        positions.append(data.oMi[tree.body].act(tree.point))
    finished = len(states) == samples + 1
    times = sample_times(end, samples)[: len(states)]
    return PeerRun(times, np.array(positions)[:, tree.components], acceleration.wall, finished)


def _runge_kutta_step(acceleration: _Acceleration, q: Vector, v: Vector, h: float) -> tuple[Vector, Vector]:
    """Position and velocity after a step of the classical method of order 4."""
    a1 = acceleration(q, v)
    v2 = v + 0.5 * h * a1
    a2 = acceleration(q + 0.5 * h * v, v2)
    v3 = v + 0.5 * h * a2
    a3 = acceleration(q + 0.5 * h * v2, v3)
    v4 = v + h * a3
    a4 = acceleration(q + h * v3, v4)
    return q + h / 6.0 * (v + 2.0 * (v2 + v3) + v4), v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4)


def integrators(scene: str) -> tuple[str, ...]:
    """Integrators of a scene: without loops there is nothing to stabilise."""
    return INTEGRATORS[:1] if scene == "spatial_chain" else INTEGRATORS


class _Acceleration:
    """Accelerations at (q, v); `wall`: total time of the compiled calls, s."""

    def __init__(self, model: pin.Model, data: pin.Data, loops: Loops, rate: float, proximal: Proximal) -> None:
        self.model, self.data, self.wall = model, data, 0.0
        self.torque = np.zeros(model.nv)
        self.loops, self.loop_data = pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
        for loop in loops:
            loop.m_baumgarte_parameters.Kp, loop.m_baumgarte_parameters.Kd = rate**2, 2.0 * rate
            self.loops.append(loop)
            self.loop_data.append(loop.createData())
        self.proximal = pin.ProximalSettings(*proximal)
        if loops:
            pin.initConstraintDynamics(model, data, self.loops, self.loop_data)

    def __call__(self, q: Vector, v: Vector) -> Vector:
        begin = time.perf_counter()
        if len(self.loops) == 0:
            a = pin.aba(self.model, self.data, q, v, self.torque)
        else:
            a = pin.constraintDynamics(
                self.model, self.data, q, v, self.torque, self.loops, self.loop_data, self.proximal
            )
        self.wall += time.perf_counter() - begin
        return np.array(a)


def _build(tree: Tree) -> tuple[pin.Model, Loops]:
    """Model of the tree and constraints that close its loops."""
    model = pin.Model()
    model.gravity.linear = tree.gravity
    for link in tree.links:
        joint = pin.JointModelRevoluteUnaligned(link.axis)
        number = model.addJoint(link.parent, joint, _translation(link.position), f"joint {model.njoints}")
        model.appendBodyToJoint(number, pin.Inertia(link.mass, link.centre, link.inertia), pin.SE3.Identity())
    return model, [
        pin.RigidConstraintModel(
            pin.ContactType.CONTACT_3D,
            model,
            loop.body_1,
            _translation(loop.point_1),
            loop.body_2,
            _translation(loop.point_2),
            pin.ReferenceFrame.LOCAL,
        )
        for loop in tree.closures
    ]


def _translation(vector: Vector) -> pin.SE3:
    return pin.SE3(np.eye(3), vector)
