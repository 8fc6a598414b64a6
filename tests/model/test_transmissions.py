"""Gears, racks, screws and anti-roll bars against closed forms, by every method that takes them."""

import numpy as np
import pytest

import mbs
from mbs import Model, ModelError, compile, simulate
from mbs.settings.settings import Settings

STEPPERS = ("ali3p", "ali3p_generalised_alpha", "energy_momentum", "energy_momentum_4", "runge_kutta_8", "radau_5")
FEW = ("ali3p", "energy_momentum")
T = 1.0  # s
H = 0.002  # s


def close(method):
    """Relative error: the methods of order two turn late by some of (rate h)^2."""
    return 3e-4 if method in ("ali3p", "ali3p_generalised_alpha", "energy_momentum") else 1e-6


def run(m, method, inputs=None, h=H, t_end=T):
    return simulate(compile(m), t_end, h, inputs or {}, Settings(method=method), progress=False)


def at_rest(name="train", dimension=2):
    return Model(name, dimension=dimension, gravity=(0.0,) * dimension)


def gear_train(ratio):
    """Two shafts on the ground, driven on the first; returns the model and the gear."""
    m = at_rest()
    shafts = [
        m.body(f"shaft {k}", mass=1.0, com=(0.3 * k, 0.0), inertia=inertia) for k, inertia in ((1, 0.02), (2, 0.3))
    ]
    angles = []
    for k, shaft in enumerate(shafts, start=1):
        m.revolute(f"bearing {k}", m.ground, shaft, point=(0.3 * k, 0.0))
        angles.append(m.relative_angle(f"angle {k}", m.ground, shaft, zero=0.4 * k))
    teeth = m.gear("teeth", *angles, ratio=ratio)
    m.torque_on("motor", angles[0], input=m.input("torque"))
    for k, angle in enumerate(angles, start=1):
        m.sense_coordinate(f"angle.{k}", angle)
    return m, teeth


@pytest.mark.parametrize("method", STEPPERS)
def test_a_gear_train_has_the_reduced_inertia(method):
    ratio = -2.5
    m, teeth = gear_train(ratio)
    m.sense_joint("teeth.torque", teeth, "torque")
    r = run(m, method, {"torque": 0.15})
    acceleration = 0.15 / (0.02 + 0.3 / ratio**2)
    assert r["angle.1"][-1] - 0.4 == pytest.approx(0.5 * acceleration, rel=close(method))
    assert r["angle.2"][-1] - 0.8 == pytest.approx(0.5 * acceleration / ratio, rel=close(method))
    assert r["teeth.torque"][-1] == pytest.approx(-0.3 * acceleration / ratio**2, rel=close(method))
    assert r.units["teeth.torque"] == "N m"


@pytest.mark.parametrize("method", FEW)
def test_gears_on_a_free_carrier_leave_its_momentum_alone(method):
    """A motor in a free housing drives a wheel; the other turns by the gear: the reactions sum up to nothing."""
    m = at_rest()
    housing = m.body("housing", mass=2.0, com=(0.0, 0.0), inertia=0.5)
    inertia, angles, ratio = (0.02, 0.1), [], -2.0
    for k in (0, 1):
        wheel = m.body(f"wheel {k}", mass=1e-9, com=(0.1 * k, 0.0), inertia=inertia[k])
        m.revolute(f"bearing {k}", housing, wheel, point=(0.1 * k, 0.0))
        angles.append(m.relative_angle(f"angle {k}", housing, wheel))
        m.sense_coordinate(f"rate.{k}", angles[k], order=1)
    m.gear("teeth", *angles, ratio=ratio)
    m.torque_on("motor", angles[0], input=m.input("torque"))
    m.sense_rotation("yaw", housing, "z", order=1)
    r = run(m, method, {"torque": 0.3})
    own, first, second = r["yaw"][-1], r["rate.0"][-1], r["rate.1"][-1]
    assert first == pytest.approx(ratio * second, rel=1e-6)
    assert (0.5 + 0.12) * own + 0.02 * first + 0.1 * second == pytest.approx(0.0, abs=close(method))
    # by hand: with u the rate of wheel 0 against the housing, the momenta to yaw rate and u
    M = np.array([[0.62, 0.02 + 0.1 / ratio], [0.02 + 0.1 / ratio, 0.02 + 0.1 / ratio**2]])
    assert np.array([own, first]) == pytest.approx(np.linalg.solve(M, [0.0, 0.3]), rel=close(method))


