"""Bodies and numbers by table, against the joints they stand for, closed forms and conservation laws."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbs import Model, Simulation, SimulationError, System, Trajectory, compile, simulate
from mbs.common.errors import ModelError
from mbs.elements import ScalarSpringDamper
from mbs.kernel import binding
from mbs.kernel.binding import KernelError
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import Status
from mbs.model.body import Body
from tests.kernel.sensor_rates import RATE_ERROR, rates_of, slopes_of
from tests.model.table_models import (
    ELBOW,
    WATCHED,
    Array,
    arm_by_table,
    base_of,
    coupled,
    number_model,
    one_by_joint,
    one_by_table,
    two_by_joints,
    two_by_table,
)


def gap(one: Trajectory, other: Trajectory, names: tuple[str, ...] = WATCHED) -> float:
    return max(float(np.abs(one[n] - other[n]).max()) for n in names)


@pytest.mark.parametrize(("table", "joint"), [(one_by_table, one_by_joint), (two_by_table, two_by_joints)])
def test_tables_move_as_the_joints_they_are_made_of(table: Any, joint: Any) -> None:
    """Places, velocities, accelerations, spring and energy by a rule of order eight: what is left is the table's."""
    system, linked = table(), joint()
    one, other = (simulate(s, 0.6, 0.002, method="runge_kutta_8") for s in (system, linked))
    report = system.meta["report"]
    assert report["rows"] == 6  # of the base, which are all
    assert gap(one, other, WATCHED[:3]) < 2e-6
    assert gap(one, other, WATCHED[3:6]) < 2e-5
    assert gap(one, other, WATCHED[6:]) < 2e-3  # second derivatives of the table
    assert gap(one, other, ("kinetic", "total", "spring")) < 2e-5


def test_the_error_falls_with_the_fourth_power_of_the_spacing() -> None:
    exact = simulate(one_by_joint(), 0.5, 0.002, method="runge_kutta_8")
    errors = [
        gap(simulate(one_by_table(n), 0.5, 0.002, method="runge_kutta_8"), exact, WATCHED[:3]) for n in (19, 37, 73)
    ]
    orders = [np.log2(coarse / fine) for coarse, fine in pairwise(errors)]
    assert np.mean(orders) == pytest.approx(4.0, abs=0.5)


def test_the_work_of_a_damper_is_the_loss_of_energy() -> None:
    """Displacements on lookup-table bodies are right to second order: the difference falls with the step squared."""
    system, errors = two_by_table(damping=8.0), []
    for h in (0.01, 0.005, 0.0025):
        run = simulate(system, 0.5, h, method="ali3p")
        assert run["work"][-1] < -0.1
        errors.append(abs(float(run["total"][-1] - run["total"][0] - run["work"][-1])))
    assert np.log2(errors[0] / errors[2]) / 2.0 == pytest.approx(2.0, abs=0.4)


def tangent(instance: Instance, q: Array, qd: Array, h: float) -> Array:
    """At these coordinates and rates, without multipliers."""
    instance.set_q(q.tolist(), qd.tolist())
    instance.initialise()
    return np.reshape(instance.tangent(h, [0.0] * instance.system.sizes.nc), (len(q), len(q)))


def on_its_way(system: System) -> Simulation:
    simulation = Simulation(system)
    for _ in range(20):
        simulation.step(0.01)
    return simulation


@pytest.mark.parametrize(
    "system",
    [
        two_by_table,
        lambda: two_by_table(beside=True),
        lambda: compile(coupled(whole=False)),
        lambda: compile(coupled(whole=True)),
    ],
    ids=["a spring", "beside", "by vectors", "whole"],
)
def test_the_tangent_is_that_of_differences(system: Callable[[], System]) -> None:
    """Springs, forces that turn, weight and bends of tables are in K, whose symmetric part the tangent has."""
    simulation, shift = on_its_way(system()), 1e-6
    instance, q = simulation.instance, np.array(simulation.state.q)
    still = np.zeros_like(q)
    long, short = (tangent(instance, q, still, h) for h in (0.2, 0.1))  # M + h^2/4 K + what h does not change

    def force(at: Array) -> Array:
        return np.array(instance.evaluate(at.tolist(), still.tolist(), [], 0.0)["force"])

    K = np.array([(force(q - d) - force(q + d)) / (2.0 * shift) for d in shift * np.eye(len(q))])
    results = (long - short) / (0.25 * (0.2**2 - 0.1**2))
    assert np.abs(results - 0.5 * (K + K.T)).max() < 1e-6 * np.abs(K).max()


