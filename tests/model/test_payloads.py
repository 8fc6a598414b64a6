"""Payloads: point masses whose mass is a parameter, held against closed forms and the same mass in other ways."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbs import Model, ModelError, Settings, Simulation, compile
from mbs.flexible import InertiaRelief
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.model.joints.joint import Joint, equal_vectors
from mbs.settings.methods import METHOD_TABLE
from tests.altered_system import altered, put
from tests.flexible_engine.bodies import bar, cloud
from tests.methods.trees import branching, measured

GRAVITY = 9.81
SAME = 1e-9
ROUGH = {"ali3p_no_projection": 1e-2, "energy_momentum_4": 1e-7}
"""What round-off and the tolerance of the iterations grow to: without projections it is unstable."""


def table_of(trajectory):
    return np.array([trajectory[name] for name in trajectory if not name.startswith("solver.")])


def hung(m, name, body, place, mass, way):
    """A mass on a body: as a payload that a parameter sets, as one of that mass, in the body, as a body tied to it."""
    if way == "parameter":
        payload = m.payload(name, body, place, mass=0.0)
        m.parameter(f"{name}.mass", 0.0, 0.0, 1e3, "kg", targets=[(payload, "mass", 1.0)], tunable=False)
    elif way == "payload":
        m.payload(name, body, place, mass=mass)
    elif way == "own":
        body.add_mass(mass, np.array(place), np.zeros((3, 3)))
    else:
        tied(m, name, body.point(place), place, mass)


def tied(m, name, point, place, mass):
    particle = m.point_mass(name, mass=mass, position=place)
    m.joints.append(Joint(name, "tie", equal_vectors(name, "point", particle.point(), point)))


def pendulum(way, mass=1.5):
    m = Model("pendulum", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    hung(m, "load", rod, (1.0, 0.2), mass, way)
    m.sense_position("x", rod, (0.5, 0.0), "x")
    m.sense_position("y", rod, (0.5, 0.0), "y")
    m.sense_joint("hinge.y", "hinge", "y")
    m.sense_position("ay", rod, (0.5, 0.0), "y", order=2)
    for kind in ("kinetic", "gravity", "total"):
        m.sense_energy(kind, kind)
    return m


def started(model, method, way, values):
    parameters = values if way == "parameter" else {}
    return Simulation(compile(model), settings=Settings(method=method), parameters=parameters)


@pytest.mark.parametrize("method", METHOD_TABLE)
def test_every_method_moves_a_payload_as_a_mass_of_the_body(method):
    actual = {
        way: started(pendulum(way), method, way, {"load.mass": 1.5}).run(0.8, 0.005)
        for way in ("parameter", "payload", "own")
    }
    np.testing.assert_array_equal(table_of(actual["parameter"]), table_of(actual["payload"]))  # bit for bit
    tolerance = ROUGH.get(method, SAME) * max(1.0, np.abs(actual["own"]["hinge.y"]).max())
    np.testing.assert_allclose(table_of(actual["parameter"]), table_of(actual["own"]), rtol=0, atol=tolerance)
    without = started(pendulum("parameter"), method, "parameter", {}).run(0.8, 0.005)
    assert np.abs(without["x"] - actual["parameter"]["x"]).max() > 0.01


def test_the_swing_of_a_pendulum_with_a_payload():
    """Closed form: (I + sum m r^2) theta'' = -sum m g r cos(theta + theta_0), of rod and payload."""
    mass, arm, turn = 1.5, np.hypot(1.0, 0.2), np.arctan2(0.2, 1.0)
    inertia = 0.1 + 1.0 * 0.5**2 + mass * arm**2

    def rates(t, x):
        return [x[1], -GRAVITY * (0.5 * np.cos(x[0]) + mass * arm * np.cos(x[0] + turn)) / inertia]

    motion = solve_ivp(rates, (0.0, 2.0), (0.0, 0.0), "DOP853", rtol=1e-12, atol=1e-12)
    run = started(pendulum("parameter"), "runge_kutta_8", "parameter", {"load.mass": mass}).run(2.0, 0.002)
    angle, rate = motion.y[0, -1], motion.y[1, -1]
    assert run["x"][-1] == pytest.approx(0.5 * np.cos(angle), abs=1e-9)
    assert run["y"][-1] == pytest.approx(0.5 * np.sin(angle), abs=1e-9)
    assert run["kinetic"][-1] == pytest.approx(0.5 * inertia * rate**2, rel=1e-8)
    height = 0.5 * np.sin(angle) + mass * arm * np.sin(angle + turn)
    assert run["gravity"][-1] == pytest.approx(GRAVITY * height, rel=1e-8)
    # at the start: force of the hinge = weight less mass times acceleration of the centre of mass
    alpha = -GRAVITY * (0.5 + mass) / inertia
    assert abs(run["hinge.y"][0]) == pytest.approx(2.5 * GRAVITY + alpha * (0.5 + mass), rel=1e-9)


@pytest.mark.parametrize(
    ("method", "build"),
    [
        ("semi_recursive", lambda: branching(True)),
        ("semi_recursive_4", lambda: branching(False)),
        ("semi_recursive", lambda: measured("bricard")),
    ],
    ids=["springs", "none", "loop"],
)
def test_relative_coordinates_carry_payloads_like_natural_ones(method, build):
    """Spatial trees with slides, welds, loops, with and without forces of the System."""

    def loaded(way):
        m = build()
        for k, body in enumerate(m.bodies[-3:]):
            hung(m, f"load {k}", body, body.com + np.array([0.1, -0.2, 0.15 * k]), 0.4 + 0.3 * k, way)
        return m

    values = {f"load {k}.mass": 0.4 + 0.3 * k for k in range(3)}
    one, other = (started(loaded(way), method, way, values).run(0.2, 1e-3) for way in ("parameter", "own"))
    scale = np.abs(table_of(other)).max()
    np.testing.assert_allclose(table_of(one), table_of(other), rtol=0, atol=SAME * scale)
    natural = started(loaded("parameter"), "runge_kutta_8", "parameter", values).run(0.2, 1e-3)
    np.testing.assert_allclose(table_of(one), table_of(natural), rtol=0, atol=1e-6 * scale)


def flexible(way, method="ali3p", mass=3.0):
    """A bar that bends, held by springs and set free with a spin; the mass is at its end or off it on a rigid arm."""
    m = Model("bar")
    body = m.flexible_body("bar", bar((0, 0, 0), (0.6, 0, 0), stiffer=0.3))
    end = body.interface(8)
    for k, node in enumerate((0, 8)):
        x = body.node_positions[node]
        m.spring_damper(
            f"spring {k}", (m.ground, x + np.array([0.0, 0.1, 0.3])), body.interface(node), stiffness=900.0, damping=1.0
        )
    for k, place in enumerate((end.com, end.com + np.array([0.0, 0.1, 0.05]))):
        if way == "tied":
            tied(m, f"load {k}", end.point(place), place, mass)
        else:
            hung(m, f"load {k}", end, place, mass, way)
    m.initial_velocity(body, linear=(0.1, 0.0, 0.0), angular=(0.3, 0.0, 2.0))
    for c in "xyz":
        m.sense_position(c, end, None, c)
    m.sense_position("az", end, None, "z", order=2)
    for kind in ("kinetic", "gravity", "elastic"):
        m.sense_energy(kind, kind)
    return m


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum", "runge_kutta_8"])
def test_a_payload_on_a_flexible_body_is_one_tied_to_it(method):
    h = 2e-5 if method == "runge_kutta_8" else 1e-3
    end = 0.01 if method == "runge_kutta_8" else 0.1
    tight = Settings(method=method, tolerance_r=1e-13, tolerance_phi=1e-13)
    values = {"load 0.mass": 3.0, "load 1.mass": 3.0}
    one = Simulation(compile(flexible("parameter")), settings=tight, parameters=values).run(end, h)
    other = Simulation(compile(flexible("tied")), settings=tight).run(end, h)
    for name in one:
        scale = max(1.0, np.abs(other[name]).max())
        digits = 1e-6 if name == "az" else 2e-8  # iterations end when positions are right
        np.testing.assert_allclose(one[name], other[name], rtol=0, atol=digits * scale, err_msg=name)
    assert np.ptp(one["elastic"]) > 1e-4


def test_a_payload_on_a_flexible_body_itself_sits_at_a_node():
    m = Model("cloud")
    body = m.flexible_body("cloud", cloud())
    place = body.node_positions[3]
    assert set(m.payload("load", body, place).point[0].terms) == set(body.interface(3).point()[0].terms)
    with pytest.raises(ModelError, match=r"has no node at \[5.0, 0.0, 0.0\] for payload 'far'"):
        m.payload("far", body, (5.0, 0.0, 0.0))


LEFT, RIGHT, MIDDLE = (-1.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.5, 0.2, 0.1)


def ported(way, mass=2.0):
    """A beam on a ball joint and a spring that swings; outputs are the forces at its ports, in its axes."""
    m = Model("beam")
    body = m.body("beam", mass=6.0, com=(0.0, 0.0, 0.0), inertia=(0.1, 4.0, 4.0))
    ports = m.ported(body, {"left": LEFT, "right": RIGHT, "seat": MIDDLE})
    m.spherical("ball", m.ground, ports, point=LEFT)
    m.spring_damper(
        "spring", (ports, RIGHT), (m.ground, (2.0, 0.3, 0.5)), stiffness=400.0, damping=2.0, free_length=0.4
    )
    hung(m, "load", ports, MIDDLE, mass, way)
    weights = np.eye(9)
    relief = InertiaRelief(weights, np.zeros((9, 3)), np.zeros((9, 9)), weights, np.zeros((6, 9)))
    for k in range(9):
        m.sense_quasi_static(f"out{k}", ports, relief, k, LEFT)
    for c in "xyz":
        m.sense_position(f"a{c}", body, MIDDLE, c, body, order=2)
        m.sense_position(f"fall{c}", body, MIDDLE, c, order=2)
    m.sense_position("z", body, RIGHT, "z")
    return m


def test_the_force_of_a_payload_reaches_the_port_where_it_sits():
    """-m (a - g), in body axes, as of a body tied there; nothing without it."""
    tight = Settings(tolerance_r=1e-13, tolerance_phi=1e-13)
    simulation = Simulation(compile(ported("parameter")), settings=tight, parameters={"load.mass": 2.0})
    run = simulation.run(1.0, 0.002)
    seat = np.array([run[f"out{k}"] for k in (6, 7, 8)])
    other = Simulation(compile(ported("tied")), settings=tight).run(1.0, 0.002)
    for name in run:
        scale = max(1.0, np.abs(other[name]).max())
        np.testing.assert_allclose(run[name], other[name], rtol=0, atol=SAME * scale, err_msg=name)
    assert np.abs(seat).max() > 2.0 * GRAVITY  # more than its weight
    along = np.array([run[f"a{c}"] for c in "xyz"])
    fall = np.array([run[f"fall{c}"] for c in "xyz"])
    force = 2.0 * np.linalg.norm(fall + np.array([[0.0], [0.0], [GRAVITY]]), axis=0)
    np.testing.assert_allclose(np.linalg.norm(seat, axis=0), force, rtol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(along, axis=0), np.linalg.norm(fall, axis=0), rtol=1e-7)
    empty = Simulation(compile(ported("parameter")), settings=tight).run(0.1, 0.002)
    np.testing.assert_allclose([empty[f"out{k}"] for k in (6, 7, 8)], 0.0, atol=1e-8)


def test_a_payload_that_stresses_would_miss_is_refused():
    m = ported("parameter")
    m.payload("driver", m.bodies[0], (0.3, 0.0, 0.0))
    with pytest.raises(
        ModelError, match=r"ports of body 'beam', where the payload 'driver' has none: add a port at \[0"
    ):
        compile(m)


def test_a_state_carries_its_payloads():
    system = compile(pendulum("parameter"))
    one, other = (Simulation(system, parameters={"load.mass": mass}) for mass in (4.0, 0.5))
    one.step(0.01, 20)
    other.restore(one.save())
    one.step(0.01, 20)
    other.step(0.01, 20)
    assert one.save() == other.save()


def test_invalid_payloads_are_refused():
    m = pendulum("parameter")
    rod = m.bodies[0]
    with pytest.raises(ModelError, match="The payload 'a' sits on the ground, which does not move"):
        m.payload("a", m.ground, (0.0, 0.0))
    with pytest.raises(ModelError, match=r"The mass of payload 'b' is -1"):
        m.payload("b", rod, (0.0, 0.0), mass=-1.0)
    payload = m.payload("b", rod, (0.0, 0.0))
    with pytest.raises(ModelError, match="mass of payload 'b', which cannot change while it moves; it must be fixed"):
        m.parameter("b", 0.0, 0.0, 1.0, targets=[(payload, "mass", 1.0)])
    with pytest.raises(ModelError, match="At the min -1 of parameter 'b', the mass of payload 'b' is -1"):
        m.parameter("b", 0.0, -1.0, 1.0, targets=[(payload, "mass", 1.0)], tunable=False)
    simulation = Simulation(compile(m))
    with pytest.raises(ValueError, match="'load.mass' is fixed"):
        simulation.set_parameter("load.mass", 1.0)


@pytest.mark.parametrize(
    ("array", "index", "value", "message"),
    [
        ("payload_mass", 0, -1.0, "mass of a payload"),
        ("payload_signal", 0, 10_000, "payload_signal"),
        ("par_fixed", 0, 0, "writes the mass of a payload and is not fixed"),
        ("par_index", 0, 1, "par_index"),
        ("tree_payload_body", 0, 2, "tree_payload_body"),
    ],
)
def test_the_loader_refuses_wrong_payloads(array, index, value, message):
    with pytest.raises(KernelError, match=message):
        LoadedSystem(altered(compile(pendulum("parameter")), **{array: put(index, value)}))


def test_the_loader_refuses_a_payload_without_room_in_the_mass_matrix():
    """A signal of coordinates of two bodies, between which there is no mass."""
    m = Model("two", dimension=2)
    one, two = (m.point_mass(name, mass=1.0, position=(x, 0.0)) for name, x in (("one", 0.0), ("two", 1.0)))
    m.spring_damper("spring", one, two, stiffness=1.0, free_length=1.0)
    m.payload("load", one, (0.0, 0.0), mass=1.0)
    system = compile(m)
    between = next(
        k
        for k in range(len(system.arrays["sig_const"]))
        if system.arrays["sig_ptr"][k + 1] - system.arrays["sig_ptr"][k] == 2
    )
    with pytest.raises(KernelError, match="payload 0 is at coordinates between which the mass matrix has no entry"):
        LoadedSystem(altered(system, payload_signal=put(0, between)))


@pytest.mark.parametrize("model", [lambda: pendulum("parameter"), lambda: flexible("parameter")], ids=["tree", "bar"])
def test_hostile_payloads_never_crash(model):
    """Every integer out of range or out of place, and reals at random: refused, or a run that ends in a status."""
    system, rng = compile(model()), np.random.default_rng(7)
    accepted = 0
    for name in ("payload_signal", "tree_payload_body", "payload_mass", "payload_gravity", "tree_payload_place"):
        integers = system.arrays[name].dtype == np.int32
        for k in range(len(system.arrays[name])):
            for value in (-1, 0, 1, 5, 1 << 30) if integers else (-1.0, 1e-300, 1e150, rng.uniform(-9.0, 9.0)):
                try:
                    instance = Instance(LoadedSystem(altered(system, **{name: put(k, value)})))
                    accepted += 1
                    instance.initialise()
                    for method in ("ali3p", "semi_recursive", "energy_momentum"):
                        instance.set_settings(**METHOD_TABLE[method].kernel_fields)
                        instance.step(0.01)
                    assert np.isfinite(instance.sensors()[:]).all()
                except KernelError:
                    continue
    assert accepted > 5