@pytest.mark.parametrize("method", FEW)
def test_geared_spins_count_from_their_carriers(method):
    """A torque on the carrier about the axis of two geared wheels: they must turn with it."""
    m = at_rest("spins", 3)
    carrier = m.body("carrier", mass=2.0, com=(0.0, 0.0, 0.0), inertia=(0.3, 0.3, 0.4))
    m.revolute("bearing", m.ground, carrier, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    wheels = [
        m.spin(f"wheel {k}", carrier=carrier, centre=(0.0, 0.0, 0.1 * k), axis=(0.0, 0.0, 1.0), mass=0.5,
               spin_inertia=inertia, diametral_inertia=inertia)
        for k, inertia in enumerate((0.02, 0.05))
    ]  # fmt: skip
    m.gear("teeth", *wheels, ratio=-2.0)
    m.torque("push", carrier, inputs=(None, None, m.input("torque")))
    m.sense_rotation("yaw", carrier, "z", order=1)
    for k, wheel in enumerate(wheels):
        m.sense_coordinate(f"rate.{k}", wheel, order=1)
    r = run(m, method, {"torque": 0.6}, h=0.002)
    # a - c = -2 (b - c): a = 3 c - 2 b
    T = np.array([[1.0, 0.0], [3.0, -2.0], [0.0, 1.0]])  # c, a, b from c, b
    M = T.T @ np.diag([0.4, 0.02, 0.05]) @ T
    c, b = np.linalg.solve(M, [0.6, 0.0])
    got = [r["yaw"][-1], r["rate.1"][-1], r["rate.0"][-1]]
    assert got == pytest.approx([c, b, 3.0 * c - 2.0 * b], rel=1e-4)


def pinion_and_rack():
    """A pinion on the ground, and a rack that slides along x."""
    m = at_rest("rack")
    pinion = m.body("pinion", mass=1.0, com=(0.0, 0.05), inertia=0.004)
    rod = m.body("rod", mass=2.0, com=(0.3, 0.0), inertia=0.1)
    m.revolute("bearing", m.ground, pinion, point=(0.0, 0.05))
    m.prismatic("guide", rod, m.ground, axis=(1.0, 0.0))
    angle = m.relative_angle("angle", m.ground, pinion)
    joint = m.rack("teeth", angle, rod, carrier=m.ground, axis=(1.0, 0.0), radius=0.05)
    m.sense_coordinate("angle", angle)
    m.sense_position("place", rod, (0.3, 0.0), "x")
    m.sense_joint("teeth.force", joint, "force")
    return m, angle


@pytest.mark.parametrize("method", FEW)
def test_the_force_on_a_driven_rack_is_that_of_its_load(method):
    m, angle = pinion_and_rack()
    m.torque_on("motor", angle, input=m.input("torque"))
    r = run(m, method, {"torque": 0.036})
    acceleration = 0.036 / 0.05 / (2.0 + 0.004 / 0.05**2)
    assert r["place"][-1] - 0.3 == pytest.approx(0.5 * acceleration, rel=close(method))
    assert r["teeth.force"][-1] == pytest.approx(2.0 * acceleration, rel=close(method))
    assert r.units["teeth.force"] == "N"


def test_a_rack_on_a_free_carrier_moves_it_back():
    """Momentum, angular momentum and the energy of a motor that is all inside."""
    m = at_rest("free rack")
    base = m.body("base", mass=3.0, com=(0.0, 0.0), inertia=0.2)
    pinion = m.body("pinion", mass=1.0, com=(0.1, 0.05), inertia=0.004)
    rod = m.body("rod", mass=2.0, com=(0.3, 0.02), inertia=0.1)
    m.revolute("bearing", base, pinion, point=(0.1, 0.05))
    m.prismatic("guide", rod, base, axis=(1.0, 0.3))
    angle = m.relative_angle("angle", base, pinion)
    m.rack("teeth", angle, rod, carrier=base, axis=(1.0, 0.3), radius=-0.05)
    m.torque_on("motor", angle, input=m.input("torque"))
    bodies = [(base, 3.0, 0.2, (0.0, 0.0)), (pinion, 1.0, 0.004, (0.1, 0.05)), (rod, 2.0, 0.1, (0.3, 0.02))]
    for k, (body, _, _, com) in enumerate(bodies):
        for c in "xy":
            m.sense_position(f"p{k}.{c}", body, com, c)
            m.sense_position(f"v{k}.{c}", body, com, c, order=1)
        m.sense_rotation(f"w{k}", body, "z", order=1)
    m.sense_coordinate("angle", angle)
    m.sense_energy("energy", "kinetic")
    r = run(m, "radau_5", {"torque": 0.2}, h=0.005)
    momentum = [sum(mass * r[f"v{k}.{c}"] for k, (_, mass, _, _) in enumerate(bodies)) for c in "xy"]
    spin = sum(
        mass * (r[f"p{k}.x"] * r[f"v{k}.y"] - r[f"p{k}.y"] * r[f"v{k}.x"]) + inertia * r[f"w{k}"]
        for k, (_, mass, inertia, _) in enumerate(bodies)
    )
    assert np.max(np.abs(momentum)) < 1e-8
    assert np.max(np.abs(spin)) < 1e-8
    assert np.max(np.abs(r["w0"])) > 0.03
    assert r["energy"][-1] == pytest.approx(0.2 * r["angle"][-1], rel=1e-7)


@pytest.mark.parametrize("method", FEW)
@pytest.mark.parametrize("pitch", [0.5, -0.8])
def test_a_nut_falls_on_a_screw(method, pitch):
    m = Model("nut", dimension=3)
    nut = m.body("nut", mass=1.5, com=(0.0, 0.0, 0.0), inertia=(0.01, 0.01, 0.02))
    joint = m.screw("thread", nut, m.ground, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), pitch=pitch)
    m.sense_position("z", nut, (0.0, 0.0, 0.0), "z")
    m.sense_coordinate("angle", joint.angle)
    m.sense_joint("force", joint, "force")
    assert compile(m).report["degrees_of_freedom"] == 1
    r = run(m, method, t_end=0.5)
    p = pitch / (2.0 * np.pi)
    a = 9.81 / (1.0 + 0.02 / (1.5 * p**2))
    assert r["z"][-1] == pytest.approx(-0.125 * a, rel=close(method))
    assert r["angle"][-1] == pytest.approx(-0.125 * a / p, rel=close(method))
    assert r["force"][-1] == pytest.approx(1.5 * (9.81 - a), rel=5e-4)