def test_sums_by_vectors_and_numbers_are_those_of_the_whole() -> None:
    """In motion, where a lift and gyroscopic moments couple vectors of a body with each other and with a spin."""
    simulation, other = on_its_way(compile(coupled(whole=False))), Simulation(compile(coupled(whole=True)))
    q, qd = np.array(simulation.state.q), np.array(simulation.state.qd)
    one, two = (tangent(s.instance, q, qd, 0.1) for s in (simulation, other))
    assert np.abs(one - two).max() < 1e-13 * np.abs(one).max()


def test_a_spring_on_a_number_pulls_along_its_slope() -> None:
    """2 s'' = -3 s^2 2 s: cubic splines have squares without an error."""
    run = simulate(compile(number_model(np.linspace(-2.0, 2.0, 9))), 2.0, 0.005, method="runge_kutta_8")
    exact = solve_ivp(lambda t, y: [y[1], -3.0 * y[0] ** 3], (0, 2), [0.0, 1.0], rtol=1e-11, atol=1e-12, t_eval=run.t)
    assert np.abs(run["s"] - exact.y[0]).max() < 1e-8
    assert np.abs(run["square"] - exact.y[0] ** 2).max() < 1e-8
    assert np.abs(run["square.rate"] - 2.0 * exact.y[0] * exact.y[1]).max() < 1e-7
    assert np.ptp(run["total"]) < 1e-8


def test_beyond_its_table_a_number_is_extrapolated_along_the_tangent() -> None:
    m = number_model(np.linspace(-0.2, 0.2, 5))
    run = simulate(compile(m), 0.295, 0.001)
    s = run["s"]
    assert s.max() > 0.28
    inside, outside = s <= 0.2, s > 0.2
    assert np.abs(run["square"] - s**2)[inside].max() < 1e-12
    assert np.abs(run["square"] - (0.04 + 0.4 * (s - 0.2)))[outside].max() < 1e-12
    number = m.lookup_tables[-1]
    assert number.table.value(0.45)[0] == pytest.approx(0.04 + 0.4 * 0.25, abs=1e-12)


def test_rates_of_sensors_are_those_of_the_run() -> None:
    instance = Instance(binding.LoadedSystem(two_by_table().to_bytes()))
    instance.set_settings(tolerance_r=1e-13, tolerance_phi=1e-12)
    instance.initialise()
    instance.run(0.002, 50)
    actual, chosen = rates_of(instance)
    assert chosen.sum() > 20
    assert np.allclose(actual[chosen], slopes_of(instance)[chosen], rtol=RATE_ERROR, atol=RATE_ERROR)


