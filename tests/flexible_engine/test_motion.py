"""Flexible bodies in motion: rigid limit, balances, order of the step, closed forms of statics and vibration."""

import numpy as np
import pytest

from mbs import Settings, compile, linearise, simulate
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.section import round_bar
from mbs.model import Model
from mbs.model.body import Body
from mbs.simulation.stepping import Simulation
from tests.flexible_engine.bodies import ALUMINIUM, bar, cloud

# bodies of random shapes, so soft that they bend far beyond what linear modes stand for: the equations are what counts
pytestmark = pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")

TIGHT = Settings(tolerance_r=1e-14)
"""Newton leaves r: an error of the accelerations of 4 r / h^2, which would hide the order of the step."""
STIFF = 1e4  # of the stiffness in the rigid limit


def _rigid_twin(m: Model, name: str, reduced: ReducedBody) -> Body:
    """The rigid body with the mass points of a reduced body in its undeformed shape."""
    x, masses = reduced.mass_positions + reduced.origin, reduced.masses
    com = masses @ x / masses.sum()
    r = x - com
    inertia = np.einsum(
        "k,kij->ij", masses, np.einsum("ka,ka,ij->kij", r, r, np.eye(3)) - np.einsum("ki,kj->kij", r, r)
    )
    return m.body(name, mass=float(masses.sum()), com=com, inertia=inertia)


def _double_pendulum(kind: str) -> Model:
    """A bar from the origin and a rigid rod hinged to its free end, turning and falling in space."""
    m = Model(kind)
    reduced = bar((0, 0, 0), (0.5, 0, 0), stiffer=STIFF)
    first: Body = m.flexible_body("bar", reduced) if kind == "flexible" else _rigid_twin(m, "bar", reduced)
    rod = m.body("rod", mass=0.3, com=(0.5, 0.2, 0), inertia=(4e-3, 1e-4, 4e-3))
    m.spherical("top", m.ground, first, point=(0, 0, 0))
    m.revolute("hinge", first, rod, point=(0.5, 0, 0), axis=(1, 0, 0))
    m.initial_velocity(rod, (0, 1.0, 0), (2.0, 0, 0))
    for k in "xyz":
        m.sense_position(k, rod, (0.5, 0.4, 0), k)
    return m


def test_a_stiff_flexible_body_moves_like_a_rigid_one() -> None:
    flexible, rigid = (
        simulate(compile(_double_pendulum(k)), 1.0, 0.002, progress=False) for k in ("flexible", "rigid")
    )
    travelled = max(np.ptp(rigid[k]) for k in "xyz")
    assert travelled > 0.5
    for k in "xyz":
        np.testing.assert_allclose(flexible[k], rigid[k], atol=2e-5 * travelled)


def test_joints_hold_a_flexible_body_to_a_rigid_one_exactly() -> None:
    m = Model("compatible")
    reduced = bar((0, 0, 0), (0.5, 0, 0))
    beam = m.flexible_body("bar", reduced)
    rod = m.body("rod", mass=0.3, com=(0.5, 0.2, 0), inertia=(4e-3, 1e-4, 4e-3))
    m.weld("root", m.ground, beam.interface(0))
    m.revolute("hinge", beam, rod, point=(0.5, 0, 0), axis=(1, 0, 0))
    tip, axis = beam.node(8), beam.interface(8).vector((1, 0, 0))
    gaps = [(f"gap {k}", tip[k] - rod.point((0.5, 0, 0))[k]) for k in range(3)]
    gaps += [(f"turn {k}", axis[k] - rod.vector((1, 0, 0))[k]) for k in range(3)]
    for name, gap in gaps:
        m.sense_coordinate(name, gap)
    m.sense_position("tip.z", beam, (0.5, 0, 0), "z")
    # the vibration of the bar is too fast for the step
    run = simulate(compile(m), 0.5, 0.005, progress=False, estimate_error=False)
    assert np.ptp(run["tip.z"]) > 5e-4
    for name, _ in gaps:
        assert np.max(np.abs(run[name])) < 1e-11


