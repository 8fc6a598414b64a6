"""The shared scenes in MuJoCo: hinge trees, loops closed by soft `connect` equalities made as hard as the step allows.

All steps between two samples are one call into its compiled code; nothing is rendered or logged.
"""

from __future__ import annotations

import time

import mujoco
import numpy as np

from benchmarks.peers.common import PeerRun, samples_times
from mbs.scenes import bricard, spatial_chain

INTEGRATORS = ("RK4", "implicitfast")
VERSION = mujoco.__version__
HARD = 'solimp="0.9999 0.9999 0.001 0.5 2"'
FAR = 1e3
mujoco.set_mju_user_warning(lambda message: None)  # it would write a log file; a run that blows up is reported as such


def run(scene: str, h: float, end: float, samples: int, integrator: str) -> PeerRun:
    """One run; the wall time is that of the steps alone."""
    model, rates = _model(scene, h, integrator)
    data = mujoco.MjData(model)
    data.qvel[:] = rates
    look = mujoco.MjData(model)
    steps = round(end / samples / h)
    states, wall = [(data.qpos.copy(), data.qvel.copy())], 0.0
    for _ in range(samples):
        begin = time.perf_counter()
        mujoco.mj_step(model, data, nstep=steps)
        wall += time.perf_counter() - begin
        states.append((data.qpos.copy(), data.qvel.copy()))
        if not np.abs(data.qvel).max() < FAR:
            break
    places, energies = [], []
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    for q, v in states:
        look.qpos[:], look.qvel[:] = q, v
        mujoco.mj_forward(model, look)
        places.append(look.site_xpos[0].copy())
        energies.append(look.energy.sum())
    whole = len(states) == samples + 1
    return PeerRun(
        samples_times(end, samples)[: len(states)],
        np.array(places)[:, _components(scene)],
        np.array(energies),
        wall,
        whole,
    )


def scenes() -> tuple[str, ...]:
    """Names of the shared scenes."""
    return ("double_four_bar", "bricard", "spatial_chain", "four_bar_40", "four_bar_200")


def integrators(scene: str) -> tuple[str, ...]:
    """Integrators that are tried."""
    return INTEGRATORS


def _components(scene: str) -> list[int]:
    return [0, 2] if "four_bar" in scene else [0, 1, 2]


def _model(scene: str, h: float, integrator: str) -> tuple[mujoco.MjModel, np.ndarray]:
    if "four_bar" in scene:
        windows = int(scene.rpartition("_")[2]) if scene[-1].isdigit() else 2
        bodies, closures, rates = _four_bar(windows, h)
        gravity = "0 0 -9.81"
    elif scene == "bricard":
        bodies, closures, rates = _bricard(h)
        gravity = "0 -9.81 0"
    else:
        bodies, closures, rates = _chain()
        gravity = "0 0 -9.81"
    text = f"""<mujoco><option timestep="{h!r}" integrator="{integrator}" gravity="{gravity}" solver="Newton"
      tolerance="1e-12" iterations="20"><flag contact="disable"/></option>
      <worldbody>{bodies}</worldbody><equality>{closures}</equality></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    return model, np.asarray(rates)


def _connect(body: str, other: str, anchor: str, h: float) -> str:
    second = f'body2="{other}"' if other else ""
    return f'<connect body1="{body}" {second} anchor="{anchor}" solref="{2.0 * h!r} 1" {HARD}/>'


def _four_bar(windows: int, h: float) -> tuple[str, str, list[float]]:
    bodies, closures, rates = "", "", []
    rod = 'mass="1" diaginertia="0.0833333333333333333 0.0833333333333333333 0.0833333333333333333"'
    for i in range(windows + 1):
        site = '<site name="B0" pos="0 0 1"/>' if i == 0 else ""
        rates.append(1.0)
        coupler = ""
        if i < windows:
            coupler = f"""<body name="coupler{i}" pos="0 0 1"><joint type="hinge" axis="0 1 0"/>
              <inertial pos="0.5 0 0" {rod}/></body>"""
            closures += _connect(f"coupler{i}", f"crank{i + 1}", "1 0 0", h)
            rates.append(-1.0)
        bodies += f"""<body name="crank{i}" pos="{i} 0 0"><joint type="hinge" axis="0 1 0"/>
          <inertial pos="0 0 0.5" {rod}/>{site}{coupler}</body>"""
    return bodies, closures, rates


def _rod(along: np.ndarray, mass: float, length: float, side: float) -> str:
    axial, transverse = mass * side**2 / 6.0, mass * (length**2 + side**2) / 12.0
    inertia = transverse * np.eye(3) + (axial - transverse) * np.outer(along, along)
    full = [inertia[0, 0], inertia[1, 1], inertia[2, 2], inertia[0, 1], inertia[0, 2], inertia[1, 2]]
    return f'<inertial pos="{_numbers(0.5 * length * along)}" mass="{mass}" fullinertia="{_numbers(full)}"/>'


def _numbers(values: object) -> str:
    return " ".join(repr(float(v)) for v in np.asarray(values))


def _bricard(h: float) -> tuple[str, str, list[float]]:
    points = np.array(bricard.POINTS, float) * bricard.LENGTH
    head, tail = "", ""
    for k in range(5):
        along = (points[k + 1] - points[k]) / bricard.LENGTH
        place = points[0] if k == 0 else points[k] - points[k - 1]
        site = f'<site name="P3" pos="{_numbers(points[2] - points[1])}"/>' if k == 1 else ""
        head += f"""<body name="rod{k}" pos="{_numbers(place)}"><joint type="hinge" axis="{_numbers(bricard.AXES[k])}"/>
          {_rod(along, bricard.MASS, bricard.LENGTH, bricard.SECTION)}{site}"""
        tail += "</body>"
    end = points[5] - points[4]
    # two points of the last axis stay where they are: the revolute on the ground
    closures = _connect("rod4", "", _numbers(end), h) + _connect("rod4", "", _numbers(end + bricard.AXES[5]), h)
    return head + tail, closures, [0.0] * 5


def _chain() -> tuple[str, str, list[float]]:
    s = spatial_chain
    along, square, across = s.directions()
    head, tail = "", ""
    for k in range(s.LINKS):
        axis = across if k % 2 == 0 else square
        place = s.LENGTH * along if k else np.zeros(3)
        site = f'<site name="tip" pos="{_numbers(s.LENGTH * along)}"/>' if k == s.LINKS - 1 else ""
        head += f"""<body pos="{_numbers(place)}"><joint type="hinge" axis="{_numbers(axis)}"/>
          {_rod(along, s.MASS, s.LENGTH, s.SECTION)}{site}"""
        tail += "</body>"
    return head + tail, "", [s.SPIN, s.SPIN] + [0.0] * (s.LINKS - 2)
