"""Requirements of `mbs/kernel/src/method.h` on every method, and on the states after its steps."""

import numpy as np
import pytest

from benchmarks.references.cases import system_of
from mbs import compile, simulate
from mbs.kernel.binding import ControlFields, KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance
from mbs.settings.settings import METHODS
from tests.methods.models import two_rods

H = 0.005  # s
GOOD_STEPS = 7


def driven_chain() -> bytes:
    """Two rods in a plane, a torque by an input on the first: every method takes it."""
    m, first, second = two_rods("chain")
    m.torque("motor", first, inputs=m.input("motor", start=2.0, unit="N m"))
    m.sense_position("tip.y", second, (2.0, 0.0), "y")
    return compile(m).to_bytes()


def started(method: str) -> Instance:
    instance = Instance(LoadedSystem(driven_chain()))
    instance.set_settings(**METHODS[method])
    instance.initialise()
    return instance


def state_of(instance: Instance) -> list[np.ndarray]:
    return [np.array(part) for part in instance.get_state()]


@pytest.mark.parametrize("method", METHODS)
def test_a_run_that_is_refused_ends_with_the_whole_state_of_its_last_good_step(method: str) -> None:
    """Steps that nobody looks at may leave out what only readers need; the refusal makes up for it."""
    inputs = np.full((GOOD_STEPS + 3, 1), 2.0)
    inputs[GOOD_STEPS] = np.nan
    stopped, straight = started(method), started(method)
    with pytest.raises(KernelError) as refused:
        stopped.run(H, len(inputs), inputs)
    assert refused.value.status == Status.BAD_ARGUMENT
    straight.run(H, GOOD_STEPS)
    for one, other in zip(state_of(stopped), state_of(straight), strict=True):
        assert one.tobytes() == other.tobytes()


@pytest.mark.parametrize("method", [m for m in METHODS if m != "ali3p_no_projection"])
def test_a_controlled_run_ends_with_multipliers_of_its_state(method: str) -> None:
    """M qdd + Phi_q' lam = Q at the end, where steps before it may have left out the multipliers."""
    instance = started(method)
    sizes = instance.system.sizes
    fields = ControlFields(tolerance=1e-6, length=1.0, span=0.2, rate=3.0, longest=0.05)
    times, sensors, positions = np.array([0.2]), np.zeros((1, sizes.ns)), np.zeros((1, sizes.nq))
    instance.control_run(fields, np.ones(sizes.nq), 0.2, 10**6, times, sensors, positions, 0)
    state = state_of(instance)
    instance.refresh()
    again = state_of(instance)
    assert np.abs(again[3]).max() > 1.0
    np.testing.assert_allclose(state[3], again[3], rtol=2e-2, atol=1e-2)
    assert state[0].tobytes() == positions[0].tobytes()


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum_4", "radau_5"])
def test_the_way_of_the_velocity_is_that_of_the_motion(method: str) -> None:
    """Of composed steps too, whose last part is not the step."""
    system = system_of("spatial_chain")
    reports = [
        simulate(system, 1.0, 0.002, method=m, progress=False, estimate_error=False).report
        for m in (method, "runge_kutta_8")
    ]
    assert reports[0].velocity_path == pytest.approx(reports[1].velocity_path, rel=0.02)
