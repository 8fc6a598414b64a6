"""Position problem and static equilibrium."""

import contextlib

import numpy as np
import pytest
from scipy.optimize import brentq

from mbs import compile
from mbs.kernel import binding
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.scenes import bricard

from .scenes import GRAVITY, four_bar, pendulum
from .system_builder import Element, Row, SystemBuilder, distance_row


def instance_of(builder: SystemBuilder) -> Instance:
    return Instance(LoadedSystem(builder.to_bytes()))


def test_the_nearest_point_is_that_of_the_mass() -> None:
    """1 kg along x and 3 kg along y from (-1.3, 0.9) to the circle: M (q - q0) + mu q = 0."""
    b = pendulum()
    b.mass, start = np.diag([1.0, 3.0]), np.array([-1.3, 0.9])
    instance = instance_of(b)
    instance.set_q(list(start), [0.0, 0.0])
    instance.initialise(0.0)
    mu = brentq(lambda x: np.hypot(*(start * [1.0, 3.0] / (np.array([1.0, 3.0]) + x))) - 1.0, 0.0, 10.0)
    expected = start * [1.0, 3.0] / (np.array([1.0, 3.0]) + mu)
    assert abs(np.cross([*expected, 0.0], [*start, 0.0])[2]) > 0.05  # not on the line to the centre
    np.testing.assert_allclose(instance.get_state()[0], expected, atol=1e-6)


def test_a_coordinate_without_mass_gives_way_like_one_of_the_mean_mass() -> None:
    """x - u = 1 from x = u = 0, where x has 2 kg and u none: both move by half a metre."""
    b = SystemBuilder(np.diag([2.0, 0.0]), [0.0, 0.0], rows=[Row(-1.0, {0: 1.0, 1: -1.0})])
    instance = instance_of(b)
    instance.initialise(0.0)
    np.testing.assert_allclose(instance.get_state()[0], [0.5, -0.5], atol=1e-9)


def test_the_residual_of_a_row_is_in_metres_for_any_mass() -> None:
    """x = 0 and x = 1 at once, for 1 kg and for 9: in the end each is open by half a metre."""
    for mass in (1.0, 9.0):
        instance = instance_of(SystemBuilder(np.diag([mass]), [0.2], rows=[Row(0.0, {0: 1.0}), Row(-1.0, {0: 1.0})]))
        with pytest.raises(KernelError):
            instance.initialise(0.0)
        assert instance.report()["violation"] == pytest.approx(0.5, rel=1e-6)


def test_a_start_knows_nothing_of_the_run_before_it() -> None:
    """Velocities off the rows, so that they are projected; after some steps the same start gives the same bits."""
    b = four_bar()
    q, qd = list(b.q0), [1.0, 0.3, 0.8, -0.2, 1.1, 0.4]
    fresh, used = instance_of(b), instance_of(b)
    used.initialise(0.0)
    for _ in range(20):
        used.step(0.01)
    for instance in (fresh, used):
        instance.set_q(q, qd)
        instance.initialise(0.0)
    assert [bytes(part) for part in used.get_state()] == [bytes(part) for part in fresh.get_state()]


def test_most_starts_a_third_of_a_metre_off_close() -> None:
    """Bricard's mechanism, whose rows depend on each other: a shortened step tells nothing about the multipliers. With
    those of it 43 of these starts close.
    """
    system = compile(bricard.build())
    loaded, rng = LoadedSystem(system.to_bytes()), np.random.default_rng(1)
    closed = 0
    for _ in range(60):
        instance = Instance(loaded)
        instance.set_q(system.arrays["q0"] + 0.3 * rng.normal(size=system.nq))
        with contextlib.suppress(KernelError):
            instance.initialise(0.0)
            closed += 1
    assert closed >= 50