def bar_and_arms(**how):
    """Two arms of 0.2 m on the ground about x, joined by a bar."""
    m = at_rest("bar", 3)
    arms = []
    for name, y in (("left", 0.5), ("right", -0.5)):
        arm = m.body(name, mass=1.0, com=(0.2, y, 0.0), inertia=(0.001, 0.02, 0.02))
        m.revolute(f"{name} bush", m.ground, arm, point=(0.0, y, 0.0), axis=(0.0, 1.0, 0.0))
        arms.append(arm)
    bar = m.anti_roll_bar("bar", *arms, stiffness=300.0, carrier=m.ground, axis=(0.0, 1.0, 0.0), **how)
    m.sense_element("bar.torque", bar, "force")
    return m, arms


def test_a_bar_works_against_roll_alone():
    m, arms = bar_and_arms()
    modes = mbs.linearise(mbs.Simulation(compile(m))).modes
    # inertia of an arm about its bush 0.02 + 0.2^2; both against each other, and together without stiffness
    assert max(mode.frequency_hz for mode in modes) == pytest.approx(
        np.sqrt(2.0 * 300.0 / 0.06) / (2.0 * np.pi), rel=1e-5
    )
    assert min(mode.frequency_hz for mode in modes) < 1e-3
    for mirrored, sign in ((False, -1.0), (True, 1.0)):
        m, arms = bar_and_arms(mirrored=mirrored)
        m.initial_velocity(arms[0], linear=(0.0, 0.0, -0.2), angular=(0.0, 1.0, 0.0))
        m.initial_velocity(arms[1], linear=(0.0, 0.0, -0.2 * sign), angular=(0.0, sign, 0.0))
        r = run(m, "radau_5", h=0.002, t_end=0.3)
        w = np.sqrt(2.0 * 300.0 / 0.06)
        assert np.max(np.abs(r["bar.torque"] + 300.0 * 2.0 / w * np.sin(w * r.t))) < 1e-3 * 300.0 * 2.0 / w
    m, _ = bar_and_arms(free_twist=0.1)
    assert mbs.Simulation(compile(m)).sensors["bar.torque"] == pytest.approx(30.0)


