"""Memory of methods between steps: complete in a saved state, unchanged by a failed step, checked when loaded."""

import struct
import zlib
from collections.abc import Callable

import numpy as np
import pytest

from mbs import Model, compile
from mbs.kernel.binding import KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance
from mbs.scenes import bricard, double_four_bar, prototype_car, spatial_chain
from mbs.settings.settings import METHODS
from tests.methods.rolling_models import sleigh
from tests.methods.trees import branching

H = 0.005  # s
HEADER = 40  # bytes of a state
COUNT_AT = 32  # byte of a state
CHECKED_FROM = 28  # byte of a state
CRC_AT = 24  # byte of a state
OWNER_AND_TIMES = 6  # numbers of a memory
PAST = 4  # steps
IMPOSSIBLE = {"max_iterations": 1, "tolerance_r": 1e-300, "tolerance_phi": 1e-300}
GOOD = {"max_iterations": 30, "tolerance_r": 1e-10, "tolerance_phi": 1e-11}
SEED = 11


def loaded(model: Model | LoadedSystem) -> LoadedSystem:
    return LoadedSystem(compile(model).to_bytes()) if isinstance(model, Model) else model


def started(model: Model | LoadedSystem, method: str, steps: int = 6, **settings: float) -> Instance:
    instance = Instance(loaded(model))
    instance.initialise()
    choose(instance, method, **settings)
    instance.run(H, steps)
    return instance


def choose(instance: Instance, method: str, **settings: float) -> None:
    instance.set_settings(**({"project": 1} | METHODS[method] | settings))


def twin(model: Model | LoadedSystem, state: bytes) -> Instance:
    instance = Instance(loaded(model))
    instance.restore(state)
    return instance


@pytest.mark.parametrize("after", METHODS)
def test_a_state_s_bytes_depend_on_no_earlier_step_of_another_method(after: str) -> None:
    system = loaded(double_four_bar.build())
    for before in METHODS:
        instance = started(system, before)
        choose(instance, after)
        other = twin(system, instance.save())
        for _ in range(3):
            instance.step(H)
            other.step(H)
            assert other.save() == instance.save(), before


def test_saved_states_do_not_depend_on_element_states_two_steps_ago() -> None:
    system = loaded(prototype_car.build())
    instance = started(system, "energy_momentum", 7)
    other = twin(system, instance.save())
    instance.step(H)
    other.step(H)
    assert other.save() == instance.save()


def test_a_run_that_fails_later_shows_the_outputs_of_the_inputs_it_went_with() -> None:
    model = branching(True)
    shove = model.input("shove", unit="N", start=0.0, min=-5.0, max=5.0)
    model.force("shove", model.bodies[0], None, inputs=[shove, None, None], axes="body")
    instance, other = (started(model, "semi_recursive", 0) for _ in range(2))
    inputs = np.array([[2.0, 0.0], [2.0, 1.0], [-5.0, 1.0], [5.0, np.nan], [0.0, 0.0]])
    with pytest.raises(KernelError):
        instance.run(H, 5, inputs)
    other.run(H, 3, inputs[:3])
    for a, b in zip(instance.get_state()[:4], other.get_state()[:4], strict=True):
        assert bytes(a) == bytes(b)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("energy_momentum", "ali3p"),
        ("radau_5", "ali3p_generalised_alpha"),
        ("radau_5", "energy_momentum"),
        ("energy_momentum", "radau_5"),
    ],
)
def test_a_failed_attempt_with_another_method_leaves_the_memory_of_the_last(first: str, second: str) -> None:
    instance = started(double_four_bar.build(), first)
    before = numbers_of(instance)
    choose(instance, second, max_halvings=0, **IMPOSSIBLE)
    with pytest.raises(KernelError):
        instance.step(0.5)
    assert numbers_of(instance) == before


def numbers_of(instance: Instance) -> bytes:
    """The vectors of a state, after header, settings and report."""
    z = instance.system.sizes
    past = z.nu + z.np + (1 + PAST) * z.nq + PAST * z.nc + OWNER_AND_TIMES
    return instance.save()[-8 * (past + 3 * z.nq + z.nc) :]


