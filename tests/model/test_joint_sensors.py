"""Forces of driven distances and of lines that turn, moments of joints: closed forms at rest and in motion, by every
method, and Newton's and Euler's laws of the body they act on.
"""

from math import sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly
from scipy.spatial.transform import Rotation

from mbs import Model, ModelError, Simulation, compile, simulate
from tests.flexible_engine.bodies import bar

G = 9.81
RISE = PPoly(np.array([[6.0], [-15.0], [10.0], [0.0], [0.0], [0.0]]), np.array([0.0, 1.0]))
SECOND, HIGH = (
    ("ali3p", "ali3p_generalised_alpha", "energy_momentum"),
    ("energy_momentum_4", "runge_kutta_8", "radau_5"),
)
NATURAL = [*SECOND, *HIGH]
TREE = ("semi_recursive", "semi_recursive_4")
DIGITS = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.02}


def bound(method, scale):
    """Error at 2 ms: 1e-4 of the size by methods of second order, 1e-7 by others."""
    return scale * (1e-4 if method in SECOND else 1e-7)


def shifted(low, high):
    """From `low` to `high` along RISE."""
    c = (high - low) * RISE.c
    c[-1] += low
    return PPoly(c, RISE.x)


# --- driven distance ---
@pytest.mark.parametrize("method", NATURAL)
def test_the_tension_of_a_pendulum_whose_length_is_driven(method):
    mass, length = 1.5, shifted(1.0, 0.6)
    m = Model("winch", dimension=2)
    bob = m.point_mass("bob", mass=mass, position=(1.0, 0.0))
    m.drive("rope", ((m.ground, (0.0, 0.0)), bob), m.guide_time("length", length, unit="m"))
    m.sense_joint("tension", "rope", "tension")
    m.sense_joint("push", "rope", "drive")
    run = simulate(compile(m), 0.9, 0.002, method=method, every=50)

    def rates(t, x):
        return [x[1], -(2.0 * length(t, 1) * x[1] + G * sin(x[0])) / length(t)]

    angle, rate = solve_ivp(rates, (0.0, 0.9), [0.5 * np.pi, 0.0], t_eval=run.t, **DIGITS).y
    expected = mass * (length(run.t) * rate**2 + G * np.cos(angle) - length(run.t, 2))
    assert np.abs(run["tension"] - expected).max() < bound(method, np.abs(expected).max())
    assert (run["push"] == -run["tension"]).all()


