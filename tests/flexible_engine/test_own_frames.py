"""Frames in space against second finite elements: sag, reactions, section forces, stresses and damped modes."""

import numpy as np
import pytest

from mbs import Simulation, compile, linearise
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.material import Material
from mbs.flexible.recovery import FORCES, StrainGauge, section_forces
from mbs.flexible.section import tube
from mbs.model import Model
from tests.flexible_engine.own_beam_frame import OwnFrame, Tube

E, NU, RHO = 2.1e11, 0.3, 7850.0
DAMPING = 1e-4  # s, of the stiffness
CORNERS = np.array([(0, 0, 0), (0, 0, 1.1), (0.9, 0, 1.1), (0.9, 0, 0), (0.9, 0.7, 1.1), (0, 0.7, 1.1)])
LINES = {
    "portal": [(0, 1), (1, 2), (2, 3)],
    "ring": [(0, 1), (1, 2), (2, 3), (2, 4), (4, 5), (5, 1)],
    "braced": [(0, 1), (1, 2), (2, 3), (0, 2), (1, 5)],
}


@pytest.mark.parametrize("clamps", [(0,), (0, 3)])
@pytest.mark.parametrize("lines", LINES)
@pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")  # the second program is linear, too
def test_frames_are_those_of_a_second_program(lines: str, clamps: tuple[int, ...]) -> None:
    """With a body at corner 2 that is pushed, and welds to the ground at one or two feet."""
    x, pairs = list(CORNERS[: 1 + max(max(line) for line in LINES[lines])].astype(float)), []
    for i, j in LINES[lines]:
        inner = [len(x) + k for k in range(2)]
        x += [CORNERS[i] + (CORNERS[j] - CORNERS[i]) * k / 3.0 for k in (1, 2)]
        pairs += list(zip([i, *inner], [*inner, j], strict=True))
    used = sorted({node for pair in pairs for node in pair})
    x, pairs = np.array(x)[used], [(used.index(i), used.index(j)) for i, j in pairs]
    sizes = [(0.03 + 0.01 * (k // 3 % 3), 0.002) for k in range(len(pairs))]
    mass, inertia, push = 6.0, 0.06, np.array([80.0, -60.0, 40.0])

    own = OwnFrame(x, [(*pair, Tube.of(*size)) for pair, size in zip(pairs, sizes, strict=True)], E, NU, RHO)
    K, C = own.K, DAMPING * own.K
    own.add_mass(2, mass, inertia)
    loads = own.weight()
    loads[12:15] += push
    free = np.setdiff1d(np.arange(len(K)), [6 * node + k for node in clamps for k in range(6)])
    inner = np.ix_(free, free)
    u = np.zeros(len(K))
    u[free] = np.linalg.solve(K[inner], loads[free])
    on_frame = (K @ u - loads).reshape(-1, 6)  # by the ground
    rates = np.linalg.solve(own.M[inner], np.hstack([-K[inner], -C[inner]]))
    roots = np.linalg.eigvals(np.vstack([np.eye(len(free), 2 * len(free), len(free)), rates]))
    roots = sorted(roots[roots.imag > 1.0], key=abs)[:4]

    material = Material(E, NU, RHO)
    frame = Frame(x, [Beam(*pair, tube(*size), material) for pair, size in zip(pairs, sizes, strict=True)])
    interfaces = [Interface(node, rotations=True) for node in (*clamps[1:], 2)]
    damping = RayleighDamping(0.0, DAMPING)
    reduced = craig_bampton(frame.finite_element_model(), 0, interfaces, 20, inertia_modes=True, damping=damping)
    m = Model("frame")
    body = m.flexible_body("frame", reduced)
    welds = [m.weld(f"weld {node}", m.ground, body.interface(node)) for node in clamps]
    load = m.body("load", mass=mass, com=x[2], inertia=(inertia,) * 3)
    m.weld("load", body.interface(2), load)
    inputs = [m.input(f"push {axis}", min=-1e3, max=1e3, start=f) for axis, f in zip("xyz", push, strict=True)]
    m.force("push", load, inputs=inputs)
    for axis in "xyz":
        m.sense_position(axis, load, None, axis)
        for node, weld in zip(clamps, welds, strict=True):
            m.sense_joint(f"force {node} {axis}", weld, axis)
            m.sense_joint(f"moment {node} {axis}", weld, axis, kind="moment")
    for name, row in zip(FORCES, reduced.recovery(section_forces(frame, 0, 0.0)), strict=True):
        m.sense_coordinate(name, body.combination(row), unit="N" if name in FORCES[:3] else "N.m")
    gauge = StrainGauge("gauge", 0, 0.0, fibre=(0.009, 0.012))
    m.sense_coordinate("stress", body.combination(reduced.recovery(gauge.quarter_bridge(frame))[0]), unit="Pa")
    simulation = Simulation(compile(m))
    simulation.static_equilibrium()
    read = simulation.sensors

    sag = np.array([read[axis] for axis in "xyz"]) - x[2]
    np.testing.assert_allclose(sag, u[12:15], atol=1e-3 * np.linalg.norm(u[12:15]))
    for start, kind in ((0, "force"), (3, "moment")):
        for node in clamps:
            on_ground = [read[f"{kind} {node} {axis}"] for axis in "xyz"]
            # moments in the deformed frame
            limit = (1e-6, 0.03)[start > 0] * np.abs(on_frame[list(clamps), start : start + 3]).max()
            np.testing.assert_allclose(on_ground, -on_frame[node, start : start + 3], atol=limit)
    section = own.start_forces(0, u)
    np.testing.assert_allclose([read[name] for name in FORCES[:3]], section[:3], atol=1e-3 * np.abs(section[:3]).max())
    np.testing.assert_allclose([read[name] for name in FORCES[3:]], section[3:], atol=1e-3 * np.abs(section[3:]).max())
    area, second = Tube.of(*sizes[0])
    stress = section[0] / area + (0.012 * section[4] - 0.009 * section[5]) / second
    assert read["stress"] == pytest.approx(stress, rel=1e-3)
    modes = sorted(linearise(simulation).oscillating_modes(), key=lambda mode: mode.frequency_hz)[:4]
    np.testing.assert_allclose([2.0 * np.pi * mode.frequency_hz for mode in modes], np.abs(roots), rtol=2e-3)
    ratios = [-root.real / abs(root) for root in roots]
    np.testing.assert_allclose([mode.damping_ratio for mode in modes], ratios, rtol=5e-3)
