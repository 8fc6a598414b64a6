"""Small flexible bodies for tests: reduced beams, and a cloud of mass points with random shapes."""

from dataclasses import replace

import numpy as np

from mbs import System, compile
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.material import Material
from mbs.flexible.reduced_body import InterfaceModes, ReducedBody
from mbs.flexible.section import Section, round_bar
from mbs.model import Model
from mbs.model.flexible import FlexibleBody

ALUMINIUM = Material(E=7e10, nu=0.33, rho=3000.0)


def cloud(n_points: int = 7, n_modes: int = 5, seed: int = 0, damping: float = 1.0) -> ReducedBody:
    """Mass points anywhere with random shapes; node 0 is the reference, node k > 0 is mass point k."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1.0, 1.0, (n_points, 3))
    phi = rng.uniform(-1.0, 1.0, (n_points, 3, n_modes))
    masses = rng.uniform(0.5, 2.0, n_points)
    A, B = rng.uniform(-1.0, 1.0, (2, n_modes, n_modes))
    turn = rng.uniform(-1.0, 1.0, (n_points, 3, n_modes))
    x[0], phi[0], turn[0] = 0.0, 0.0, 0.0
    weighted = (np.sqrt(masses)[:, None, None] * phi).reshape(-1, n_modes)
    names = tuple(f"n{k}" for k in range(n_points))
    return ReducedBody(
        origin=np.array([0.3, -0.2, 0.5]),
        node_names=names,
        node_positions=x,
        node_translations=phi,
        node_rotations=turn,
        modes=phi.reshape(-1, n_modes),
        mass_positions=x,
        masses=masses,
        mass_shapes=phi,
        K=A @ A.T * 50.0,
        M=weighted.T @ weighted,
        C=damping * B @ B.T,
        mode_names=tuple(f"mode {j}" for j in range(n_modes)),
        interfaces={"n1": InterfaceModes(1, x[1], None, None)},
        n_static=0,
        frequencies=np.ones(n_modes),
    )


def bar(
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    section: Section | None = None,
    material: Material = ALUMINIUM,
    *,
    elements: int = 8,
    dynamic: int = 4,
    stiffer: float = 1.0,
) -> ReducedBody:
    """A straight bar held at its first node, with an interface at its last; nodes "0" .. str(elements)."""
    x = np.linspace(start, end, elements + 1)
    frame = Frame(x, [Beam(i, i + 1, section or round_bar(0.02), material) for i in range(elements)])
    reduced = craig_bampton(frame.finite_element_model(), 0, [Interface(elements, rotations=True)], dynamic)
    return replace(reduced, K=stiffer * reduced.K)


def chain(
    m: Model,
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    section: Section,
    material: Material,
    *,
    parts: int,
    elements: int = 2,
    dynamic: int = 0,
    damping: RayleighDamping | None = None,
) -> list[FlexibleBody]:
    """A straight beam of flexible bodies welded end to end, each with its frame in its middle."""
    x = np.linspace(start, end, parts + 1)
    bodies: list[FlexibleBody] = []
    for k in range(parts):
        nodes = np.linspace(x[k], x[k + 1], elements + 1)
        frame = Frame(nodes, [Beam(i, i + 1, section, material) for i in range(elements)], theory="timoshenko")
        ends = [Interface(n, rotations=True) for n in (0, elements)]
        reduced = craig_bampton(frame.finite_element_model(), elements // 2, ends, dynamic, damping=damping)
        bodies.append(m.flexible_body(f"part {k}", reduced))
        if k:
            m.weld(f"weld {k}", bodies[k - 1].interface(elements), bodies[k].interface(0))
    return bodies


def soft_pendulum(parts: int) -> System:
    """A soft bar of 1 m that falls from the horizontal, with the place of its tip.

    Error of the tip against a geometrically exact beam: 11 mm as one body, 4.8 mm as two.
    """
    m = Model("pendulum", gravity=(0, -9.81, 0))
    bar = chain(m, (0, 0, 0), (1, 0, 0), round_bar(0.02), Material(5e8, 0.3, 2000.0), parts=parts, elements=4)
    m.revolute("pin", m.ground, bar[0].interface(0), point=(0, 0, 0), axis=(0, 0, 1))
    for k in "xy":
        m.sense_position(k, bar[-1].interface(4), (1, 0, 0), k)
    return compile(m)
