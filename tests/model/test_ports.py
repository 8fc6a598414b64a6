"""Ports of a rigid body: forces of joints and springs there, quasi-static outputs, and what is refused."""

import numpy as np
import pytest

from mbs import Model, ModelError, Simulation, compile
from mbs.flexible import InertiaRelief

LEFT = (-1.0, 0.0, 0.0)  # m
RIGHT = (2.0, 0.0, 0.0)  # m
MASS = 6.0  # kg
GRAVITY = 9.81


def relief(n_ports=2, outputs=15):
    """Output k is the k-th of: forces in body axes, s, and W row by row."""
    weights = np.eye(3 * n_ports + 12)[:outputs]
    f = 3 * n_ports
    return InertiaRelief(weights[:, :f], weights[:, f : f + 3], weights[:, f + 3 :], weights[:, :f], np.zeros((6, f)))


def beam(outputs=18):
    """A beam on a ball joint at the left and a vertical spring at the right; a quasi-static output per load."""
    m = Model("beam")
    body = m.body("beam", mass=MASS, com=(0.0, 0.0, 0.0), inertia=(0.1, 4.0, 4.0))
    ports = m.ported(body, {"left": LEFT, "right": RIGHT})
    m.spherical("ball", m.ground, ports, point=LEFT)
    stiffness, length = 1e5, 0.5
    pull = MASS * GRAVITY / 3.0  # at the right: 1 m to the centre of mass from the left, 3 m to the spring
    m.spring_damper(
        "spring",
        (ports, RIGHT),
        (m.ground, (2.0, 0.0, length)),
        stiffness=stiffness,
        free_length=length - pull / stiffness,
    )
    for k in range(outputs):
        m.sense_quasi_static(f"out{k}", ports, relief(2, outputs), k, LEFT)
    m.sense_position("az", body, RIGHT, "z", body, order=2)
    return m


def outputs(simulation):
    return np.array([simulation.sensors[f"out{k}"] for k in range(18)])


def test_forces_at_the_ports_are_those_of_joint_and_spring():
    actual = outputs(Simulation(compile(beam())))
    weight = MASS * GRAVITY
    np.testing.assert_allclose(actual[:6], [0, 0, 2 * weight / 3, 0, 0, weight / 3], rtol=0, atol=1e-6)
    np.testing.assert_allclose(actual[6:9], [0, 0, GRAVITY], rtol=0, atol=1e-6)  # s = A'(rdd - g)
    np.testing.assert_allclose(actual[9:], 0.0, atol=1e-6)


def test_motion_enters_in_body_axes():
    m = beam()
    m.initial_velocity(m.bodies[0], (0.0, 0.0, -0.5), (0.0, 0.5, 0.0))
    simulation = Simulation(compile(m))
    simulation.step(1e-3, 300)
    actual = outputs(simulation)
    W = actual[9:].reshape(3, 3)
    arm = np.subtract(RIGHT, LEFT)
    # the ball joint rests: s is -g in body axes, and W carries the acceleration of the other end
    assert (W @ arm)[2] == pytest.approx(simulation.sensors["az"], rel=1e-6)
    assert np.linalg.norm(actual[6:9]) == pytest.approx(GRAVITY, rel=1e-6)
    assert np.abs(W).max() > 0.1
    # Newton: forces at the ports in body axes balance the specific acceleration of the centre of mass
    total = actual[:3] + actual[3:6]
    np.testing.assert_allclose(total, MASS * (actual[6:9] + W @ np.array([1.0, 0.0, 0.0])), rtol=0, atol=1e-5)


def test_invalid_values_at_ports_are_refused():
    m = Model("m")
    body = m.body("b", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    with pytest.raises(ModelError, match="Ports belong to a rigid body in space, not to 'ground'"):
        m.ported(m.ground, {"p": LEFT})
    ports = m.ported(body, {"p": LEFT})
    with pytest.raises(ModelError, match="needs a body with ports, not 'b'"):
        m.sense_quasi_static("s", body, relief(1, 3), 0, LEFT)
    with pytest.raises(ModelError, match="needs matrices of 1 interfaces"):
        m.sense_quasi_static("s", ports, relief(2, 3), 0, LEFT)


def test_points_of_a_small_body_are_not_taken_for_its_ports():
    for size in (1e-5, 100.0):
        offset = np.array([0.3, -0.2, 0.1])
        body = Model("small").body("beam", mass=1.0, com=offset, inertia=np.full(3, size**2))
        end = offset + np.array([size, 0.0, 0.0])
        ports = body.model.ported(body, {"end": end, "centre": offset})
        beside = offset + np.array([1.01 * size, 0.0, 0.0])
        assert ports.point(end + 1e-15).components == ports.point(end).components
        assert ports.point(offset + 1e-15).components == ports.point(offset).components
        assert ports.point(beside).components == body.point(beside).components != ports.point(end).components


def test_what_is_added_later_has_no_model_with_ports():
    m = Model("grows")
    m.with_ports = lambda: m
    assert m.with_ports() is m
    m.input("u")
    assert m.with_ports is None
