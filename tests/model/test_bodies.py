"""Bodies in natural coordinates: the constant mass matrix is that of a rigid body."""

import copy
import pickle

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbs import Model, ModelError, compile, simulate

ROUND_OFF = 1e-12


def spatial_body(inertia=(0.3, 0.5, 0.6)):
    m = Model("one body")
    return m, m.body("plate", mass=2.5, com=(0.4, -0.3, 1.2), inertia=inertia)


def test_mass_matrix_gives_the_kinetic_energy_of_a_rigid_body():
    rng = np.random.default_rng(1)
    A = rng.normal(size=(3, 3))
    second = A @ A.T
    inertia = np.trace(second) * np.eye(3) - second  # from a mass distribution, so physically possible
    _, body = spatial_body(inertia)
    for _ in range(5):
        R = Rotation.random(random_state=rng).as_matrix()
        v, w = rng.normal(size=3), rng.normal(size=3)
        q = np.concatenate([rng.normal(size=3), *R.T])
        qd = body.velocity(v, w, q)
        expected = 0.5 * 2.5 * v @ v + 0.5 * w @ (R @ inertia @ R.T) @ w
        assert 0.5 * qd @ body.mass_block() @ qd == pytest.approx(expected, rel=ROUND_OFF)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_mass_added_off_centre_moves_with_the_body(dimension):
    """Kinetic energy of the body and of a particle fixed to it, against the sum of both."""
    m = Model("two in one", dimension=dimension)
    com, place = np.array([0.1, 0.2, 0.3])[:dimension], np.array([0.5, -0.1, 0.7])[:dimension]
    body = m.body("carrier", mass=2.0, com=com, inertia=0.3 if dimension == 2 else (0.3, 0.4, 0.5))
    alone = body.mass_block()
    body.add_mass(1.2, place, np.zeros((3, 3)))
    rng = np.random.default_rng(2)
    q = body.reference()
    v = rng.normal(size=dimension)
    w = rng.normal(size=1 if dimension == 2 else 3)
    qd = body.velocity(v, w, q)
    arm = place - com
    turn = w[0] * np.array([-arm[1], arm[0]]) if dimension == 2 else np.cross(w, arm)
    expected = 0.5 * qd @ alone @ qd + 0.5 * 1.2 * (v + turn) @ (v + turn)
    assert 0.5 * qd @ body.mass_block() @ qd == pytest.approx(expected, rel=ROUND_OFF)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"mass": -1.0}, "mass of body 'x' is -1; it must be greater than zero"),
        ({"inertia": (1.0, 1.0, 2.5)}, "greater than the sum of the others"),
        ({"inertia": (1.0, 1.0, -0.1)}, "principal value -0.1"),
        ({"inertia": (1.0, 1.0, 1e-16)}, "beside 1; all must be greater than zero, and than its round-off"),
        ({"inertia": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}, "not symmetric"),
    ],
)
def test_impossible_bodies_are_refused_by_name(given, sentence):
    data = {"mass": 1.0, "com": (0.0, 0.0, 0.0), "inertia": (1.0, 1.0, 1.0), **given}
    with pytest.raises(ModelError, match="'x'") as error:
        Model("refusals").body("x", **data)
    assert sentence in str(error.value)


def test_names_are_unique_and_not_empty():
    m, _ = spatial_body()
    with pytest.raises(ModelError, match="already has a body named 'plate'"):
        m.body("plate", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    with pytest.raises(ModelError, match="not empty"):
        m.point_mass(" ", mass=1.0, position=(0, 0, 0))


def test_a_body_of_another_model_is_refused():
    m, body = spatial_body()
    with pytest.raises(ModelError, match="belongs to model"):
        m.spherical("ball", body, spatial_body()[1], point=(0, 0, 0))


def test_gravity_may_be_changed():
    model = Model("moon", dimension=2)
    model.gravity = (0, -1.62)
    body = model.body("stone", mass=2.0, com=(0.0, 0.0), inertia=0.1)
    model.sense_position("height", body, (0.0, 0.0), "y", description="Height of the stone")
    run = simulate(compile(model), 1.0, 0.01)
    assert run["height"][-1] == pytest.approx(-0.81, abs=1e-9)


def test_a_model_is_not_copied_its_system_is():
    m, _ = spatial_body()
    for copied in (pickle.dumps, copy.deepcopy, copy.copy):
        with pytest.raises(TypeError, match="Model 'one body' cannot be copied or pickled: its parts hold functions"):
            copied(m)
        assert copied(compile(m))
