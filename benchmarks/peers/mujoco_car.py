"""A car of the same mass, wheelbase, track and inertia of the chassis in MuJoCo: four wheels that slide on springs,
without suspension links.

Each wheel is a sphere that rolls on a plane by MuJoCo's own contact and friction, one contact each; there is no tyre
model, no air and no drive. A spring is compressed by `SINK` at rest. The front wheels are steered.
"""

import time
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from mujoco.rollout import Rollout
from numpy.typing import NDArray

from hosts.common.wheels import WHEELS
from mbs.vehicle.car import Car

Array = NDArray[np.float64]
GRAVITY = 9.81  # m/s2
SINK = 0.08  # m
DAMPING = 0.3  # damping ratio of a corner
STEERING = 2e4, 200.0  # N m/rad, N m s/rad: stiffness and damping of the angle control of a front wheel


def model(car: Car, mass: float, h: float, spring_factor: float = 1.0) -> Any:
    """The compiled model.

    `mass`: mass of the whole car, kg; the body has what the wheels do not have; `h`: step, s; `spring_factor`: factor
    of the spring stiffnesses.
    """
    body, axles = car.chassis, (car.front, car.rear)
    unsprung = 2.0 * sum(axle.wheel.mass for axle in axles)
    x, _, z = body.com
    ahead = x - axles[1].wheel.centre[0]
    loads = [GRAVITY * (mass - unsprung) * lever / car.wheelbase / 2.0 for lever in (ahead, car.wheelbase - ahead)]
    wheels = []
    for axle, load, name in zip(axles, loads, ("F", "R"), strict=True):
        rate, wheel = spring_factor * load / SINK, axle.wheel
        damping = 2.0 * DAMPING * float(np.sqrt(load / GRAVITY * rate))
        turn = '<joint name="steer{0}" axis="0 0 1" damping="20"/>' if name == "F" else ""
        inertia = f"{wheel.diametral_inertia} {wheel.spin_inertia} {wheel.diametral_inertia}"
        for side, sign in (("L", 1.0), ("R", -1.0)):
            position = f"{wheel.centre[0]} {sign * wheel.centre[1]} {wheel.centre[2]}"
            wheels.append(
                f'<body pos="{position}"><joint type="slide" axis="0 0 1" stiffness="{rate}" '
                f'springref="{-load / rate}" damping="{damping}"/>{turn.format(name + side)}'
                f'<joint name="spin{name}{side}" axis="0 1 0"/><inertial pos="0 0 0" mass="{wheel.mass}" '
                f'diaginertia="{inertia}"/><geom type="sphere" size="{wheel.centre[2]}" friction="1.1"/></body>'
            )
    (ixx, iyy, izz), gain = body.inertia, STEERING
    control = "".join(f'<position joint="steer{w}" kp="{gain[0]}" kv="{gain[1]}"/>' for w in WHEELS[:2])
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{h}" integrator="implicitfast" gravity="0 0 {-GRAVITY}"/><worldbody>'
        f'<geom type="plane" size="0 0 1"/><body><freejoint/><inertial pos="{x} 0 {z}" mass="{mass - unsprung}" '
        f'diaginertia="{ixx} {iyy} {izz}"/>{"".join(wheels)}</body></worldbody><actuator>{control}</actuator></mujoco>'
    )


def start(m: Any, speed: float) -> Array:
    """State of the car at a speed along x, m/s, its wheels rolling, shape (states,)."""
    data = mujoco.MjData(m)
    data.qvel[0] = speed
    for w in WHEELS:
        wheel = m.joint(f"spin{w}")
        data.qvel[wheel.dofadr[0]] = speed / m.geom_size[m.body_geomadr[wheel.bodyid[0]]][0]
    state = np.empty(mujoco.mj_stateSize(m, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(m, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    return state


def drive(models: Sequence[Any], speed: float, angles: Array, threads: int) -> tuple[Array, float]:
    """Simulate several cars by `mujoco.rollout`.

    `angles`: angles of the front wheels, left and right, rad, shape (steps, 2); `threads`: number of threads; 0: one
    car after the other in the calling thread.

    Returns
    -------
    rates : ndarray, shape (cars, steps, nv)
        First the velocity of the body in earth axes, m/s, and its angular velocity in its own axes, rad/s.
    seconds : float
        Processor time of all threads.
    """
    first = np.array([start(m, speed) for m in models])
    controls = np.broadcast_to(angles, (len(models), *angles.shape)).copy()
    data = [mujoco.MjData(models[0]) for _ in range(max(1, threads))]
    with Rollout(nthread=threads) as runner:
        begin = time.process_time()
        states, _ = runner.rollout(list(models), data, first, controls)
        spent = time.process_time() - begin
    return states[:, :, 1 + models[0].nq : 1 + models[0].nq + models[0].nv], spent
