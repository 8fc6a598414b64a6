"""Every method with flexible bodies, whose mass matrix moves: order of convergence, what is refused, states, rates."""

from pathlib import Path

import numpy as np
import pytest

from mbs import Settings, compile, simulate
from mbs.kernel import binding
from mbs.kernel.binding.instance import Instance
from mbs.model import Model
from mbs.results.simulation_error import SimulationError
from mbs.scenes import spinning_beam
from mbs.settings.settings import METHODS
from mbs.system.system import System
from tests.flexible_engine.bodies import cloud
from tests.kernel.sensor_rates import rates_of, slopes_of

# bodies of random shapes, so soft that they bend far beyond what linear modes stand for: the equations are what counts
pytestmark = pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")

TIGHT = {"tolerance_r": 1e-13, "tolerance_phi": 1e-13}
END = 0.2
NAMES = [f"tip.{k}" for k in "xyz"]
RATE_STEP = 1e-6
RATE_ERROR = 1e-4
KEPT = 1e-10  # of the energy exchanged
DEFLECTION = 0.02  # of the largest, against geometrically exact beams: what eight parts leave
SPIN_UP = Path(__file__).parents[1] / "data" / "reference" / "spin_up_beam.csv"


def swinging(damping: float) -> System:
    """A cloud of mass points that deforms by as much as they are apart, on a ball joint."""
    m = Model("swinging")
    body = m.flexible_body("cloud", cloud(damping=damping))
    m.spherical("top", m.ground, body, point=body.node_positions[1])
    m.initial_velocity(body, (0.1, 0.2, 0.3), (1.0, 3.0, 2.0))
    for kind in ("kinetic", "gravity", "elastic", "total"):
        m.sense_energy(kind, kind)
    for k in "xyz":
        m.sense_position(f"tip.{k}", body, body.node_positions[3], k)
    return compile(m)


def end_of(system: System, h: float, settings: Settings) -> np.ndarray:
    run = simulate(system, END, h, settings=settings, every=round(END / h), progress=False)
    return np.array([run[n][-1] for n in NAMES])


@pytest.mark.parametrize(
    ("method", "damping", "order", "coarsest"),
    [
        ("ali3p", 1.0, 2, 20),
        ("ali3p_generalised_alpha", 1.0, 2, 20),
        ("energy_momentum", 1.0, 2, 20),
        ("energy_momentum_4", 0.0, 4, 10),
    ],
)
def test_all_methods_go_to_the_same_motion_at_their_order(method, damping, order, coarsest):
    system, steps = swinging(damping), END / (coarsest * 2.0 ** np.arange(3))
    reference = end_of(system, END / 200, Settings(method="runge_kutta_8", **TIGHT))
    settings = Settings(method=method, **TIGHT)
    errors = [float(np.linalg.norm(end_of(system, h, settings) - reference)) for h in steps]
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(order, abs=0.3)
    assert errors[0] > 1e3 * 1e-13


def test_the_energy_momentum_step_keeps_the_energy_of_bodies_that_deform():
    """Their mass matrix moves: M v is taken at both ends of the step, with the exact difference quotient of v' M v."""
    run = simulate(swinging(0.0), 2.0, 0.01, settings=Settings(method="energy_momentum"), progress=False)
    assert np.ptp(run["elastic"]) > 0.1 * np.ptp(run["kinetic"])
    assert np.ptp(run["total"]) < KEPT * np.ptp(run["kinetic"])


@pytest.mark.slow
def test_the_energy_momentum_step_carries_a_spinning_beam_to_its_deflection():
    """Coordinates without mass: what the velocity has off the rows there no energy bounds; it grew by 5 1/s."""
    system = compile(spinning_beam.build())
    settings = Settings(method="energy_momentum", max_halvings=0)
    t = simulate(system, spinning_beam.DURATION, 0.02, settings=settings, progress=False)
    when, _, expected = np.loadtxt(SPIN_UP, delimiter=",", skiprows=2).T
    _, result = spinning_beam.extension_and_deflection(t.t, t["tip.x"], t["tip.y"])
    assert np.abs(np.interp(when, t.t, result) - expected).max() < DEFLECTION * np.abs(expected).max()


def test_damped_bodies_cannot_step_backwards():
    with pytest.raises(SimulationError, match="no damping"):
        simulate(swinging(1.0), 0.1, 0.01, settings=Settings(method="energy_momentum_4"), progress=False)


@pytest.mark.parametrize("method", ["energy_momentum", "ali3p_generalised_alpha"])
def test_a_restored_state_continues_alike_after_a_change_of_method(method):
    loaded = binding.LoadedSystem(swinging(1.0).to_bytes())
    first, second = Instance(loaded), Instance(loaded)
    first.initialise()
    first.run(0.01, 5)
    first.set_settings(**METHODS[method])
    first.run(0.01, 3)
    first.set_settings(**METHODS["ali3p"])
    second.restore(first.save())
    for instance in (first, second):
        instance.run(0.01, 5)
    assert first.sensors()[:] == second.sensors()[:]


def test_rates_of_energies():
    system = swinging(1.0)
    instance = Instance(binding.LoadedSystem(system.to_bytes()))
    instance.initialise()
    instance.set_settings(**METHODS["runge_kutta_8"])  # its accelerations are those of the state
    instance.run(0.002, 50)
    actual, chosen = rates_of(instance)
    slopes = slopes_of(instance, RATE_STEP)
    names = [s["name"] for s in system.meta["sensors"]]
    assert {"kinetic", "gravity", *NAMES} <= {n for n, k in zip(names, chosen, strict=True) if k}
    assert np.allclose(actual[chosen], slopes[chosen], rtol=RATE_ERROR, atol=RATE_ERROR * np.max(np.abs(slopes)))
    assert np.max(np.abs(actual[chosen])) > 1.0


def test_a_stiff_beam_takes_one_iteration_a_step():
    """The penalty of its joint goes with the stiffness of its modes; that of rigid bodies takes 1.8 iterations."""
    run = simulate(compile(spinning_beam.build()), 0.5, 0.01, estimate_error=False)
    assert run.report.steps == 50
    assert run.report.iterations < 60
