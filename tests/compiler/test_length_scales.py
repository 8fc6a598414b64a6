"""A mechanism is the same at every size: no tolerance of the compiler is a length of its own."""

import numpy as np
import pytest
from scipy.interpolate import PPoly
from scipy.optimize import brentq
from scipy.special import ellipk

from mbs import Model, ModelError, Simulation, compile, simulate
from mbs.elements import ContactPoints, PlaneRoad
from mbs.settings.settings import Settings

SIZES = [1e-9, 1e5]
SWING = 0.5
"""Half of the swing of the pendulum, rad."""


def pendulum(size):
    """A rod of `size`, m, and the period of its swing, s."""
    m = Model("pendulum")
    com = (size * np.sin(SWING), 0.0, -size * np.cos(SWING))
    rod = m.body("rod", mass=1.0, com=com, inertia=3 * (0.1 * size**2,))
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    m.sense_position("x", rod, com, "x")
    return m, 4.0 * np.sqrt(1.1 * size / 9.81) * ellipk(np.sin(SWING / 2.0) ** 2)


@pytest.mark.parametrize("size", SIZES)
def test_the_period_of_a_pendulum_is_that_of_the_closed_form(size):
    model, period = pendulum(size)
    system = compile(model)
    for run in (simulate(system, 3.0 * period, tolerance=1e-6), simulate(system, 3.0 * period, period / 2000.0)):
        assert run["x"][-1] / size == pytest.approx(np.sin(SWING), abs=1e-7)
        assert np.ptp(run["x"]) / size == pytest.approx(2.0 * np.sin(SWING), abs=1e-4)


def test_a_start_that_closes_to_round_off_is_one():
    """2e-16 of 1e8 m is more than the nanometre to which smaller things are closed."""
    size = 1e8
    m = Model("pendulum", dimension=2, gravity=(0.0, -9.81))
    com = (0.6 * size, -0.8 * size)
    rod = m.body("rod", mass=1.0, com=com, inertia=size**2 / 12.0)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    m.sense_position("x", rod, com, "x")
    period = 4.0 * np.sqrt(13.0 / 12.0 * size / 9.81) * ellipk(np.sin(np.arctan2(0.6, 0.8) / 2.0) ** 2)
    run = simulate(compile(m), 0.5 * period, period / 4000.0)
    assert run["x"][-1] / size == pytest.approx(-0.6, abs=1e-6)


def test_an_inertia_without_mass_is_no_length():
    """Of wheels whose mass their carrier has: by their radii of gyration tolerances of steps were 200 times wider."""
    m = Model("wheels", dimension=2)
    box = m.body("box", mass=2.0, com=(0.0, 0.0), inertia=0.5)
    wheel = m.body("wheel", mass=1e-9, com=(0.1, 0.0), inertia=0.1)
    m.revolute("bearing", box, wheel, point=(0.1, 0.0))
    system = compile(m)
    assert system.report["length"] == pytest.approx(2.0 * np.sqrt(0.6 / 2.0), rel=1e-6)
    assert system.fineness == 1.0


def double_pendulum(size):
    """Two rods in space on a ball joint and a universal joint that swing little about their rest."""
    m = Model("double pendulum")
    inertia = size**2 * np.array([0.1, 0.1, 0.02])
    upper, lower = size * np.array([0.06, 0.03, -1.0]), size * np.array([0.1, -0.05, -1.0])
    a = m.body("a", mass=1.0, com=0.5 * upper, inertia=inertia)
    b = m.body("b", mass=1.0, com=upper + 0.5 * lower, inertia=inertia)
    m.spherical("top", a, m.ground, point=np.zeros(3))
    m.universal("middle", a, b, point=upper, axis_1=(1.0, 0.0, 0.0), axis_2=(0.0, 1.0, 0.0))
    m.sense_position("p", b, upper + lower, "x")
    return m