# --- a line that turns ---
def bead():
    """A bead on a straight wire that a driving function turns."""
    m = Model("bead", dimension=2)
    wire = m.body("wire", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    m.revolute("bearing", m.ground, wire, point=(0.0, 0.0))
    mass = m.point_mass("bead", mass=0.7, position=(0.4, 0.0))
    m.point_on_line("wire", (mass, None), (wire, (0.0, 0.0)), axis=(1.0, 0.0))
    m.drive("motor", m.relative_angle("angle", m.ground, wire), m.guide_time("turn", shifted(0.0, 1.5), unit="rad"))
    for c in "xy":
        m.sense_joint(f"force.{c}", "wire", c)
    return compile(m)


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum_4"])
def test_the_force_of_a_wire_that_turns(method):
    turn = shifted(0.0, 1.5)
    run = simulate(bead(), 0.9, 0.002, method=method, every=50)

    def rates(t, x):
        return [x[1], x[0] * turn(t, 1) ** 2 - G * sin(turn(t))]

    place, speed = solve_ivp(rates, (0.0, 0.9), [0.4, 0.0], t_eval=run.t, **DIGITS).y
    a, w, e = (turn(run.t, k) for k in range(3))
    across = 0.7 * (place * e + 2.0 * speed * w + G * np.cos(a))
    expected = across * np.array([-np.sin(a), np.cos(a)])
    values = np.array([run["force.x"], run["force.y"]])
    assert np.abs(values - expected).max() < bound(method, np.abs(expected).max())


# --- moments ---
@pytest.mark.parametrize("method", [*NATURAL, *TREE])
def test_the_moment_of_a_bearing_that_carries_an_unbalanced_rotor(method):
    """A skew rod spins about z: H turns with it, M = w x H - r x m g about the bearing, constant in its own axes."""
    mass, w, r = 2.0, 7.0, np.array([0.4, 0.0, 0.3])
    inertia = np.diag([0.02, 0.05, 0.04])
    inertia[0, 2] = inertia[2, 0] = -0.012
    about = inertia + mass * (r @ r * np.eye(3) - np.outer(r, r))
    m = Model("rotor")
    rotor = m.body("rotor", mass=mass, com=r, inertia=inertia)
    m.revolute("bearing", rotor, m.ground, point=(0, 0, 0), axis=(0, 0, 1))
    m.initial_velocity(rotor, angular=(0.0, 0.0, w))
    for c in "xyz":
        m.sense_joint(f"body.{c}", "bearing", c, "moment", axes=rotor)
        m.sense_joint(f"earth.{c}", "bearing", c, "moment")
        m.sense_joint(f"second.{c}", "bearing", c, "moment", on="second")
        m.sense_joint(f"centre.{c}", "bearing", c, "moment", axes=rotor, point=r)
    run = simulate(compile(m), 0.4, 0.001, method=method, every=40)
    spin, weight = np.array([0.0, 0.0, w]), np.array([0.0, 0.0, -mass * G])
    expected = np.cross(spin, about @ spin) - np.cross(r, weight)
    for k, c in enumerate("xyz"):
        assert np.abs(run[f"body.{c}"] - expected[k]).max() < 1e-3 * np.abs(expected).max()
        assert np.abs(run[f"earth.{c}"] + run[f"second.{c}"]).max() < 1e-9
    turned = np.array([run["earth.x"], run["earth.y"]])
    angle = w * run.t
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    assert np.abs(turned - np.einsum("ijk,j->ik", rotation, expected[:2])).max() < 5e-3 * np.abs(expected).max()
    # about the centre of mass: w x I w
    centre = np.cross(spin, inertia @ spin)
    for k, c in enumerate("xyz"):
        assert np.abs(run[f"centre.{c}"] - centre[k]).max() < 1e-3 * np.abs(expected).max()


def test_a_cantilever_hangs_from_its_wall():
    """Welded parts at rest: the weight of the outer one times its arm, at the wall and at its centre."""
    m = Model("cantilever")
    inner = m.body("inner", mass=3.0, com=(0.5, 0.0, 0.0), inertia=(0.1, 0.2, 0.2))
    outer = m.body("outer", mass=2.0, com=(1.4, 0.3, 0.0), inertia=(0.1, 0.2, 0.2))
    m.weld("seam", outer, inner)
    m.weld("wall", inner, m.ground)
    for c in "xyz":
        m.sense_joint(f"seam.{c}", "seam", c, "moment", point=(1.0, 0.0, 0.0))
        m.sense_joint(f"wall.{c}", "wall", c, "moment", point=(0.0, 0.0, 0.0))
        m.sense_joint(f"centre.{c}", "seam", c, "moment")
        m.sense_joint(f"force.{c}", "wall", c)
    simulation = Simulation(compile(m)).sensors
    seam = -np.cross((0.4, 0.3, 0.0), (0.0, 0.0, -2.0 * G))
    wall = -np.cross((0.5, 0.0, 0.0), (0.0, 0.0, -3.0 * G)) - np.cross((1.4, 0.3, 0.0), (0.0, 0.0, -2.0 * G))
    np.testing.assert_allclose([simulation[f"seam.{c}"] for c in "xyz"], seam, atol=1e-8)
    np.testing.assert_allclose([simulation[f"wall.{c}"] for c in "xyz"], wall, atol=1e-8)
    np.testing.assert_allclose([simulation[f"centre.{c}"] for c in "xyz"], 0.0, atol=1e-8)
    np.testing.assert_allclose([simulation[f"force.{c}"] for c in "xyz"], [0.0, 0.0, 5.0 * G], atol=1e-8)


JOINTS = {
    "revolute": {"point": (0.5, 0.1, -0.2), "axis": (1.0, 2.0, 0.5)},
    "cylindrical": {"point": (0.5, 0.1, -0.2), "axis": (1.0, 2.0, 0.5)},
    "prismatic": {"point": (0.5, 0.1, -0.2), "axis": (1.0, 2.0, 0.5)},
    "universal": {"point": (0.5, 0.1, -0.2), "axis_1": (1.0, 0.0, 0.0), "axis_2": (0.0, 1.0, 0.3)},
    "weld": {},
}


@pytest.mark.parametrize("kind", JOINTS)
@pytest.mark.parametrize("which", [0, 1])
def test_euler_s_law_of_either_body_of_two_that_fly(kind, which):
    """I w' + w x I w is the moment about the centre of mass, with w' from differences; m a is the force."""
    m = Model("pair", gravity=(0.0, 0.0, 0.0))
    places, masses = ((0.1, 0.2, 0.3), (0.9, -0.3, 0.6)), (1.0, 2.0)
    inertias = [np.diag([0.2, 0.3, 0.25]), np.diag([0.1, 0.4, 0.35])]
    pair = [m.body(n, mass=k, com=p, inertia=i) for n, k, p, i in zip("ab", masses, places, inertias, strict=True)]
    joint = getattr(m, kind)("joint", *pair, **JOINTS[kind])
    m.initial_velocity(pair[0], (0.3, -0.2, 0.5), (1.0, 2.0, -1.5))
    m.initial_velocity(pair[1], (-0.3, 0.4, 0.1), (-2.0, 0.5, 1.0))
    side = ("first", "second")[which]
    centre = {} if joint.places is None else {"point": places[which]}
    for c in "xyz":
        m.sense_rotation(f"w{c}", pair[which], c, order=1)
        m.sense_joint(f"M{c}", joint, c, "moment", on=side, axes=pair[which], **centre)
        m.sense_position(f"a{c}", pair[which], None, c, order=2, axes="body")
    if joint.places is None:  # about the joint's own point on that body
        for c in "xyz":
            m.sense_joint(f"F{c}", joint, c)
            m.sense_position(f"r{c}", pair[which], None, c)
        for c in "wxyz":
            m.sense_rotation(f"q{c}", pair[which], c)
            m.sense_position(f"o{c}", pair[which], (0.5, 0.1, -0.2), c) if c != "w" else None
    h = 1e-3
    run = simulate(compile(m), 0.4, h, method="runge_kutta_8")
    w, moment = (np.array([run[f"{n}{c}"] for c in "xyz"]) for n in "wM")
    rate = (w[:, :-4] - 8.0 * w[:, 1:-3] + 8.0 * w[:, 3:-1] - w[:, 4:]) / (12.0 * h)
    w, moment = w[:, 2:-2], moment[:, 2:-2]
    expected = inertias[which] @ rate + np.cross(w, inertias[which] @ w, axis=0)
    if joint.places is None:
        turn = Rotation.from_quat(np.array([run[f"q{c}"] for c in "xyzw"]).T).as_matrix()
        force, r, o = (np.array([run[f"{n}{c}"] for c in "xyz"]) for n in "Fro")
        sign = 1.0 if which == 0 else -1.0
        # from the joint's point on this body to its centre of mass
        arm = np.cross(o - r, sign * force, axis=0)
        expected = expected - np.einsum("kji,jk->ik", turn, arm)[:, 2:-2]
    assert np.abs(expected).max() > 0.02
    assert np.abs(moment - expected).max() < 1e-6 * np.abs(expected).max()


def test_the_torque_of_a_drive_is_its_moment():
    m = Model("driven", dimension=2)
    rod = m.body("rod", mass=2.0, com=(0.5, 0.0), inertia=0.2)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    m.drive("motor", m.relative_angle("angle", m.ground, rod), m.guide_time("turn", RISE, unit="rad"))
    m.sense_joint("moment", "motor", "z", "moment")
    assert m.sense_joint("force", "motor", "drive").unit == "N m"
    run = simulate(compile(m), 0.8, 0.01)
    expected = (0.2 + 0.5) * RISE(run.t, 2) + 2.0 * G * 0.5 * np.cos(RISE(run.t))
    assert np.abs(run["moment"] - expected).max() < 1e-4
    assert (run["moment"] == run["force"]).all()


def test_the_force_of_a_drive_of_a_travel_is_no_moment():
    m = Model("driven")
    m.drive("motor", m.travel("s"), m.guide_time("rise", RISE))
    assert m.sense_joint("force", "motor", "drive").unit == "N"


def multipliers(m, equilibrium=False):
    """By the name of their rows, as the model writes them, at the start or at rest."""
    system = compile(m)
    simulation = Simulation(system)
    if equilibrium:
        simulation.static_equilibrium()
    results = {}
    for row, scale, lam in zip(system.meta["rows"], system.arrays["row_scale"], simulation.state.lam, strict=True):
        results.setdefault(row["name"], []).append(scale * lam)
    return results


def test_the_raw_multipliers_have_the_signs_that_the_state_documents():
    """A weight of 20 N that a drive, a port, a rod and a node of a flexible body carry, force upwards on the body."""
    weight = 20.0
    m = Model("lift", dimension=2)
    box = m.point_mass("box", mass=weight / G, position=(0.0, 0.0))
    m.drive("lift", box.point(None)[1], m.guide_time("still", PPoly(np.array([[0.0], [0.0]]), [0.0, 1.0]), unit="m"))
    assert multipliers(m)["lift"] == pytest.approx([-weight])
    m = Model("rod", dimension=2)
    m.distance("rod", (m.ground, (0.0, 2.0)), m.point_mass("box", mass=weight / G, position=(0.0, 0.0)))
    assert 2.0 * multipliers(m)["rod"][0] == pytest.approx(weight)
    m = Model("port")
    owner = m.body("box", mass=weight / G, com=(0, 0, 0), inertia=(1, 1, 1))
    m.spherical("hook", m.ported(owner, {"eye": (0.0, 0.0, 0.5)}), m.ground, point=(0.0, 0.0, 0.5))
    assert multipliers(m)["box.eye"] == pytest.approx([0.0, 0.0, weight], abs=1e-9)
    m = Model("node")
    body = m.flexible_body("bar", bar((0, 0, -1.0), (0, 0, 0)))
    m.spherical("hook", body, m.ground, point=(0.0, 0.0, 0.0))
    raw = multipliers(m, equilibrium=True)
    (name,) = [n for n in raw if n.startswith("bar.")]
    assert raw[name][2] == pytest.approx(body.mass * G, rel=1e-6)


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda m: m.sense_joint("s", "ball", "z", "moment"), "'ball' .spherical. transmits no moment; revolute"),
        (
            lambda m: m.sense_joint("s", "hinge", "z", "moment", on="third"),
            "on 'third'; it must be 'first' or 'second'",
        ),
        (lambda m: m.sense_joint("s", "cardan", "z", "moment", point=(0, 0, 0)), "at its own point only"),
        (lambda m: m.sense_joint("s", "nothing", "z", "moment"), "no joint named 'nothing'"),
        (
            lambda m: m.sense_joint("s", "hinge", on="second"),
            "first body in earth axes; on, axes and point are for moments",
        ),
        (lambda m: m.sense_joint("s", "rope", "y"), "for a driven distance it must be 'tension' or 'drive'"),
    ],
)
def test_an_invalid_joint_sensor_is_refused_with_the_valid_choices(act, sentence):
    m = Model("words")
    a, b, c, d = (m.body(n, mass=1.0, com=(k, 0, 0), inertia=(1, 1, 1)) for k, n in enumerate("abcd"))
    m.spherical("ball", m.ground, a, point=(0, 0, 0))
    m.revolute("hinge", a, b, point=(0.5, 0, 0), axis=(0, 0, 1))
    m.universal("cardan", b, c, point=(1.5, 0, 0), axis_1=(0, 1, 0), axis_2=(0, 0, 1))
    m.drive("rope", ((c, (2, 0, 0)), (d, (3, 0, 0))), m.guide_time("length", shifted(1.0, 2.0), unit="m"))
    with pytest.raises(ModelError, match=sentence):
        act(m)