def wrong(**changed: Any) -> None:
    m = Model("wrong")
    base = m.body("base", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    points = np.linspace(-1.0, 1.0, 9)
    arguments: dict[str, Any] = {
        "base": base,
        "parameters": m.travel("s"),
        "axes": [points],
        "places": np.column_stack([points, 0 * points, 0 * points]),
        "rotations": np.broadcast_to(np.eye(3), (9, 3, 3)),
        "mass": 1.0,
        "com": (0, 0, 0),
        "inertia": (1, 1, 1),
    }
    before = len(m.coordinates)
    try:
        m.tabled_body("part", **arguments | changed)
    finally:
        assert not m.lookup_tables
        assert len(m.coordinates) == before


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        (
            {"com": (0.0, 0.1, 0.0)},
            "The table of lookup-table body 'part' is off the drawing by 0.1 where its coordinates",
        ),
        ({"axes": [np.geomspace(1.0, 2.0, 9)]}, "9 points; they must be 4 or more, rising and equally spaced"),
        ({"axes": [np.linspace(-1, 1, 8)]}, "has shape (9, 12); it must be numbers of shape (8, 12)"),
        ({"rotations": np.full((9, 3, 3), 0.5)}, "must be rotation matrices"),
    ],
)
def test_a_table_that_cannot_be_is_a_sentence_and_changes_nothing(changed: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as error:
        wrong(**changed)
    assert sentence in str(error.value)


def test_joints_and_methods_that_have_no_tables_are_refused() -> None:
    m = Model("refused")
    base = base_of(m)
    arm = arm_by_table(m, base, m.travel("swing"), np.linspace(-1.0, 1.0, 21))
    m.distance("rod", (arm, ELBOW), (m.ground, (0.0, 0.0, -3.0)))
    with pytest.raises(ModelError, match="'rod' is on a lookup-table body, which accepts forces and sensors but"):
        compile(m)
    system = one_by_table(25)
    for method in ("energy_momentum", "radau_5", "semi_recursive"):
        with pytest.raises((KernelError, ModelError, ValueError, RuntimeError)):
            simulate(system, 0.1, 0.01, method=method)


def test_a_step_from_far_beyond_a_table_is_refused() -> None:
    simulation = Simulation(compile(number_model(np.linspace(-0.2, 0.2, 9))))
    for _ in range(251):
        simulation.step(0.001)
    with pytest.raises(SimulationError) as error:
        simulation.step(0.001)
    assert error.value.status == Status.BEYOND_TABLE
    assert 0.25 < simulation.state.q[3] < 0.252
    message = "a coordinate has left the range of its table. 's' is 0.25"
    assert message in str(error.value)
    assert "its table goes from -0.2 to 0.2" in str(error.value)


def hinged(tabled: bool) -> System:
    """A light body hinged on a heavy one; a third slides along it, by joints or by a table."""
    m = Model("hinged")
    heavy = m.body("heavy", mass=50.0, com=(0, 0, 0), inertia=(5.0, 6.0, 7.0))
    m.initial_velocity(heavy, (0, 0, 0), (0, 0, 0))
    along = np.linspace(-0.4, 0.4, 9)
    table: dict[str, Any] = {
        "axes": [along],
        "places": [[0.0, 1.0, z] for z in along],
        "rotations": np.tile(np.eye(3), (9, 1, 1)),
        "com": (0, 1, 0),
    }
    if tabled:  # dependents come first, and neither end of the hinge is eliminated
        slide = m.travel("slide")
        m.tabled_body("beside", base=heavy, parameters=slide, mass=1e-9, inertia=(1e-9, 1e-9, 1e-9), **table)
    light = m.body("light", mass=0.01, com=(0, 1, 0), inertia=(1e-4, 1e-4, 1e-4))
    m.revolute("hinge", heavy, light, point=(0.1, 1.0, 0.4), axis=(1, 0, 0))
    m.spring_damper("hinge spring", (heavy, (0, 0, 1.0)), (light, (0, 1, 1.0)), stiffness=2e3, free_length=0.8)
    end: Body
    part: dict[str, Any] = {"mass": 8.0, "inertia": (0.3, 0.4, 0.2)}
    if tabled:
        end = m.tabled_body("end", base=light, parameters=slide, **part, **table)
        m.add(ScalarSpringDamper(900.0, 3.0, 0.1, unit="N").record("spring", slide.affine))
    else:
        end = m.body("end", com=(0, 1, 0), **part)
        m.prismatic("slide", light, end, point=(0, 1, 0), axis=(0, 0, 1))
        m.spring_damper(
            "spring", (light, (0, 1, -5.0)), (end, (0, 1, 0)), stiffness=900.0, damping=3.0, free_length=5.1
        )
    wheel = m.spin(
        "wheel",
        carrier=end,
        centre=(0, 1.1, 0),
        axis=(0, 1, 0),
        mass=2.0,
        spin_inertia=0.1,
        diametral_inertia=0.06,
        rolling_radius=0.3,
    )
    m.initial_rate(wheel, 40.0)
    for c in "xyz":
        m.sense_position(f"end.{c}", end, (0.0, 1.3, 0.2), c)
    return compile(m)


def test_a_base_may_be_hinged_on_another_and_carry_a_wheel() -> None:
    """Rows of joints between bodies that carry tables are those of the same mechanism with joints; it can be drawn."""
    table, joints = (simulate(hinged(tabled), 0.4, 0.0005, progress=False) for tabled in (True, False))
    for c in "xyz":
        np.testing.assert_allclose(table[f"end.{c}"], joints[f"end.{c}"], rtol=0, atol=1e-5)
        assert np.ptp(joints[f"end.{c}"]) > 0.01
    assert hinged(tabled=True).drawing