def geared(size):
    """Two wheels that a gear ties, one of them out of balance, and a rack that the other moves on a spring."""
    m = Model("gears", dimension=2, gravity=(0.0, -9.81))
    angles = []
    for name, x, off, inertia in (("first", 0.0, 0.1, 0.1), ("second", 1.0, 0.0, 0.05)):
        wheel = m.body(name, mass=1.0, com=((x + off) * size, 0.0), inertia=inertia * size**2)
        m.revolute(f"pin {name}", m.ground, wheel, point=(x * size, 0.0))
        angles.append(m.relative_angle(name, m.ground, wheel))
    m.gear("mesh", *angles, ratio=-2.0)
    rack = m.body("rack", mass=0.5, com=(1.5 * size, -0.2 * size), inertia=0.01 * size**2)
    m.prismatic("guide", rack, m.ground, axis=(1.0, 0.0))
    m.rack("teeth", angles[1], rack, carrier=m.ground, axis=(1.0, 0.0), radius=0.2 * size)
    end = rack, (1.5 * size, -0.2 * size)
    m.spring_damper("spring", (m.ground, (3.0 * size, -0.2 * size)), end, stiffness=20.0 / size, free_length=size)
    m.sense_position("p", rack, end[1], "x")
    return m


def bouncing(size):
    """A ball that bounces and slides on a road until it rests."""
    m = Model("ball")
    ball = m.body("ball", mass=1.0, com=(0.0, 0.0, 1.3 * size), inertia=3 * (0.4 * size**2,))
    rest = ContactPoints.for_mass(1.0, 0.1 * size, onset=0.1 * size, friction_factor=0.5, radius=size)
    m.contact_point("contact", ball, (0.0, 0.0, 1.3 * size), road=m.road(PlaneRoad()), contact=rest)
    m.initial_velocity(ball, (np.sqrt(size), 0.0, 0.0), (0.0, 0.0, 0.0))
    m.sense_position("p", ball, (0.0, 0.0, 1.3 * size), "z")
    return m


MECHANISMS = {
    "gears": geared,
    "contact": bouncing,
    "double pendulum": double_pendulum,
}


@pytest.mark.parametrize("name", MECHANISMS)
def test_similar_mechanisms_move_alike(name):
    """Ten periods at every size, times by the root of the length: to 1e-6 of the motion.

    No step is divided: forces of contacts divide steps by their rates in 1/s, which is no part of a period.
    """
    results = {}
    for size in (1.0, 1e-6, 1e7):
        time = 2.0 * np.sqrt(size)
        run = Simulation(compile(MECHANISMS[name](size)), settings=Settings(max_halvings=0)).run(
            10.0 * time, time / 200.0
        )
        results[size] = run["p"] / size
    for size, motion in results.items():
        np.testing.assert_allclose(
            motion, results[1.0], rtol=0, atol=1e-6 * np.ptp(results[1.0]), err_msg=f"{size:g} m"
        )


def rods(size, ratio):
    """Two rods between the same points, the second `ratio` times as long."""
    m = Model("rods", dimension=2)
    body = m.body("body", mass=1.0, com=(0.5 * size, 0.0), inertia=0.1 * size**2)
    for name, length in (("one", 2.0), ("two", 2.0 * ratio)):
        m.distance(name, (body, (size, 0.0)), (m.ground, (3.0 * size, 0.0)), length=length * size)
    return m


@pytest.mark.parametrize("size", SIZES)
def test_rods_of_other_lengths_contradict_each_other(size):
    assert compile(rods(size, 1.0)).report["dependent_rows"] == 1
    with pytest.raises(ModelError, match="'one', 'two' contradict each other"):
        compile(rods(size, 1.001))


@pytest.mark.parametrize("size", SIZES)
def test_a_loop_that_does_not_close_is_refused(size):
    m = Model("loop", dimension=2)
    body = m.body("body", mass=1.0, com=(0.5 * size, 0.0), inertia=0.1 * size**2)
    m.revolute("pin", m.ground, body, point=(0.0, 0.0))
    m.distance("rod", (body, (size, 0.0)), (m.ground, (3.0 * size, 0.0)), length=1.999 * size)
    with pytest.raises(ModelError, match="cannot be closed|contradict each other"):
        compile(m)