def slides(m, a, b, **other):
    """Two bodies whose slides along x and y are coupled, the first one's twice as far."""
    usual = {"carrier_1": m.ground, "carrier_2": m.ground, "axis_1": (1, 0), "axis_2": (0, 1), "ratio": 2.0}
    return m.coupled_slides("c", a, b, **(usual | other))


@pytest.mark.parametrize("method", FEW)
def test_coupled_slides_carry_the_mass_of_both(method):
    """A force on the second, a = F / (m2 + ratio2 m1), of which the first takes what it needs."""
    m = at_rest("gripper")
    a, b = (m.body(n, mass=mass, com=(x, 0.1), inertia=1.0) for n, mass, x in (("a", 1.5, 0.0), ("b", 4.0, 1.0)))
    m.prismatic("guide a", a, m.ground, axis=(1.0, 0.0))
    m.prismatic("guide b", b, m.ground, axis=(0.0, 1.0))
    joint = slides(m, a, b, ratio=-2.0)
    m.force("push", b, inputs=(None, m.input("push", unit="N")))
    m.sense_position("a", a, None, "x")
    m.sense_position("b", b, None, "y")
    m.sense_joint("c.force", joint, "force")
    r = run(m, method, {"push": 5.0})
    acceleration = 5.0 / (4.0 + 4.0 * 1.5)
    assert r["b"][-1] - 0.1 == pytest.approx(0.5 * acceleration * r.t[-1] ** 2, rel=close(method))
    assert r["a"][-1] == pytest.approx(-2.0 * (r["b"][-1] - 0.1), rel=1e-9)
    assert r["c.force"][-1] == pytest.approx(-1.5 * 2.0 * acceleration, rel=close(method))


def planar_pair():
    m = at_rest()
    a, b = (m.body(n, mass=1.0, com=(x, 0.0), inertia=1.0) for n, x in (("a", 0.0), ("b", 1.0)))
    return m, a, b, m.relative_angle("angle a", m.ground, a), m.relative_angle("angle b", m.ground, b)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda m, a, b, x, y: m.gear("g", x, x, ratio=2.0), "couples 'angle a' with itself"),
        (lambda m, a, b, x, y: m.gear("g", x, y, ratio=0.0), "ratio of gear 'g' is 0"),
        (lambda m, a, b, x, y: m.rack("r", x, b, carrier=m.ground, axis=(1, 0), radius=0.0), "radius of rack 'r' is 0"),
        (lambda m, a, b, x, y: m.rack("r", x, m.ground, carrier=b, axis=(1, 0), radius=0.1), "is the ground"),
        (lambda m, a, b, x, y: slides(m, a, a), "couple 'a' with itself"),
        (lambda m, a, b, x, y: slides(m, a, b, ratio=0.0), "ratio of coupled slides 'c' is 0"),
        (lambda m, a, b, x, y: m.screw("s", a, b, point=(0, 0), axis=(1, 0), pitch=1.0), "needs a spatial model"),
        (lambda m, a, b, x, y: m.anti_roll_bar("k", x, x, stiffness=1.0), "joins 'angle a' with itself"),
        (lambda m, a, b, x, y: m.anti_roll_bar("k", a, b, stiffness=1.0), "needs the carrier"),
        (lambda m, a, b, x, y: m.anti_roll_bar("k", x, y, stiffness=1.0, carrier=a), "leave out its carrier"),
        (lambda m, a, b, x, y: m.anti_roll_bar("k", x, y, stiffness=0.0), "stiffness of the anti-roll bar 'k' is 0"),
    ],
)
def test_nonsense_is_refused_with_a_sentence(make, sentence):
    m, a, b, x, y = planar_pair()
    joints, elements = len(m.joints), len(m.elements)
    with pytest.raises((ModelError, ValueError), match=sentence):
        make(m, a, b, x, y)
    assert (len(m.joints), len(m.elements)) == (joints, elements)


