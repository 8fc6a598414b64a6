"""Flexible bodies in a model: interfaces, counts of coordinates, and one sentence for invalid ones."""

from dataclasses import replace

import numpy as np
import pytest

from mbs import Settings, compile
from mbs.flexible.reduced_body import ReducedBody
from mbs.model import Model, ModelError
from mbs.model.flexible import FlexibleBody
from mbs.simulation.stepping import Simulation
from tests.flexible_engine.bodies import bar, cloud
from tests.kernel.sensor_rates import rates_of


def _beam(m: Model, **place: object) -> FlexibleBody:
    return m.flexible_body("beam", bar((0, 0, 0), (1, 0, 0), dynamic=2), **place)  # type: ignore[arg-type]


def test_coordinates_and_rows() -> None:
    """12 + modes coordinates and 6 rows; 3 + 3 for a point, its rotation and each vector; none for the reference."""
    m = Model("count")
    beam = _beam(m)
    system = compile(m)
    assert (system.nq, system.nc) == (12 + 8, 6)
    beam.node("0")
    beam.interface("0").vector((0, 1, 0))
    assert len(m.coordinates) == 12 + 8
    beam.point((1, 0, 0))
    beam.node("8")
    assert len(m.coordinates) == 12 + 8 + 3
    beam.interface(8).vector((0, 1, 0))
    beam.interface(8).vector((0, 1, 0))
    assert len(m.coordinates) == 12 + 8 + 3 + 6
    system = compile(m)
    assert (system.nq, system.nc) == (12 + 8 + 9, 6 + 9)
    assert system.report["rank"] == 15


def with_interface() -> ReducedBody:
    """Random shapes but for those of node 3, whose three coordinates are amplitudes."""
    reduced = cloud()
    shapes = reduced.node_translations.copy()
    shapes[3] = np.eye(3, reduced.n_modes)
    weighted = (np.sqrt(reduced.masses)[:, None, None] * shapes).reshape(-1, reduced.n_modes)
    return replace(
        reduced,
        node_translations=shapes,
        mass_shapes=shapes,
        modes=shapes.reshape(-1, reduced.n_modes),
        M=weighted.T @ weighted,
    )


def _watched(node_first: bool, reduced: ReducedBody | None = None) -> Simulation:
    """A body that turns and bends, its node 3 in earth axes, in its own and in those of another body, all orders."""
    m = Model("watched")
    body = m.flexible_body("cloud", reduced or cloud())
    m.initial_velocity(body, (0.1, 0.2, 0.3), (1.0, 2.0, 3.0))
    place = body.node_positions[3]
    other = m.body("other", mass=1.0, com=(2.0, 0, 0), inertia=(0.1, 0.2, 0.25))
    m.initial_velocity(other, (0, 0, 0), (0.5, 0, -1.0))
    if node_first:
        body.node(3)
    for order in range(3):
        for c in "xyz":
            m.sense_position(f"earth {order} {c}", body, place, c, order=order)
            m.sense_position(f"node {order} {c}", body.interface(3), None, c, body.frame, order=order)
            m.sense_position(f"other {order} {c}", body, place, c, other, order=order)
    simulation = Simulation(compile(m), settings=Settings(tolerance_r=1e-13))
    simulation.step(1e-4, 400)
    return simulation


@pytest.mark.parametrize("reduced", [cloud(), with_interface()], ids=["cloud", "interface"])
def test_a_node_is_read_without_coordinates(reduced: ReducedBody) -> None:
    """Place, velocity and acceleration are those of the node that has coordinates; the rows of an interface have
    entries of one term."""
    alone, node = _watched(False, reduced), _watched(True, reduced)
    assert alone.system.nq == node.system.nq - 3
    for name, value in node.sensors.items():
        assert alone.sensors[name] == pytest.approx(value, rel=1e-6, abs=1e-7), name
    assert max(abs(alone.sensors[f"node 2 {c}"]) for c in "xyz") > 1.0


@pytest.mark.parametrize("node_first", [False, True])
def test_rates_of_a_node_are_known(node_first: bool) -> None:
    """Of places and velocities, against differences; those of accelerations are not."""
    simulation, h = _watched(node_first), 1e-6
    names = [s["name"] for s in simulation.system.meta["sensors"]]
    rates, known = rates_of(simulation.instance)
    before = dict(simulation.sensors)
    simulation.step(h)
    for name, rate, is_known in zip(names, rates, known, strict=True):
        order = int(name.split()[1])
        assert bool(is_known) == (order < 2)
        if order < 2:
            assert rate == pytest.approx((simulation.sensors[name] - before[name]) / h, rel=1e-3, abs=1e-3), name