def test_an_assembly_that_cannot_close_is_refused_with_its_worst_row() -> None:
    """A point cannot be 1 m from the origin, 1 m from (4, 0) and on y = 0 at once; the row of y is satisfied."""
    rows = [
        Row(0.0, {1: 1.0}),
        distance_row((0.0, 0.0), (0, 1), 1.0, True),
        distance_row((4.0, 0.0), (0, 1), 1.0, True),
    ]
    instance = instance_of(SystemBuilder(np.eye(2), [1.5, 0.0], rows=rows))
    before = bytes(instance.get_state()[0])
    with pytest.raises(KernelError) as refusal:
        instance.initialise(0.0)
    assert refusal.value.status == binding.Status.NOT_ASSEMBLED
    assert instance.report()["worst_row"] in (1, 2)
    assert instance.report()["violation"] > 0.1
    assert "open by" in refusal.value.message
    assert bytes(instance.get_state()[0]) == before


def test_a_pendulum_comes_to_hang() -> None:
    instance = instance_of(pendulum())
    instance.static_equilibrium(0.0, 1e-8, 300)
    q, qd, qdd, lam, _ = (np.array(v) for v in instance.get_state())
    np.testing.assert_allclose(q, [0.0, -1.0], atol=1e-8)
    np.testing.assert_allclose(qd, 0.0)
    np.testing.assert_allclose(qdd, 0.0, atol=1e-7)
    assert abs(lam[0]) == pytest.approx(GRAVITY, rel=1e-6)
    for _ in range(100):
        instance.step(0.01)
    np.testing.assert_allclose(instance.get_state()[0], [0.0, -1.0], atol=1e-7)


def test_a_mass_on_a_spring_sags_by_its_weight_and_keeps_its_free_direction() -> None:
    """A spring along y only (one signal): x is free and must stay."""
    b = SystemBuilder(np.diag([2.0, 2.0]), [0.3, 0.0], gravity=[0.0, -2.0 * GRAVITY])
    b.elements = [Element(2, [b.signal({1: 1.0})], [500.0, 10.0, 0.0, 0.0, 1.0, 1.0], outputs=1)]
    instance = instance_of(b)
    instance.static_equilibrium(0.0, 1e-9, 100)
    np.testing.assert_allclose(instance.get_state()[0], [0.3, -2.0 * GRAVITY / 500.0], atol=1e-11)


def test_no_equilibrium_is_refused_and_the_state_kept() -> None:
    b = SystemBuilder(np.eye(2), [0.0, 0.0], gravity=[0.0, -GRAVITY])
    instance = instance_of(b)
    instance.initialise(0.0)
    before = bytes(instance.get_state()[0])
    with pytest.raises(KernelError) as refusal:
        instance.static_equilibrium(0.0, 1e-6, 20)
    assert refusal.value.status == binding.Status.NOT_CONVERGED
    assert bytes(instance.get_state()[0]) == before


def test_a_torque_on_a_free_spin_does_not_spoil_the_equilibrium_of_the_rest() -> None:
    """Nothing balances the torque at rest: the spin is held while the sprung mass finds its place, then it is free."""
    torque, inertia = 3.0, 2.0
    b = SystemBuilder(np.diag([2.0, inertia]), [0.0, 0.7], gravity=[-2.0 * GRAVITY, 0.0])
    b.elements = [
        Element(2, [b.signal({0: 1.0})], [500.0, 10.0, 0.0, 0.0, 1.0, 1.0], outputs=1),
        Element(2, [b.signal({1: 1.0})], [0.0, 0.0, 0.0, torque, 1.0, 1.0], outputs=1),
    ]
    instance = instance_of(b)
    instance.static_equilibrium(0.0, 1e-9, 100)
    q, qd, qdd = (np.array(v) for v in instance.get_state()[:3])
    np.testing.assert_allclose(q, [-2.0 * GRAVITY / 500.0, 0.7], atol=1e-11)
    np.testing.assert_allclose(qd, 0.0)
    np.testing.assert_allclose(qdd, [0.0, torque / inertia], atol=1e-8)