@pytest.mark.parametrize("free", [False, True])
def test_a_ring_of_gears_that_cannot_turn_is_reported(free):
    """Three wheels of which each turns its neighbours the other way, also beside a wheel that turns."""

    def ring(ratios, rate=0.0):
        m = at_rest("ring")
        angles = []
        for k in range(4 if free else 3):
            body = m.body(f"wheel {k}", mass=1.0, com=(0.3 * k, 0.0), inertia=0.1)
            m.revolute(f"pin {k}", m.ground, body, point=(0.3 * k, 0.0))
            angles.append(m.relative_angle(f"angle {k}", m.ground, body))
        for k, ratio in enumerate(ratios):
            m.gear(f"gear {k}", angles[k], angles[(k + 1) % 3], ratio=ratio)
        m.torque_on("motor", angles[0], input=m.input("torque"))
        m.sense_coordinate("angle", angles[0])
        if rate:
            m.initial_rate(angles[1], rate)
        return m

    locked = run(ring((-1.0, -1.0, -1.0)), "ali3p", {"torque": 1.0}, t_end=0.1)
    assert abs(locked["angle"][-1]) < 1e-12
    message = "The gears 'gear 0', 'gear 1', 'gear 2' form a ring that is locked: 'angle 2' would have to turn -1 times"
    assert [text for text in locked.notices if text.startswith(message)]
    with pytest.raises(ModelError, match="form a ring that is locked" if free else "is locked"):
        compile(ring((-1.0, -1.0, -1.0), 2.0))
    turning = run(ring((-2.0, -3.0, 1.0 / 6.0)), "ali3p", {"torque": 1.0}, t_end=0.1)
    assert turning["angle"][-1] > 1e-2
    assert not turning.notices


@pytest.mark.parametrize(("ratio", "beside", "reported"), [(-1.0, True, True), (-1.0, False, True), (1.0, True, False)])
def test_a_ring_of_racks_that_cannot_move_is_reported(ratio, beside, reported):
    """Two pinions on one rack, which a gear turns against each other, also beside a wheel that turns."""
    m = at_rest("racks")
    angles = []
    for k in range(3 if beside else 2):
        body = m.body(f"wheel {k}", mass=1.0, com=(0.3 * k, 0.0), inertia=0.1)
        m.revolute(f"pin {k}", m.ground, body, point=(0.3 * k, 0.0))
        angles.append(m.relative_angle(f"angle {k}", m.ground, body))
    rack = m.body("rack", mass=1.0, com=(0.0, 0.5), inertia=0.1)
    m.prismatic("slide", m.ground, rack, axis=(1, 0), point=(0.0, 0.5))
    for k in range(2):
        m.rack(f"rack {k}", angles[k], rack, carrier=m.ground, axis=(1, 0), radius=0.1)
    m.gear("gear", angles[0], angles[1], ratio=ratio)
    notices = run(m, "ali3p", {}, t_end=0.1).notices
    message = (
        "Parts that cannot move, as their joints leave them no freedom: 'wheel 0', 'angle 0', 'wheel 1', 'angle 1', "
    )
    assert [text.startswith(message + "'rack'." if beside else "Nothing moves") for text in notices] == [
        True
    ] * reported


def test_parts_at_a_dead_centre_are_not_reported_as_locked():
    m = at_rest("crank")
    crank, rod, slider, wheel = (
        m.body(name, mass=1.0, com=(x, 0.0), inertia=0.1)
        for name, x in (("crank", 0.5), ("rod", 2.0), ("slider", 3.0), ("wheel", 5.0))
    )
    m.revolute("main", m.ground, crank, point=(0.0, 0.0))
    m.revolute("pin", crank, rod, point=(1.0, 0.0))
    m.revolute("gudgeon", rod, slider, point=(3.0, 0.0))
    m.prismatic("bore", m.ground, slider, axis=(1, 0), point=(3.0, 0.0))
    m.revolute("axle", m.ground, wheel, point=(5.0, 0.0))
    assert not run(m, "ali3p", {}, t_end=0.1).notices


def test_an_angle_of_a_body_on_two_pins_is_refused_with_a_message():
    m = at_rest("held")
    body = m.body("body", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    for k in range(2):
        m.revolute(f"pin {k}", m.ground, body, point=(float(k), 0.0))
    m.relative_angle("angle", m.ground, body)
    with pytest.raises(ModelError, match="'held' cannot move: its joints fix every coordinate that has mass"):
        compile(m)


def test_a_screw_without_pitch_is_refused():
    m = Model("s", dimension=3)
    nut = m.body("nut", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    with pytest.raises(ModelError, match="pitch of screw joint 's' is 0"):
        m.screw("s", nut, m.ground, point=(0, 0, 0), axis=(0, 0, 1), pitch=0.0)