def test_the_violation_that_a_run_records_is_the_one_a_step_reports() -> None:
    every = 4
    model = spatial_chain.build()
    model.sense_solver("violation", "violation")
    instance, other = (started(model, "semi_recursive", 0) for _ in range(2))
    recorded = np.empty((8 // every, instance.system.sizes.ns))
    instance.run(H, 8, None, every, recorded)
    expected = []
    for k in range(8):
        other.step(H)
        if (k + 1) % every == 0:
            expected.append(other.sensors()[-1])
    assert recorded[:, -1].tolist() == expected
    assert max(expected) > 0.0


def sealed(state: bytearray) -> bytes:
    struct.pack_into("<I", state, CRC_AT, zlib.crc32(bytes(state[CHECKED_FROM:])))
    return bytes(state)


@pytest.mark.parametrize("count", [-1, 1 << 53, (1 << 63) - 1])
def test_a_counter_that_would_overflow_is_refused(count: int) -> None:
    instance = started(double_four_bar.build(), "ali3p")
    for at in (COUNT_AT, HEADER + 80):  # of steps of this size, and of the report
        state = bytearray(instance.save())
        struct.pack_into("<q", state, at, count)
        with pytest.raises(KernelError) as refusal:
            instance.restore(sealed(state))
        assert refusal.value.status == Status.BAD_STATE


@pytest.mark.parametrize("method", METHODS)
def test_a_memory_of_any_content_gives_no_infinite_state(method: str) -> None:
    instance = started(double_four_bar.build(), method)
    z = instance.system.sizes
    state = instance.save()
    carried = OWNER_AND_TIMES + (1 + PAST) * z.nq + PAST * z.nc
    start = len(state) - 8 * (carried + z.nu + z.np)
    assert struct.unpack_from("<d", state, start)[0] in range(len(METHODS))
    rng = np.random.default_rng(SEED)
    for _ in range(40):
        altered = bytearray(state)
        for _ in range(rng.integers(1, 5)):
            place = rng.integers(OWNER_AND_TIMES if rng.random() < 0.5 else carried)
            value = rng.choice([0.0, -1.0, -H, 1.5, 3.0, 5.0, 65.0, 1e-300, 1e20, -1e59, float(rng.integers(30))])
            struct.pack_into("<d", altered, start + 8 * int(place), value)
        instance.restore(sealed(altered))
        for _ in range(2):
            try:
                instance.step(H)
            except KernelError:
                instance.set_settings(**GOOD)
        assert all(np.isfinite(np.array(part)).all() for part in instance.get_state())


def act(instance: Instance, rng: np.random.Generator) -> int:
    """One call at random; its status."""
    z, kind, h = instance.system.sizes, rng.random(), float(rng.choice([1e-3, 5e-3, 0.01, 0.05, 0.3]))
    try:
        if kind < 0.3:
            choose(
                instance, rng.choice(list(METHODS)), max_halvings=rng.integers(3), max_iterations=rng.choice([1, 30])
            )
        elif kind < 0.4 and z.n_switch:
            instance.set_switch(0, bool(rng.integers(2)))
        elif kind < 0.5 and z.nu:
            instance.set_input(0, rng.standard_normal())
        elif kind < 0.7:
            instance.step(h)
        else:
            n = int(rng.integers(1, 6))
            inputs = rng.standard_normal((n, z.nu)) if z.nu else None
            if z.nu and rng.random() < 0.4:
                inputs[rng.integers(n)] = np.nan
            instance.run(h, n, inputs, 2, np.empty((n // 2, z.ns)) if n > 1 else None)
    except KernelError as refusal:
        return refusal.status
    return 0


@pytest.mark.parametrize(
    "build",
    [lambda: sleigh(switch=True), lambda: branching(True), bricard.build],
    ids=["skate", "branching", "Bricard"],
)
def test_after_any_calls_three_instances_go_on_alike(build: Callable[[], Model]) -> None:
    """One that went the whole way, a fresh one and one that went another way before."""
    system = LoadedSystem(compile(build()).to_bytes())
    rng = np.random.default_rng(SEED)
    refused = 0
    for _ in range(20):
        three = [Instance(system) for _ in range(3)]
        for instance in three:
            instance.initialise()
        for _ in range(4):
            act(three[0], rng)
            act(three[2], rng)
        state = three[0].save()
        for other in three[1:]:
            other.restore(state)
        for _ in range(4):
            seed = int(rng.integers(1 << 30))
            statuses = {act(instance, np.random.default_rng(seed)) for instance in three}
            assert len(statuses) == 1
            assert len({instance.save() for instance in three}) == 1
            refused += statuses != {0}
    assert 2 < refused < 75