@pytest.mark.parametrize("size", [1e-9, 1e3])
def test_the_torque_of_a_drive_and_the_speed_of_a_gear_are_those_of_the_closed_form(size):
    """Angles have no mass: the penalty of what joins them alone is that of a lever."""
    duration = np.sqrt(size)
    m = Model("drive", dimension=2, gravity=(0.0, 0.0))
    rod = m.body("rod", mass=1.0, com=(size, 0.0), inertia=0.1 * size**2)
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    turn = PPoly(np.array([[0.5 / size], [0.0], [0.0]]), [0.0, duration])
    drive = m.drive("drive", m.relative_angle("angle", m.ground, rod), m.guide_time("turn", turn, unit="rad"))
    m.sense_joint("torque", drive, "drive")
    run = simulate(compile(m), duration, duration / 1000.0)
    assert run["torque"][1:-1] == pytest.approx(1.1 * size, rel=5e-3, abs=0.0)

    m = Model("gear", gravity=(0.0, 0.0, 0.0))
    wheels = []
    for name, x, inertia in (("input", 0.0, 0.01), ("output", 0.3 * size, 0.09)):
        wheel = m.body(name, mass=1.0, com=(x, 0.0, 0.0), inertia=3 * (inertia * size**2,))
        m.revolute(f"bearing {name}", m.ground, wheel, point=(x, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
        wheels.append(m.relative_angle(f"angle {name}", m.ground, wheel, axis=(0.0, 0.0, 1.0)))
    m.gear("mesh", *wheels, ratio=-3.0)
    m.torque_on("motor", wheels[0], input=m.input("torque", start=0.2 * size))
    m.sense_coordinate("speed", wheels[0], order=1)
    run = simulate(compile(m), duration, duration / 1000.0)
    assert run["speed"][-1] == pytest.approx(0.2 * size / (0.02 * size**2) * duration, rel=1e-3)


@pytest.mark.parametrize("size", SIZES)
def test_a_slide_that_swings_has_two_freedoms(size):
    """Its condition is linear in positions and quadratic in axes: in a small model it was taken for round-off."""
    m = Model("slide")
    arm = m.body("arm", mass=1.0, com=(0.0, 0.0, -0.5 * size), inertia=size**2 * np.array([0.1, 0.1, 0.02]))
    block = m.body("block", mass=0.5, com=(0.0, 0.1 * size, -size), inertia=size**2 * np.array([0.02, 0.02, 0.01]))
    m.revolute("pin", m.ground, arm, point=(0.0, 0.0, 0.0), axis=(1.0, 0.2, 0.0))
    m.prismatic("slide", arm, block, axis=(0.0, 0.0, 1.0))
    assert compile(m).report["degrees_of_freedom"] == 2


def test_a_loop_that_is_drawn_too_far_from_the_origin_is_refused() -> None:
    """At 5e6 m it ran, with a point 2.5e6 m away from where it was drawn; at 1e5 m no joint was named."""
    ends = []
    for far in (0.0, 1e2, 1e3):
        ends.append(simulate(compile(_four_bar_at(far)), 0.4, 0.001, progress=False)["y"][-1] - far)
    assert ends == pytest.approx([ends[0]] * 3, abs=1e-9)
    for far in (1e4, 5e6):
        with pytest.raises(ModelError, match=r"lies .* m from the origin, .* Draw it nearer"):
            compile(_four_bar_at(far))


def _four_bar_at(far: float) -> Model:
    m = Model("four-bar", dimension=2)
    at = [far, far]
    a = m.body("a", mass=1.0, com=np.add(at, [0.0, 0.25]), inertia=0.02)
    b = m.body("b", mass=2.0, com=np.add(at, [0.5, 0.5]), inertia=0.2)
    c = m.body("c", mass=1.0, com=np.add(at, [1.1, 0.25]), inertia=0.03)
    joints = ((m.ground, a, [0.0, 0.0]), (a, b, [0.0, 0.5]), (b, c, [1.0, 0.5]), (c, m.ground, [1.2, 0.0]))
    for k, (first, second, point) in enumerate(joints):
        m.revolute(str(k), first, second, point=np.add(at, point))
    m.sense_position("y", b, np.add(at, [0.5, 0.5]), "y")
    return m


@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_given_rates_are_kept_at_any_size(size):
    """Four bars in a row, whose rates add up, and the crank of a four-bar: a rate weighs as the inertia it moves."""
    chain, before, rates = Model("chain", dimension=2), None, {}
    for k in range(4):
        bar = chain.body(f"bar {k}", mass=1.0, com=((k + 0.5) * size, 0.0), inertia=size**2 / 12.0)
        chain.revolute(f"pin {k}", before or chain.ground, bar, point=(k * size, 0.0))
        angle = chain.relative_angle(f"angle {k}", before or chain.ground, bar)
        rates[f"rate {k}"] = k + 1.0
        chain.initial_rate(angle, k + 1.0)
        chain.sense_coordinate(f"rate {k}", angle, order=1)
        before = bar
    now = Simulation(compile(chain)).sensors
    assert {name: now[name] for name in rates} == pytest.approx(rates, rel=1e-9)

    loop, corners = Model("four-bar", dimension=2), size * np.array([[0.0, 0.0], [0.0, 1.0], [2.0, 1.5], [2.0, 0.0]])
    bars = [
        loop.body(f"bar {k}", mass=1.0, com=0.5 * (corners[k] + corners[k + 1]), inertia=size**2 / 12.0)
        for k in range(3)
    ]
    for k, pair in enumerate(zip([loop.ground, *bars], [*bars, loop.ground], strict=True)):
        loop.revolute(f"pin {k}", *pair, point=corners[k])
    angle = loop.relative_angle("crank", loop.ground, bars[0])
    loop.initial_rate(angle, 5.0)
    loop.sense_coordinate("rate", angle, order=1)
    assert Simulation(compile(loop)).sensors["rate"] == pytest.approx(5.0, rel=1e-9)


@pytest.mark.parametrize(("size", "mass"), [(1e-6, 1e-12), (1.0, 1.0), (100.0, 1e3), (1e5, 1e6)])
def test_the_equilibrium_is_found_at_any_size_and_weight(size, mass):
    """A rod on a torsion spring, drawn 49 degrees away, and a mass between three springs.

    With steps of 0.1 m it was refused from 100 m on, and a watch was left out of balance by 4e-4 of its weight.
    """
    drawn, weight = 1.2, 9.81 * mass
    rod_model = Model("rod", dimension=2)
    rod_model.start_in_equilibrium = True
    rod = rod_model.body(
        "rod", mass=mass, com=0.5 * size * np.array([np.sin(drawn), -np.cos(drawn)]), inertia=mass * size**2 / 12.0
    )
    rod_model.revolute("pin", rod_model.ground, rod, point=(0.0, 0.0))
    angle = rod_model.relative_angle("angle", rod_model.ground, rod)
    rod_model.torsional_spring_damper("spring", angle, stiffness=0.2 * weight * size)
    rod_model.sense_coordinate("angle", angle)
    rest = brentq(lambda turned: 0.5 * np.sin(drawn + turned) + 0.2 * turned, -drawn, 0.0)
    assert Simulation(compile(rod_model)).sensors["angle"] == pytest.approx(rest, abs=1e-6)

    net = Model("net", dimension=2, length=size)
    net.start_in_equilibrium = True
    knot = net.point_mass("knot", mass=mass, position=size * np.array([0.4, -0.7]))
    corners = size * np.array([[-1.0, 0.0], [1.0, 0.3], [0.2, -1.5]])
    for k, corner in enumerate(corners):
        net.spring_damper(
            str(k), (net.ground, corner), (knot, None), stiffness=(3.0 + k) * weight / size, free_length=0.4 * size
        )
    for axis in "xy":
        net.sense_position(axis, knot, None, axis)
    at = Simulation(compile(net)).sensors
    spans = corners - [at["x"], at["y"]]
    lengths = np.linalg.norm(spans, axis=1)
    pulls = np.array([3.0, 4.0, 5.0]) * weight * (lengths / size - 0.4) / lengths
    assert pulls @ spans == pytest.approx([0.0, weight], abs=1e-6 * weight)
