"""Rayleigh damping has its ratio in a body that is held at its reference node alone."""

import numpy as np
import pytest

from mbs import Simulation, compile, linearise
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.section import round_bar
from mbs.model import Model
from tests.flexible_engine.bodies import ALUMINIUM

MIDDLE = 1.2157  # deflection in the middle of a free bar's first mode over its root mean square


@pytest.mark.parametrize(("reference", "held", "times"), [(0, True, 1.0), (4, False, 1.0 + MIDDLE**2)])
@pytest.mark.parametrize("damping", [RayleighDamping(2.0, 0.0), RayleighDamping(0.0, 2e-5)])
def test_the_part_by_mass_holds_for_a_body_that_is_held_at_its_reference(reference, held, times, damping):
    """A free bar with its reference in the middle moves there against its centre of mass."""
    frame = Frame(np.linspace((0, 0, 0), (1, 0, 0), 9), [Beam(i, i + 1, round_bar(0.01), ALUMINIUM) for i in range(8)])
    ends = [Interface(node, rotations=True) for node in (0, 8) if node != reference]
    m = Model("bar", gravity=(0, 0, 0))
    bar = m.flexible_body("bar", craig_bampton(frame.finite_element_model(), reference, ends, 8, damping=damping))
    if held:
        m.weld("clamp", m.ground, bar.frame)
    modes = linearise(Simulation(compile(m))).oscillating_modes()
    lowest = min(modes, key=lambda mode: mode.frequency_hz)
    w = 2.0 * np.pi * lowest.frequency_hz
    assert lowest.damping_ratio == pytest.approx(times * damping.alpha / (2.0 * w) + damping.beta * w / 2.0, rel=0.002)