def test_place_and_axes_of_the_finite_element_model() -> None:
    """Turned into the drawing, the same body falls to the same places."""
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    places = []
    for axes, origin in ((np.eye(3), np.zeros(3)), (turn, np.array([2.0, 1.0, 0.5]))):
        m = Model("placed")
        body = m.flexible_body("cloud", cloud(), origin=origin, axes=axes)
        m.initial_velocity(body, axes @ (0.1, 0.2, 0.3), axes @ (1.0, 2.0, 3.0))
        for k in "xyz":
            m.sense_position(k, body, body.node_positions[3], k)
        simulation = Simulation(compile(m))
        simulation.step(0.002, 100)
        seen = np.array([simulation.sensors[k] for k in "xyz"])
        places.append(axes.T @ (seen - origin))
    np.testing.assert_allclose(places[1], places[0], atol=1e-9)


def test_initial_velocity_is_that_of_the_centre_of_mass() -> None:
    m = Model("moving", gravity=(0, 0, 0))
    body = m.flexible_body("cloud", cloud())
    m.initial_velocity(body, (1.0, 2.0, 3.0), (0.5, -1.0, 2.0))
    m.sense_energy("kinetic", "kinetic")
    reduced, v, w = body.reduced, np.array([1.0, 2.0, 3.0]), np.array([0.5, -1.0, 2.0])
    arms = reduced.mass_positions - reduced.masses @ reduced.mass_positions / reduced.masses.sum()
    expected = 0.5 * np.sum(reduced.masses * np.sum((v + np.cross(w, arms)) ** 2, axis=1))
    assert Simulation(compile(m)).sensors["kinetic"] == pytest.approx(expected, rel=1e-12)


def test_recovery_and_amplitude_sensors() -> None:
    m = Model("sensors")
    beam = _beam(m)
    weights = np.arange(8.0)
    m.sense_coordinate("moment", beam.combination(weights), unit="N m")
    for j in range(8):
        m.sense_coordinate(f"a{j}", beam.amplitude(j))
    m.weld("root", m.ground, beam.interface(0))
    simulation = Simulation(compile(m))
    simulation.step(0.01, 10)
    amplitudes = np.array([simulation.sensors[f"a{j}"] for j in range(8)])
    assert np.max(np.abs(amplitudes)) > 1e-6
    assert simulation.sensors["moment"] == pytest.approx(weights @ amplitudes, rel=1e-12)


def test_floating_scene_starts_anywhere() -> None:
    m = Model("floating", gravity=(0, 0, 0))
    m.floating = True
    beam = _beam(m)
    m.sense_position("x", beam, (1, 0, 0), "x")
    m.sense_position("y", beam, (1, 0, 0), "y")
    m.sense_position("v", beam, (1, 0, 0), "y", order=1)
    simulation = Simulation(compile(m))
    simulation.instance.set_pose(1000.0, -500.0, 2.0, np.pi / 2, 3.0)
    simulation.instance.initialise(0.0)
    simulation.step(0.01, 100)
    assert simulation.sensors["x"] == pytest.approx(1000.0, abs=1e-9)
    assert simulation.sensors["y"] == pytest.approx(-499.0 + 3.0, abs=1e-9)
    assert simulation.sensors["v"] == pytest.approx(3.0, abs=1e-9)


BAD = [
    (lambda m, b: b.interface("tip"), "has no node 'tip'; its interfaces are: 8"),
    (lambda m, b: b.interface(99), "has the nodes 0 to 8, not 99"),
    (lambda m, b: b.point((0.3, 0.1, 0)), "the nearest is '2', 0.112 m away"),
    (lambda m, b: b.amplitude("yaw"), "has no mode 'yaw'"),
    (lambda m, b: b.amplitude(8), "has the modes 0 to 7, not 8"),
    (lambda m, b: b.combination([1.0]), "shape (1,)"),
    (lambda m, b: b.add_mass(3.0, np.zeros(3), np.eye(3)), "cannot take a mass of 3 kg"),
    (lambda m, b: m.weld("w", m.ground, b), "needs an axis of flexible body 'beam': name the node"),
    (lambda m, b: m.initial_velocity(b.interface(8), (1, 0, 0)), "cannot have an initial velocity of its own"),
    (lambda m, b: m.flexible_body("b2", 3), "needs a ReducedBody, got int"),
    (lambda m, b: m.flexible_body("b2", cloud(), axes=2 * np.eye(3)), "columns of a rotation matrix"),
]


@pytest.mark.parametrize(("action", "text"), BAD, ids=[text for _, text in BAD])
def test_refusals(action: object, text: str) -> None:
    m = Model("bad")
    beam = _beam(m)
    with pytest.raises(ModelError) as caught:
        action(m, beam)  # type: ignore[operator]
    assert text in str(caught.value)


def test_planar_models_have_no_flexible_bodies() -> None:
    with pytest.raises(ModelError, match="needs a spatial model"):
        Model("flat", dimension=2).flexible_body("b", cloud())
