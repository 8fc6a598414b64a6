"""What the loader refuses of the flexible bodies in a System file."""

import numpy as np
import pytest

from mbs import compile
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.model import Model
from mbs.system.system import System
from tests.altered_system import altered, put
from tests.flexible_engine.bodies import cloud


@pytest.fixture(scope="module")
def system() -> System:
    m = Model("cloud")
    body = m.flexible_body("cloud", cloud())
    body.node("n2")
    return compile(m)


BAD = [
    ("flex_mode_ptr", lambda v: v[:-1], "'flex_mode_ptr'"),
    ("flex_mode_ptr", put(1, 4), "'flex_mode_ptr' runs"),
    ("flex_frame", lambda v: v[:-1], "'flex_frame' has 11 items instead of 12"),
    ("flex_frame", put(0, 1000), "'flex_frame'"),
    ("flex_frame", lambda v: np.roll(v, 1), "is not in front"),
    ("flex_mode", lambda v: v[::-1].copy(), "is not in front"),
    ("flex_front", put(0, -1), "'flex_front'"),
    ("flex_loc", put(0, 10_000), "is not in front"),
    ("flex_loc", lambda v: v[:-1], "'flex_loc'"),
    ("flex_gravity", lambda v: v[:2], "'flex_gravity'"),
    ("flex_P", lambda v: v[:-1], "'flex_P'"),
    ("flex_c", lambda v: v[:-1], "'flex_c'"),
    ("flex_T", lambda v: v[:-1], "'flex_T'"),
    ("flex_K", lambda v: v[:-1], "'flex_K'"),
    ("flex_K", put(1, 1e9), "'flex_K' of flexible body 0 is not symmetric"),
    ("flex_C", put(1, 1e9), "'flex_C' of flexible body 0 is not symmetric"),
    ("flex_T", put(1, 1e9), "'flex_T' of flexible body 0 is not symmetric"),
    ("flex_K", put(0, np.nan), "is not a finite number"),
]


@pytest.mark.parametrize(("name", "change", "text"), BAD, ids=[f"{n}-{k}" for k, (n, _, _) in enumerate(BAD)])
def test_refused(system: System, name: str, change: object, text: str) -> None:
    with pytest.raises(KernelError) as caught:
        LoadedSystem(altered(system, **{name: change}))
    assert text in str(caught.value)


def test_a_body_without_modes_is_refused(system: System) -> None:
    empty = {"flex_mode_ptr": lambda v: np.array([0, 0])}
    for name in ("flex_mode", "flex_P", "flex_c", "flex_T", "flex_K", "flex_C"):
        empty[name] = lambda v: v[:0]
    empty["flex_loc"] = lambda v: v[:12]
    with pytest.raises(KernelError, match="has no modes"):
        LoadedSystem(altered(system, **empty))


def test_a_saved_state_continues_bit_for_bit(system: System) -> None:
    loaded = LoadedSystem(system.to_bytes())
    one, two = Instance(loaded), Instance(loaded)
    one.initialise()
    one.run(0.01, 20)
    two.restore(one.save())
    one.run(0.01, 20)
    two.run(0.01, 20)
    assert one.save() == two.save()


def test_altered_integers_never_crash(system: System) -> None:
    """Every integer of the flexible arrays changed at random: refused, or harmless."""
    rng = np.random.default_rng(7)
    for name in ("flex_mode_ptr", "flex_frame", "flex_mode", "flex_front", "flex_loc"):
        for index in range(len(system.arrays[name])):
            data = altered(system, **{name: put(index, int(rng.integers(-3, 200)))})
            try:
                instance = Instance(LoadedSystem(data))
                instance.initialise()
                instance.run(0.01, 2)
            except KernelError:
                continue
