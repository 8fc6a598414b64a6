"""Flexible beam on a spinning hub (Simo and Vu-Quoc 1986): E A 2.8e7 N, E I 1.4e4 N m2, 1.2 kg/m, 10 m, to 6 rad/s in
15 s. It is stiff in shear; centrifugal tension acts between its parts.
"""

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PPoly

from mbs.common.checks import whole
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.material import Material
from mbs.flexible.section import Section
from mbs.model.flexible import FlexibleBody
from mbs.model.model import Model

LENGTH = 10.0  # m
DURATION = 20.0  # s
SECTION = Section(1.2e-3, 6e-7, 6e-7, 1.2e-6, (1.0, 0.0, 1.0, 0.0), (1.0, 0.0, 1.0, 0.0), ())
MATERIAL = Material(2.8e7 / 1.2e-3, 0.3, 1000.0)
STEADY_EXTENSION = 1.2 * 36.0 * LENGTH**3 / (3.0 * 2.8e7)  # m: rho A w^2 L^3 / 3 E A
ELEMENTS = 2


def spin_angle() -> CubicHermiteSpline:
    """Angle of the hub over time, rad: to 6 rad/s within 15 s."""
    t = np.linspace(0.0, 15.0, 301)
    w = 2 * np.pi / 15
    angle = 0.4 * (t**2 / 2 + (np.cos(w * t) - 1) / w**2)
    return CubicHermiteSpline([*t, DURATION], [*angle, 75.0], [*(0.4 * (t - np.sin(w * t) / w)), 6.0])


def build(parts: int = 8) -> Model:
    """The beam with its root on the hub.

    Parameters
    ----------
    parts : int
        Flexible bodies welded end to end, each with its frame in its middle. One alone cannot be stiffened by the
        tension and leaves its axis by metres.
    """
    parts = whole(parts, "The number of parts of the spinning beam", 1)
    m = Model("spinning beam", gravity=(0.0, 0.0, 0.0))
    m.stop_time, m.step = DURATION, 0.01
    x = np.linspace(0.0, LENGTH, parts + 1)
    beam: list[FlexibleBody] = []
    for k in range(parts):
        nodes = np.zeros((ELEMENTS + 1, 3))
        nodes[:, 0] = np.linspace(x[k], x[k + 1], ELEMENTS + 1)
        frame = Frame(nodes, [Beam(i, i + 1, SECTION, MATERIAL) for i in range(ELEMENTS)], theory="timoshenko")
        ends = [Interface(n, rotations=True) for n in (0, ELEMENTS)]
        beam.append(m.flexible_body(f"part {k}", craig_bampton(frame.finite_element_model(), ELEMENTS // 2, ends, 0)))
        if k:
            m.weld(f"{k - 1} to {k}", beam[k - 1].interface(ELEMENTS), beam[k].interface(0))
    root = beam[0].interface(0)
    m.revolute("hub", m.ground, root, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    angle = m.relative_angle("angle", m.ground, root, axis=(0.0, 0.0, 1.0))
    motion = spin_angle()
    m.drive("motor", angle, m.guide_time("spin", PPoly(motion.c, motion.x), unit="rad"))
    for c in "xy":
        m.sense_position(f"tip.{c}", beam[-1].interface(ELEMENTS), (LENGTH, 0.0, 0.0), c, description="free end")
    m.sense_energy("energy.elastic", "elastic", description="energy stored in the beam")
    return m


def extension_and_deflection(t: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Extension along the undeformed beam and deflection across it, m, from tip positions x, y, m, at times t, s."""
    angle = spin_angle()(t)
    return np.cos(angle) * x + np.sin(angle) * y - LENGTH, np.cos(angle) * y - np.sin(angle) * x
