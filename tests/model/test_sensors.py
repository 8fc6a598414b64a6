"""Values of sensors; joint forces from the multipliers."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbs import Model, ModelError, Simulation, compile

EXACT = 1e-9


def flying_plate():
    m = Model("plate", gravity=(0, 0, 0))
    body = m.body("plate", mass=1.3, com=(0.2, 0.1, 0.4), inertia=(0.2, 0.3, 0.4))
    m.initial_velocity(body, linear=(1.0, -0.5, 0.3), angular=(0.7, 1.1, -0.4))
    p = (0.5, 0.3, 0.1)
    for c in "xyz":
        for order, quantity in enumerate(("position", "velocity", "acceleration")):
            m.sense_position(f"{quantity}.{c}", body, p, c, order=order)
            m.sense_position(f"{quantity}.{c}.body", body, p, c, axes="body", order=order)
        m.sense_rotation(f"rate.{c}", body, c, order=1)
        for k in "xyz":
            m.sense_coordinate(f"axis.{c}.{k}", body.vector(np.eye(3)["xyz".index(c)])["xyz".index(k)])
    for c in "wxyz":
        m.sense_rotation(f"quaternion.{c}", body, c)
    m.sense_angle("yaw", body, "yaw")
    m.sense_angle("pitch", body, "pitch")
    m.sense_angle("roll", body, "roll")
    m.sense_vector("speed", body.point(p), order=1)
    m.sense_angle("turn", (body.vector((0, 1, 0)), body.vector((1, 0, 0)), body.vector((0, 0, 1))))
    m.sense_energy("kinetic", "kinetic")
    return m


def test_orientation_and_body_axes_agree_with_the_rotation_matrix():
    t = Simulation(compile(flying_plate())).run(0.5, 0.001)
    R = np.array([[t[f"axis.{c}.{k}"][-1] for c in "xyz"] for k in "xyz"])  # columns are the body axes
    np.testing.assert_allclose(R.T @ R, np.eye(3), rtol=0, atol=EXACT)
    assert np.linalg.norm(R - np.eye(3)) > 0.3
    yaw, pitch, roll = Rotation.from_matrix(R).as_euler("ZYX")
    assert t["yaw"][-1] == pytest.approx(yaw, abs=EXACT)
    assert t["pitch"][-1] == pytest.approx(pitch, abs=EXACT)
    assert t["roll"][-1] == pytest.approx(roll, abs=EXACT)
    x, y, z, w = Rotation.from_matrix(R).as_quat(canonical=True)
    for c, value in zip("wxyz", (w, x, y, z), strict=True):
        assert t[f"quaternion.{c}"][-1] == pytest.approx(value, abs=EXACT)
    velocity = np.array([t[f"velocity.{c}"][-1] for c in "xyz"])
    for quantity in ("position", "velocity", "acceleration"):
        earth = np.array([t[f"{quantity}.{c}"][-1] for c in "xyz"])
        body = np.array([t[f"{quantity}.{c}.body"][-1] for c in "xyz"])
        np.testing.assert_allclose(body, R.T @ earth, rtol=0, atol=EXACT)
    assert t["speed"][-1] == pytest.approx(np.linalg.norm(velocity), rel=EXACT)
    assert t["turn"][-1] == pytest.approx(np.pi / 2, abs=EXACT)


@pytest.mark.parametrize("axis", [(1.0, 0.2, -0.3), (0.2, -1.0, 0.3), (-0.3, 0.2, 1.0)])
def test_quaternion_after_nearly_half_a_turn(axis):
    """There its scalar part is small, and the other three follow from the largest of them."""
    m = Model("ball", gravity=(0, 0, 0))
    ball = m.body("ball", mass=1.0, com=(0, 0, 0), inertia=(0.2, 0.2, 0.2))
    turn = 0.95 * np.pi * np.array(axis) / np.linalg.norm(axis)
    m.initial_velocity(ball, angular=turn)
    for c in "wxyz":
        m.sense_rotation(c, ball, c)
    t = Simulation(compile(m)).run(1.0, 0.001)
    x, y, z, w = Rotation.from_rotvec(turn).as_quat()
    values = np.array([t[c] for c in "wxyz"])
    assert values[:, -1] == pytest.approx([w, x, y, z], abs=1e-5)
    np.testing.assert_allclose(np.sum(values**2, axis=0), 1.0, rtol=0, atol=EXACT)
    assert np.abs(np.diff(values)).max() < 0.01  # no jump where another part becomes the largest


def test_a_direction_of_motion_is_given_from_a_tenth_of_a_metre_per_second():
    for speed, expected in ((0.099, 0.0), (0.101, 0.5)):
        m = Model("block", dimension=3, gravity=(0, 0, 0))
        block = m.body("block", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
        m.initial_velocity(block, linear=(speed * np.cos(0.5), speed * np.sin(0.5), 0.0))
        m.sense_vector("sideslip", block.point((0, 0, 0)), [block.vector((1, 0, 0)), block.vector((0, 1, 0))], order=1)
        assert Simulation(compile(m)).sensors["sideslip"] == pytest.approx(expected, abs=EXACT)


def test_start_velocity_energy_and_euler_equations():
    """At the start: velocity and acceleration of a point of a body that turns freely."""
    simulation = Simulation(compile(flying_plate()))
    s = simulation.sensors
    v, w, arm = np.array([1.0, -0.5, 0.3]), np.array([0.7, 1.1, -0.4]), np.array([0.3, 0.2, -0.3])
    I = np.array([0.2, 0.3, 0.4])
    wd = -np.cross(w, I * w) / I
    expected = {"velocity": v + np.cross(w, arm), "acceleration": np.cross(wd, arm) + np.cross(w, np.cross(w, arm))}
    for quantity, values in expected.items():
        for c, value in zip("xyz", values, strict=True):
            assert s[f"{quantity}.{c}"] == pytest.approx(value, abs=EXACT)
    for c, value in zip("xyz", w, strict=True):
        assert s[f"rate.{c}"] == pytest.approx(value, abs=EXACT)
    assert s["kinetic"] == pytest.approx(0.5 * 1.3 * v @ v + 0.5 * w @ (I * w), rel=EXACT)


def test_forces_of_kept_joints():
    """A hanging chain: the pin carries both parts, the rod what hangs on it; their equations become rows."""
    m = Model("chain", dimension=2)
    upper = m.body("upper", mass=2.0, com=(0, -0.5), inertia=0.2)
    bob = m.point_mass("bob", mass=3.0, position=(0, -2))
    pin = m.revolute("pin", upper, m.ground, point=(0, 0))
    rod = m.distance("rod", (upper, (0, -1)), bob)
    without = compile(m)
    m.sense_joint("pin.x", pin, "x")
    m.sense_joint("pin.y", "pin", "y")
    m.sense_joint("tension", rod, "tension")
    system = compile(m)
    assert system.nc == without.nc + 2
    assert system.nq == without.nq + 2
    assert system.report["degrees_of_freedom"] == without.report["degrees_of_freedom"] == 2
    s = Simulation(system).sensors
    assert s["pin.y"] == pytest.approx(5.0 * 9.81, rel=EXACT)
    assert s["pin.x"] == pytest.approx(0.0, abs=1e-7)
    assert s["tension"] == pytest.approx(3.0 * 9.81, rel=EXACT)


def test_energies_add_up():
    m = Model("spring", dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(0.3, -1.0))
    m.spring_damper("spring", (m.ground, (0, 0)), bob, stiffness=80.0, free_length=0.9)
    for kind in ("kinetic", "gravity", "elastic", "total"):
        m.sense_energy(kind, kind)
    m.sense_element("force", "spring", "force")
    m.sense_position("x", bob, None, "x")
    m.sense_position("y", bob, None, "y")
    t = Simulation(compile(m)).run(0.5, 0.0005)
    np.testing.assert_allclose(t["kinetic"] + t["gravity"] + t["elastic"], t["total"], rtol=0, atol=EXACT)
    stretch = np.hypot(t["x"], t["y"]) - 0.9
    np.testing.assert_allclose(t["elastic"], 40.0 * stretch**2, rtol=0, atol=EXACT)
    np.testing.assert_allclose(t["gravity"], 9.81 * t["y"], rtol=0, atol=EXACT)
    np.testing.assert_allclose(t["force"], 80.0 * stretch, rtol=0, atol=EXACT)
    assert np.max(np.abs(t["total"] - t["total"][0])) < 1e-4


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda m, b: m.sense_position("s", b, None, "w"), "'x', 'y' or 'z'"),
        (lambda m, b: m.sense_position("s", b, None, "x", axes="wheel"), "'earth', 'body' or a body"),
        (lambda m, b: m.sense_element("s", "spring", "force"), "no such element"),
        (lambda m, b: m.sense_vector("s", b.point((0, 0, 0)), order=2), "must be 0 or 1"),
        (lambda m, b: m.sense_vector("s", b.point((0, 0, 0)), [b.vector((1, 0, 0))] * 3), "at most two vectors"),
        (lambda m, b: m.sense_angle("s", [b.vector((1, 0, 0))]), "a body, a spin or three vectors"),
        (lambda m, b: m.sense_angle("s", [b.vector((1, 0, 0))] * 3, "yaw"), "only bodies have yaw, pitch and roll"),
        (lambda m, b: m.sense_energy("s", "kinetic", ["spring"]), "elements are for 'work' and 'nonconservative'"),
        (lambda m, b: m.sense_joint("s", "turn"), "has no readable force"),
    ],
)
def test_impossible_sensors_are_refused(act, sentence):
    m = Model("refusal")
    body = m.body("b", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    m.relative_angle("turn", m.ground, body, axis=(0, 0, 1))
    with pytest.raises(ModelError) as error:
        act(m, body)
    assert sentence in str(error.value)


def test_units_follow_the_order():
    m = Model("units")
    body = m.body("b", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    x, y = body.vector((1, 0, 0)), body.vector((0, 1, 0))
    guide = m.guide_time("guide", ([0.0, 1.0], [0.0, 1.0]), unit="m")
    for order in range(3):
        m.sense_position(f"position {order}", body, order=order)
        m.sense_vector(f"component {order}", body.point((1, 0, 0)), [x], order=order)
        m.sense_guide(f"guide {order}", guide, order=order)
    for order in range(2):
        m.sense_vector(f"length {order}", body.point((1, 0, 0)), order=order)
        m.sense_vector(f"direction {order}", body.point((1, 0, 0)), [x, y], order=order)
        m.sense_rotation(f"rotation {order}", body, order=order)
    assert [s.unit for s in m.sensors] == [
        *("m", "m", "m", "m/s", "m/s", "m/s", "m/s2", "m/s2", "m/s2"),
        *("m", "rad", "1", "m/s", "rad", "rad/s"),
    ]


def test_coordinates_of_another_model_are_refused():
    other, m = Model("other"), Model("mine")
    body = other.body("b", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    foreign = other.relative_angle("turn", other.ground, body, axis=(0, 0, 1))
    for act in (lambda: m.armature("rotor", foreign, inertia=1.0), lambda: m.sense_coordinate("angle", foreign)):
        with pytest.raises(ModelError, match="'turn' is not one of model 'mine'"):
            act()
    with pytest.raises(ModelError, match="does not have"):
        m.sense_coordinate("angle", foreign.affine)


def test_forces_of_lines_of_the_ground():
    """A beam on a pin and a roller, and a block that slides down a slope without friction."""
    m = Model("beam", dimension=2)
    beam = m.body("beam", mass=10.0, com=(1.0, 0.0), inertia=3.3)
    m.revolute("pin", m.ground, beam, point=(0.0, 0.0))
    m.point_on_line("roller", (beam, (3.0, 0.0)), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    m.sense_joint("pin.y", "pin", "y")
    m.sense_joint("roller.x", "roller", "x")
    m.sense_joint("roller.y", "roller", "y")
    s = Simulation(compile(m)).sensors
    assert s["roller.y"] == pytest.approx(98.1 / 3.0, abs=EXACT)  # on the beam
    assert s["pin.y"] == pytest.approx(-98.1 * 2.0 / 3.0, abs=EXACT)  # on the ground
    assert s["roller.x"] == 0.0

    m = Model("slope", dimension=3)
    block = m.body("block", mass=2.0, com=(0, 0, 0), inertia=(1, 1, 1))
    slope = np.array([0.8, 0.0, -0.6])
    m.prismatic("slide", block, m.ground, axis=slope)
    for c in "xyz":
        m.sense_joint(c, "slide", c)
    t = Simulation(compile(m)).run(0.5, 0.01)
    weight = np.array([0.0, 0.0, -2.0 * 9.81])
    expected = slope * (weight @ slope) - weight  # what the slope adds to the weight
    for c, value in zip("xyz", expected, strict=True):
        np.testing.assert_allclose(t[c], value, rtol=0, atol=1e-6)


def test_the_system_lists_constants():
    m = Model("box", dimension=2)
    m.point_mass("ball", mass=1.0, position=(0.0, 0.0))
    m.constant("box.width", 2, "m", "width of the box")
    row = {"name": "box.width", "unit": "m", "description": "width of the box", "value": 2.0}
    assert compile(m).meta["constants"] == [row]
    with pytest.raises(ModelError, match="already has a constant named 'box.width'"):
        m.constant("box.width", 1.0)


def test_sensors_inputs_and_constants_share_their_names():
    """Columns of tables and variables of FMUs are found by them."""
    m = Model("box", dimension=2)
    ball = m.point_mass("ball", mass=1.0, position=(0.0, 0.0))
    m.input("ball")  # the name of another kind of object is free
    for claim in (lambda: m.sense_position("ball", ball), lambda: m.constant("ball", 1.0)):
        with pytest.raises(ModelError, match="already has an input named 'ball'; names must be unique in tables of"):
            claim()


def test_the_name_of_the_time_is_taken():
    """Tables of runs have it as their first column, an FMU as its independent variable."""
    m = Model("named", dimension=2)
    for claim in (m.input, lambda name: m.constant(name, 1.0)):
        with pytest.raises(ModelError, match="is 'time', which tables of runs and FMUs have"):
            claim("time")
