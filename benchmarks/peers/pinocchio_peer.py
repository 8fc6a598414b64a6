"""The shared scenes in Pinocchio: trees of revolute joints, loops closed by points of its constrained dynamics.

Pinocchio has no stepper: Runge and Kutta's rule of order 4 is a loop in Python over its accelerations. Only the time
within these compiled calls counts. Baumgarte's corrections are its own.
"""

from __future__ import annotations

import time

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from benchmarks.peers.common import PeerRun, samples_times
from mbs.scenes import bricard, spatial_chain

INTEGRATORS = ("RK4", "RK4, corrected")
VERSION = pin.__version__
CORRECTION = 0.2  # Baumgarte's corrections have the time constant h / CORRECTION
PROXIMAL = {"bricard": (1e-6, 1e-6, 3)}  # accuracy, damping and iterations for the redundant rows of loops
OTHER_LOOPS = 1e-10, 1e-10, 10
FAR = 1e3
Vector = NDArray[np.float64]
Loops = list[pin.RigidConstraintModel]
Proximal = tuple[float, float, int]
Y = np.array([0.0, 1.0, 0.0])


def run(scene: str, h: float, end: float, samples: int, integrator: str) -> PeerRun:
    """One run; the wall time is that of the steps alone."""
    if integrator not in integrators(scene):
        raise ValueError(f"{integrator!r} is not for {scene}")
    model, loops, rates, (joint, place), components = _build(scene)
    data, steps = model.createData(), round(end / samples / h)
    rate = CORRECTION / h if "corrected" in integrator else 0.0
    acceleration = _Acceleration(model, data, loops, rate, PROXIMAL.get(scene, OTHER_LOOPS))
    q, v = np.zeros(model.nq), np.asarray(rates, float)
    states = [(q, v)]
    for _ in range(samples):
        for _ in range(steps):
            a1 = acceleration(q, v)
            v2 = v + 0.5 * h * a1
            a2 = acceleration(q + 0.5 * h * v, v2)
            v3 = v + 0.5 * h * a2
            a3 = acceleration(q + 0.5 * h * v2, v3)
            v4 = v + h * a3
            a4 = acceleration(q + h * v3, v4)
            q = q + h / 6.0 * (v + 2.0 * (v2 + v3) + v4)
            v = v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4)
        states.append((q, v))
        if not np.abs(v).max() < FAR:
            break
    places, energies = [], []
    for q, v in states:
        pin.forwardKinematics(model, data, q, v)
        places.append(data.oMi[joint].act(place))
        energies.append(pin.computeKineticEnergy(model, data, q, v) + pin.computePotentialEnergy(model, data, q))
    whole = len(states) == samples + 1
    times = samples_times(end, samples)[: len(states)]
    return PeerRun(times, np.array(places)[:, components], np.array(energies), acceleration.wall, whole)


def scenes() -> tuple[str, ...]:
    """Names of the shared scenes."""
    return ("double_four_bar", "bricard", "spatial_chain", "four_bar_40", "four_bar_200")


def integrators(scene: str) -> tuple[str, ...]:
    """Those that make sense: without loops there is nothing to correct."""
    return INTEGRATORS[:1] if scene == "spatial_chain" else INTEGRATORS


class _Acceleration:
    """Accelerations at (q, v); `wall` adds up the time of the compiled calls, s."""

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


Built = tuple[pin.Model, Loops, list[float], tuple[int, Vector], list[int]]


def _build(scene: str) -> Built:
    """Model, closures, rates at the start, joint and place of the point that is compared, its components."""
    model = pin.Model()
    if "four_bar" in scene:
        model.gravity.linear = np.array([0.0, 0.0, -9.81])
        return _four_bar(model, int(scene.rpartition("_")[2]) if scene[-1].isdigit() else 2)
    if scene == "bricard":
        model.gravity.linear = np.array([0.0, -9.81, 0.0])
        return _bricard(model)
    model.gravity.linear = np.array([0.0, 0.0, -9.81])
    return _chain(model)


def _link(model: pin.Model, parent: int, place: Vector, axis: Vector, com: Vector, inertia: Vector, mass: float) -> int:
    joint = pin.JointModelRevoluteUnaligned(np.asarray(axis, float))
    number = model.addJoint(parent, joint, _at(place), f"joint {model.njoints}")
    model.appendBodyToJoint(number, pin.Inertia(mass, com, inertia), pin.SE3.Identity())
    return int(number)


def _at(place: Vector) -> pin.SE3:
    return pin.SE3(np.eye(3), np.asarray(place, float))


def _loop(model: pin.Model, a: int, at_a: Vector, b: int, at_b: Vector) -> pin.RigidConstraintModel:
    return pin.RigidConstraintModel(
        pin.ContactType.CONTACT_3D, model, a, _at(at_a), b, _at(at_b), pin.ReferenceFrame.LOCAL
    )


def _four_bar(model: pin.Model, windows: int) -> Built:
    up, right, inertia = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), np.eye(3) / 12.0
    cranks, couplers, rates = [], [], []
    for i in range(windows + 1):
        cranks.append(_link(model, 0, i * right, Y, 0.5 * up, inertia, 1.0))
        rates.append(1.0)
        if i < windows:
            couplers.append(_link(model, cranks[i], up, Y, 0.5 * right, inertia, 1.0))
            rates.append(-1.0)
    loops = [_loop(model, couplers[i], right, cranks[i + 1], up) for i in range(windows)]
    return model, loops, rates, (cranks[0], up), [0, 2]


def _bricard(model: pin.Model) -> Built:
    points, joint = np.array(bricard.POINTS, float) * bricard.LENGTH, 0
    joints = []
    for k in range(5):
        along = points[k + 1] - points[k]
        place = points[0] if k == 0 else points[k] - points[k - 1]
        inertia = _rod(along / bricard.LENGTH, bricard.MASS, bricard.LENGTH, bricard.SECTION)
        joint = _link(model, joint, place, np.array(bricard.AXES[k]), 0.5 * along, inertia, bricard.MASS)
        joints.append(joint)
    end, axis = points[5] - points[4], np.array(bricard.AXES[5], float)
    # two points of the last axis stay where they are: the revolute on the ground
    loops = [_loop(model, joint, end + s * axis, 0, points[5] + s * axis) for s in (0.0, 1.0)]
    return model, loops, [0.0] * 5, (joints[1], points[2] - points[1]), [0, 1, 2]


def _chain(model: pin.Model) -> Built:
    s, joint = spatial_chain, 0
    along, square, across = s.directions()
    inertia = _rod(along, s.MASS, s.LENGTH, s.SECTION)
    for k in range(s.LINKS):
        place = s.LENGTH * along if k else np.zeros(3)
        axis = across if k % 2 == 0 else square
        joint = _link(model, joint, place, axis, 0.5 * s.LENGTH * along, inertia, s.MASS)
    return model, [], [s.SPIN, s.SPIN] + [0.0] * (s.LINKS - 2), (joint, s.LENGTH * along), [0, 1, 2]


def _rod(along: Vector, mass: float, length: float, side: float) -> Vector:
    axial, transverse = mass * side**2 / 6.0, mass * (length**2 + side**2) / 12.0
    return transverse * np.eye(3) + (axial - transverse) * np.outer(along, along)
