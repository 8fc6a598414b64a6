"""Section forces and stresses are compared by the check of a run, in any unit, beside a motion that is much larger."""

import warnings

import numpy as np
import pytest

from mbs import AccuracyWarning, Trajectory, compile, simulate
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.recovery import StrainGauge
from mbs.flexible.section import round_bar
from mbs.model import Model
from tests.flexible_engine.bodies import ALUMINIUM

LENGTH, MASS, SPEED, DURATION = 1.0, 20.0, 5.0, 1.0  # m, kg, m/s, s
SECTION = round_bar(0.04)
STIFFNESS = 3.0 * ALUMINIUM.E * SECTION.Iy / LENGTH**3
BAR = 33.0 / 140.0 * ALUMINIUM.rho * SECTION.area * LENGTH  # kg, that moves with the end (Rayleigh)
RATE = np.sqrt(STIFFNESS / (MASS + BAR))  # rad/s
WEIGHT = 9.81 * LENGTH * (MASS + ALUMINIUM.rho * SECTION.area * LENGTH / 2.0)  # N m, about the root


def _run(unit: str, h: float) -> tuple[Trajectory, list[str]]:
    """A bar with a mass at its end on a carriage; its weight acts from the start. Sensor "root" in `unit`."""
    frame = Frame(np.linspace((0, 0, 0), (LENGTH, 0, 0), 5), [Beam(i, i + 1, SECTION, ALUMINIUM) for i in range(4)])
    reduced = craig_bampton(frame.finite_element_model(), 0, [Interface(4, rotations=True)], inertia_modes=True)
    gauge = StrainGauge("root", 0, 0.0)
    rows, scale = {
        "N.m": (gauge.bending_moment(frame), 1.0),
        "Pa": (gauge.quarter_bridge(frame), 1.0),
        "MPa": (gauge.quarter_bridge(frame), 1e-6),
    }[unit]
    m = Model("carriage")
    carriage = m.body("carriage", mass=100.0, com=(0, 0, 0), inertia=(1.0, 1.0, 1.0))
    m.prismatic("rail", carriage, m.ground, axis=(1, 0, 0))
    bar = m.flexible_body("bar", reduced)
    m.weld("root", carriage, bar.interface(0))
    end = m.body("end", mass=MASS, com=(LENGTH, 0, 0), inertia=(1e-3, 1e-3, 1e-3))
    m.spherical("tip", bar, end, point=(LENGTH, 0, 0))
    for body in (carriage, bar, end):
        m.initial_velocity(body, (SPEED, 0, 0))
    m.sense_position("x", carriage, None, "x")
    m.sense_coordinate("root", scale * bar.combination(reduced.recovery(rows)[0]), unit=unit)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = simulate(compile(m), DURATION, h, progress=False)
    return run, [str(w.message) for w in caught if w.category is AccuracyWarning]


@pytest.mark.parametrize(("unit", "size"), [("N.m", 1.0), ("Pa", 0.02 / SECTION.Iy), ("MPa", 0.02e-6 / SECTION.Iy)])
def test_a_vibration_beside_a_large_motion_is_checked_by_its_stress(unit: str, size: float) -> None:
    """Moment of a weight that is put on at once: twice the static one, ``W L (1 - cos w t)``."""
    for h, is_right in ((0.01, False), (0.0005, True)):
        run, texts = _run(unit, h)
        exact = size * WEIGHT * (1.0 - np.cos(RATE * run.t))
        error = np.abs(run["root"] - exact).max() / np.ptp(exact)
        assert (error < 0.05) == is_right
        assert bool(texts) != is_right
        assert all("sensor 'root'" in text for text in texts)
