"""Four-bar with an assembly defect (paper, section 3.3): one joint axis is tilted, so it moves only as its bars deform.

Read from the paper: AB 0.12, BC 0.24, CD 0.12, AD 0.24 m, the axis of joint C tilted by 5 degrees, E 7e10 N/m2, Poisson
0.33, 3000 kg/m3, 1 rad/s at the crank, 10 s, no gravity. Not in the paper, taken from the published benchmark of the
same kind (a flexible four-bar with a defect): cranks upright at the start, clockwise, and the axis of C tilted
towards the coupler. The "5 mm" of the round section are its radius: a diameter of 5 mm gives moments of 0.6 N m, a
radius the moments of the paper's Figure 5, from -10 to 6 N m.
"""

from typing import Any

import numpy as np
from scipy.interpolate import PPoly

from mbs.common.errors import ModelError
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.material import Material
from mbs.flexible.recovery import section_forces
from mbs.flexible.section import round_bar
from mbs.model.flexible import FlexibleBody
from mbs.model.model import Model

A, B, C, D = (0.0, 0.0, 0.0), (0.0, 0.12, 0.0), (0.24, 0.12, 0.0), (0.24, 0.0, 0.0)  # m
TILT = 5.0  # degrees
RADIUS = 0.005  # m
MATERIAL = Material(E=7e10, nu=0.33, rho=3000.0)
SPEED = -1.0  # rad/s, clockwise
DURATION = 10.0  # s
DAMPING = RayleighDamping(alpha=0.0, beta=2.7e-5)  # s; assumed: damps the vibrations of the start
NORMAL = (0.0, 0.0, 1.0)


def build(
    parts: int = 1,
    elements: int = 4,
    dynamic_modes: int = 2,
    *,
    flexible: bool = True,
    tilt: float = TILT,
    radius: float = RADIUS,
) -> Model:
    """The linkage with its crank guided; section forces in the middle of the coupler as sensors.

    Parameters
    ----------
    parts : int
        Flexible bodies per bar, welded end to end: each adds its own floating frame, so that large deflections are
        followed.
    elements : int
        Beam elements of each of them, an even number: its frame is in its middle.
    dynamic_modes : int
        Fixed-interface modes of each beside the twelve static ones.
    flexible : bool
        False: rigid bars, which lock unless `tilt` is zero; `compile` then says so.
    tilt : float
        Of the axis of joint C, degrees.
    radius : float
        Of the round bars, m.
    """
    m = Model("four-bar with assembly defect", gravity=(0.0, 0.0, 0.0))
    m.stop_time, m.step = DURATION, 0.01
    a, b, c, d = (np.array(p) for p in (A, B, C, D))
    angular_velocity = np.array([0.0, 0.0, SPEED])
    coupler_velocity = np.cross(angular_velocity, b - a)
    axis = (np.sin(np.radians(tilt)), 0.0, np.cos(np.radians(tilt)))
    if flexible:
        crank = _add_flexible_bar(m, "crank", a, b, radius, parts, elements, dynamic_modes)
        coupler = _add_flexible_bar(m, "coupler", b, c, radius, parts, elements, dynamic_modes)
        follower = _add_flexible_bar(m, "follower", c, d, radius, parts, elements, dynamic_modes)
        ends = [(bar[0].interface(0), bar[-1].interface(elements)) for bar in (crank, coupler, follower)]
        frame: Any = crank[0]
        for body in crank:
            m.initial_velocity(body, np.cross(angular_velocity, body.centre_of_mass - a), angular_velocity)
        for body in coupler:
            m.initial_velocity(body, coupler_velocity)
        for body in follower:
            m.initial_velocity(body, np.cross(angular_velocity, body.centre_of_mass - d), angular_velocity)
        _sense_middle(m, coupler, radius, elements)
    else:
        bars = [
            _add_rigid_bar(m, n, p, q, radius) for n, p, q in (("crank", a, b), ("coupler", b, c), ("follower", c, d))
        ]
        ends = [(bar, bar) for bar in bars]
        frame = bars[0]
    m.revolute("A", m.ground, ends[0][0], point=A, axis=NORMAL)
    m.revolute("B", ends[0][1], ends[1][0], point=B, axis=NORMAL)
    m.revolute("C", ends[1][1], ends[2][0], point=C, axis=axis)
    m.revolute("D", ends[2][1], m.ground, point=D, axis=NORMAL)
    angle = m.relative_angle("crank angle", m.ground, frame, axis=NORMAL)
    m.drive(
        "crank drive", angle, m.guide_time("crank motion", PPoly([[SPEED], [0.0]], [0.0, 2 * DURATION]), unit="rad")
    )
    m.sense_coordinate("crank.angle", angle)
    for component in "xyz":
        m.sense_position(f"C.position.{component}", ends[1][1], C, component, description="position of joint C")
    m.sense_energy("energy.elastic", "elastic", description="energy stored in the bars")
    m.sense_energy("energy.kinetic", "kinetic", description="kinetic energy")
    return m


