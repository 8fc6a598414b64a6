"""The shared scenes in MuJoCo: hinge trees, loops closed by soft `connect` equalities made as hard as the step allows.

All steps between two samples are one call into its compiled code; nothing is rendered or logged.
"""

import time

import mujoco
import numpy as np

from benchmarks.peers.trees import PeerRun, Tree, sample_times, tree_of

INTEGRATORS = ("RK4", "implicitfast")
SOLIMP = 'solimp="0.9999 0.9999 0.001 0.5 2"'
DIVERGED = 1e3  # rad/s
mujoco.set_mju_user_warning(lambda message: None)  # it would write a log file; `run` detects divergence


def run(scene: str, h: float, end: float, samples: int, integrator: str) -> PeerRun:
    """Run a scene; only the steps count in the wall time."""
    tree = tree_of(scene)
    model = mujoco.MjModel.from_xml_string(_text(tree, h, integrator))
    data = mujoco.MjData(model)
    data.qvel[:] = [link.rate for link in tree.links]
    output_data = mujoco.MjData(model)
    steps = round(end / samples / h)
    states, wall = [(data.qpos.copy(), data.qvel.copy())], 0.0
    for _ in range(samples):
        begin = time.perf_counter()
        mujoco.mj_step(model, data, nstep=steps)
        wall += time.perf_counter() - begin
        states.append((data.qpos.copy(), data.qvel.copy()))
        if not np.abs(data.qvel).max() < DIVERGED:
            break
    positions = []
    for q, v in states:
        output_data.qpos[:], output_data.qvel[:] = q, v
        mujoco.mj_forward(model, output_data)
        positions.append(output_data.site_xpos[0].copy())
    finished = len(states) == samples + 1
    times = sample_times(end, samples)[: len(states)]
    return PeerRun(times, np.array(positions)[:, tree.components], wall, finished)


def integrators(scene: str) -> tuple[str, ...]:
    """Integrators that compute a scene: the same for all."""
    return INTEGRATORS


def _text(tree: Tree, h: float, integrator: str) -> str:
    """MuJoCo's XML of a tree."""
    bodies = [""] * (len(tree.links) + 1)  # children of each body, the ground first
    for number, link in reversed(list(enumerate(tree.links, start=1))):
        i = link.inertia
        inertia = _numbers([i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]])
        site = f'<site pos="{_numbers(tree.point)}"/>' if number == tree.body else ""
        bodies[link.parent] = f"""<body name="{number}" pos="{_numbers(link.position)}">
          <joint type="hinge" axis="{_numbers(link.axis)}"/>
          <inertial pos="{_numbers(link.centre)}" mass="{link.mass}" fullinertia="{inertia}"/>{site}{bodies[number]}
          </body>{bodies[link.parent]}"""
    closures = ""
    for loop in tree.closures:
        second = f'body2="{loop.body_2}"' if loop.body_2 else ""
        anchor = _numbers(loop.point_1)
        closures += f'<connect body1="{loop.body_1}" {second} anchor="{anchor}" solref="{2.0 * h!r} 1" {SOLIMP}/>'
    return f"""<mujoco><option timestep="{h!r}" integrator="{integrator}" gravity="{_numbers(tree.gravity)}"
      solver="Newton" tolerance="1e-12" iterations="20"><flag contact="disable"/></option>
      <worldbody>{bodies[0]}</worldbody><equality>{closures}</equality></mujoco>"""


def _numbers(values: object) -> str:
    return " ".join(repr(float(v)) for v in np.asarray(values))
