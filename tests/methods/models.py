"""Small models for the tests of methods: a triangle of masses, a damped swing, an angle with a spring, a driven arm;
and what the tests of several methods ask of a run.
"""

import numpy as np
from scipy.interpolate import PPoly

from mbs import Model, Simulation, System, compile, simulate
from mbs.elements.spring_damper import EndStops
from mbs.model.body import Body


def triangle() -> Model:
    """Three free masses, a rod and two springs, in a plane without gravity, turning and stretching."""
    m = Model("triangle", dimension=2, gravity=(0.0, 0.0))
    places = {"a": (0.0, 0.0), "b": (1.0, 0.0), "c": (0.3, 0.8)}
    speeds = {"a": (0.4, -1.0), "b": (0.5, 1.5), "c": (-1.0, 0.2)}
    masses = {"a": 1.0, "b": 2.0, "c": 0.5}
    points = {}
    for name, place in places.items():
        points[name] = m.point_mass(name, mass=masses[name], position=place)
        m.initial_velocity(points[name], linear=speeds[name])
        for c in "xy":
            m.sense_position(f"{name}.{c}", points[name], None, c)
            m.sense_position(f"{name}.v{c}", points[name], None, c, order=1)
    m.distance("rod", points["a"], points["b"])
    m.spring_damper("ac", points["a"], points["c"], stiffness=300.0, free_length=0.7)
    m.spring_damper("bc", points["b"], points["c"], stiffness=500.0)
    m.sense_energy("energy", "total")
    return m


TRIANGLE_MASSES = {"a": 1.0, "b": 2.0, "c": 0.5}


def two_rods(name: str) -> tuple[Model, Body, Body]:
    """A double pendulum in a plane, drawn level."""
    m = Model(name, dimension=2)
    first = m.body("first", mass=1.0, com=(0.5, 0.0), inertia=1.0 / 12.0)
    second = m.body("second", mass=1.0, com=(1.5, 0.0), inertia=1.0 / 12.0)
    m.revolute("pivot", m.ground, first, point=(0.0, 0.0))
    m.revolute("knee", first, second, point=(1.0, 0.0))
    return m, first, second


def swing(damping: float, stops: bool = False) -> Model:
    """Two rods under gravity, their end held by a stiff spring-damper that also reaches its stops."""
    m, _, second = two_rods("swing")
    ends = EndStops(bump_length=1.1, bump_stiffness=4e3, rebound_length=1.6, rebound_stiffness=6e3) if stops else None
    element = m.spring_damper(
        "spring", (m.ground, (2.0, 1.4)), (second, (2.0, 0.0)), stiffness=200.0, damping=damping, stops=ends
    )
    m.sense_element("length", element, "length")
    m.sense_position("tip.y", second, (2.0, 0.0), "y")
    m.sense_energy("energy", "total")
    return m


def hinge(damping: float) -> Model:
    """A spatial pendulum with a spring and a damper on its unwrapped angle."""
    m = Model("hinge", dimension=3)
    rod = m.body("rod", mass=2.0, com=(0.4, 0.0, 0.0), inertia=(0.01, 0.1, 0.1))
    m.revolute("pivot", m.ground, rod, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rod, axis=(0.0, 1.0, 0.0))
    m.initial_rate(angle, 9.0)
    m.torsional_spring_damper("spring", angle, stiffness=1.5, damping=damping)
    m.sense_coordinate("angle", angle)
    m.sense_energy("energy", "total")
    return m


MOVED_S = 1.0


def driven() -> Model:
    """A pendulum on an arm whose angle a driving function turns by one radian within a second; then the arm stands."""
    m = Model("driven", dimension=2)
    arm = m.body("arm", mass=1.0, com=(0.5, 0.0), inertia=1.0 / 12.0)
    bob = m.body("bob", mass=1.0, com=(1.0, -0.3), inertia=0.02)
    m.revolute("pivot", m.ground, arm, point=(0.0, 0.0))
    m.revolute("end", arm, bob, point=(1.0, 0.0))
    angle = m.relative_angle("angle", m.ground, arm)
    rise = PPoly(np.array([[6.0], [-15.0], [10.0], [0.0], [0.0], [0.0]]), np.array([0.0, MOVED_S]))
    m.drive("motor", angle, m.guide_time("rise", rise, unit="rad"))
    m.sense_coordinate("angle", angle)
    m.sense_position("bob.x", bob, (1.0, -0.6), "x")
    m.sense_position("bob.y", bob, (1.0, -0.6), "y")
    m.sense_energy("energy", "total")
    return m


def end(system, names, t_end, h, settings):
    """Sensors at the end of a run."""
    run = simulate(system, t_end, h, settings=settings, every=round(t_end / h))
    return np.array([run[n][-1] for n in names])


def assert_saved_state_continues(system, settings):
    """A run that is saved half way and restored elsewhere, settings too, goes on bit for bit."""
    whole, first = Simulation(system, settings=settings), Simulation(system, settings=settings)
    whole.run(1.0, 0.02)
    first.run(0.5, 0.02)
    second = Simulation(system)
    second.restore(first.save())
    second.run(1.0, 0.02)
    assert whole.instance.save()[64:] == second.instance.save()[64:]


def sliding_mass(stiffness: float, damping: float, start: float, speed: float) -> System:
    """A mass on a line, its coordinate tied to zero."""
    m = Model("mass", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(start, 0.0))
    m.initial_velocity(mass, linear=(speed, 0.0))
    along = mass.point(None).components[0]
    m.torsional_spring_damper("tie", along, stiffness=stiffness, damping=damping, free_angle=0.0)
    m.sense_position("x", mass, None, "x")
    m.sense_position("v", mass, None, "x", order=1)
    m.sense_energy("energy", "total")
    return compile(m)