def _add_flexible_bar(
    m: Model, name: str, start: np.ndarray, end: np.ndarray, radius: float, parts: int, elements: int, modes: int
) -> list[FlexibleBody]:
    """Add a bar as a chain of flexible bodies, with a frame in the middle and an interface at either end of each."""
    if parts < 1 or elements < 2 or elements % 2:
        raise ModelError(f"The {name} needs parts of an even number of elements, not {parts} parts of {elements}.")
    bodies: list[FlexibleBody] = []
    for k in range(parts):
        p, q = start + (end - start) * k / parts, start + (end - start) * (k + 1) / parts
        model = _bar_frame(p, q, radius, elements).finite_element_model()
        ends = [Interface(node, rotations=True) for node in (0, elements)]
        reduced = craig_bampton(model, elements // 2, ends, modes, damping=DAMPING)
        body = m.flexible_body(f"{name} {k + 1}" if parts > 1 else name, reduced)
        if bodies:
            m.weld(f"{name} {k} to {k + 1}", bodies[-1].interface(elements), body.interface(0))
        bodies.append(body)
    return bodies


def _bar_frame(start: np.ndarray, end: np.ndarray, radius: float, elements: int) -> Frame:
    section = round_bar(2.0 * radius)
    beams = [Beam(i, i + 1, section, MATERIAL) for i in range(elements)]
    return Frame(np.linspace(start, end, elements + 1), beams, theory="timoshenko")


def _sense_middle(m: Model, coupler: list[FlexibleBody], radius: float, elements: int) -> None:
    """Add sensors of the torsion and bending moments in the middle of the coupler, in its local axes (x along it)."""
    position = len(coupler) * elements / 2  # in elements from B
    element = min(int(np.ceil(position)) - 1, len(coupler) * elements - 1)
    body, local_element = coupler[element // elements], element % elements
    start = np.asarray(body.node_positions[0])
    length = (np.array(C) - np.array(B)) / len(coupler)
    rows = section_forces(_bar_frame(start, start + length, radius, elements), local_element, position - element)
    weights = body.reduced.recovery(rows.toarray())
    for name, row, quantity in (("T", 3, "torsion"), ("My", 4, "bending moment"), ("Mz", 5, "bending moment")):
        m.sense_coordinate(
            f"coupler.{name}",
            body.combination(weights[row]),
            unit="N m",
            description=f"{quantity} in the middle of the coupler",
        )


def _add_rigid_bar(m: Model, name: str, start: np.ndarray, end: np.ndarray, radius: float) -> Any:
    length = float(np.linalg.norm(end - start))
    mass = MATERIAL.rho * np.pi * radius**2 * length
    axis = (end - start) / length
    transverse, axial = mass * (3 * radius**2 + length**2) / 12, mass * radius**2 / 2
    inertia = transverse * np.eye(3) + (axial - transverse) * np.outer(axis, axis)
    return m.body(name, mass=mass, com=(start + end) / 2, inertia=inertia)