def _tumbling() -> Model:
    """Mass points that deform by as much as they are apart, without damping."""
    m = Model("tumbling", gravity=(0, 0, 0))
    body = m.flexible_body("cloud", cloud(damping=0.0))
    m.initial_velocity(body, (0.1, 0.2, 0.3), (1.0, 3.0, 2.0))
    for kind in ("kinetic", "elastic", "total"):
        m.sense_energy(kind, kind)
    for k in "xyz":
        m.sense_position(f"tip.{k}", body, body.node_positions[1], k)
    return m


def test_free_body_keeps_its_energy_to_the_order_of_the_step() -> None:
    system = compile(_tumbling())
    steps, errors = np.array([0.008, 0.004, 0.002, 0.001]), []
    for h in steps:
        run = simulate(system, 1.0, float(h), settings=TIGHT, progress=False)
        assert run["elastic"].max() > 0.1 * run["kinetic"][0]
        errors.append(np.max(np.abs(run["total"] - run["total"][0])) / run["total"][0])
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert 1.8 < order < 2.3
    assert errors[-1] < 1e-5


def test_free_body_keeps_its_momentum() -> None:
    """The centre of mass goes straight and the angular momentum stays: from M(q) qd of the kernel."""
    m = _tumbling()
    system = compile(m)
    simulation = Simulation(system, settings=TIGHT)
    names = system.meta["coordinates"]
    r, *axes = ([names.index(f"cloud.{a}{k}") for k in "xyz"] for a in "rabc")

    def momenta() -> np.ndarray:
        state = simulation.state
        momentum = np.reshape(simulation.instance.mass_matrix(state.q.tolist()), (system.nq,) * 2) @ state.qd
        arms = [np.cross(state.q[i], momentum[i]) for i in (r, *axes)]
        return np.concatenate([momentum[r], np.sum(arms, axis=0)])

    start = momenta()
    simulation.step(0.001, 500)
    np.testing.assert_allclose(momenta(), start, atol=1e-5 * np.max(np.abs(start)))


def test_static_sag_of_a_cantilever() -> None:
    """q L^4 / 8 E I under its own weight: with one dynamic mode per direction to better than a tenth of a percent."""
    m = Model("cantilever")
    length, radius = 1.0, 0.01
    reduced = bar((0, 0, 0), (length, 0, 0), round_bar(2 * radius), dynamic=4)
    beam = m.flexible_body("bar", reduced)
    m.weld("root", m.ground, beam.interface(0))
    m.sense_position("tip.z", beam, (length, 0, 0), "z")
    simulation = Simulation(compile(m))
    simulation.static_equilibrium()
    area, second = np.pi * radius**2, np.pi * radius**4 / 4
    expected = -ALUMINIUM.rho * area * 9.81 * length**4 / (8 * ALUMINIUM.E * second)
    assert simulation.sensors["tip.z"] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("joint", ["weld", "free"])
def test_frequencies_at_rest(joint: str) -> None:
    """First bending frequencies of a clamped and of a free slender bar."""
    m = Model("bar", gravity=(0, 0, 0))
    reduced = bar((0, 0, 0), (1.0, 0, 0), round_bar(0.01), dynamic=12)
    beam = m.flexible_body("bar", reduced)
    if joint == "weld":
        m.weld("root", m.ground, beam.interface(0))
    model = linearise(Simulation(compile(m)))
    actual = sorted(mode.frequency_hz for mode in model.oscillating_modes())
    second, area = np.pi * 0.005**4 / 4, np.pi * 0.005**2
    roots = {"weld": (1.8751041, 4.6940911), "free": (4.7300407, 7.8532046)}[joint]
    rate = np.sqrt(ALUMINIUM.E * second / (ALUMINIUM.rho * area)) / (2 * np.pi)
    for k, root in enumerate(roots):  # twice each: two planes
        assert actual[2 * k] == pytest.approx(root**2 * rate, rel=2e-3)
        assert actual[2 * k + 1] == pytest.approx(root**2 * rate, rel=2e-3)
