"""Small scenes with closed forms, for the tests of stepping and linearising."""

from mbs import Model, compile

GRAVITY = 9.81  # m/s2
LENGTH = 0.8  # m
MASS = 2.0  # kg


def pendulum_model(hanging=False, damped=False):
    """A particle on a massless rod, drawn level (or hanging), pushed along x and y by two inputs."""
    m = Model("pendulum", dimension=2, gravity=(0.0, -GRAVITY))
    start = (0.0, -LENGTH) if hanging else (LENGTH, 0.0)
    bob = m.point_mass("bob", mass=MASS, position=start)
    m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    push_x = m.input("push x", min=-100.0, max=100.0, unit="N")
    push_y = m.input("push y", unit="N")
    m.force("push", bob, start, inputs=(push_x, push_y))
    if damped:
        spring = m.spring_damper(
            "tie", (m.ground, (0.0, -2.0)), bob, stiffness=30.0, damping=1.5, free_length=2.0 - LENGTH
        )
        m.parameter("tie stiffness", 30.0, 0.0, 100.0, "N/m", targets=[(spring, "stiffness", 1.0)])
    m.sense_position("bob.x", bob, start, "x")
    m.sense_position("bob.y", bob, start, "y")
    m.sense_position("bob.vx", bob, start, "x", order=1)
    m.sense_position("bob.ax", bob, start, "x", order=2)
    m.sense_energy("energy", "total")
    m.sense_input("push", push_x)
    return m


def pendulum(**options):
    return compile(pendulum_model(**options))


def free_mass():
    """A particle without gravity, pushed along x by an input."""
    m = Model("free mass", dimension=2, gravity=(0.0, 0.0))
    body = m.point_mass("body", mass=MASS, position=(0.0, 0.0))
    push_x, push_y = m.input("push x", unit="N"), m.input("push y", unit="N")
    m.force("push", body, (0.0, 0.0), inputs=(push_x, push_y))
    m.sense_position("x", body, (0.0, 0.0), "x")
    m.sense_position("v", body, (0.0, 0.0), "x", order=1)
    m.sense_input("push", push_x)
    return compile(m)


def two_masses(stiffness, damping, spacing=1.0):
    """Ground - spring - mass - spring - mass on a straight guide along x, at the free lengths of the springs."""
    m = Model("two masses", dimension=2, gravity=(0.0, 0.0))
    ends = [(m.ground, (0.0, 0.0))]
    for i, (k, c) in enumerate(zip(stiffness, damping, strict=True)):
        place = ((i + 1) * spacing, 0.0)
        body = m.body(f"mass {i + 1}", mass=MASS, com=place, inertia=1.0)
        m.prismatic(f"guide {i + 1}", body, m.ground, axis=(1.0, 0.0), point=place)
        m.spring_damper(f"spring {i + 1}", ends[-1], (body, place), stiffness=k, damping=c, free_length=spacing)
        ends.append((body, place))
    return compile(m)
