"""A sledge under the names of a car, so that the host's car page is drawn without a car."""

import mbs

WHEELS = ("FL", "FR", "RL", "RR")


def sledge() -> mbs.Model:
    m = mbs.Model("sledge", dimension=2, gravity=(0.0, 0.0))
    m.floating = True
    body = m.body("chassis", mass=500.0, com=(0.0, 0.0), inertia=600.0)
    steering = m.input("steering", min=-1.0, max=1.0)
    throttle = m.input("throttle", min=0.0, max=1.0)
    brake = m.input("brake", min=0.0, max=1.0)
    m.torque("rudder", body, inputs=steering)
    m.force("engine", body, inputs=(throttle, steering), axes="body")
    for component in "xy":
        m.sense_position(f"chassis.{component}", body, component=component)
        m.sense_position(f"chassis.a{component}", body, component=component, order=2, axes="body")
    m.sense_angle("chassis.yaw", body, "yaw")
    m.sense_rotation("chassis.wz", body, order=1)
    m.sense_vector("speed", body.point((0.0, 0.0)), order=1, unit="m/s")
    for wheel in WHEELS:
        m.sense_input(f"wheel_{wheel}.Fz", brake, unit="N")
    m.sense_solver("solver.iterations", "iterations")
    return m


def tuned() -> mbs.Model:
    """A mass on a spring; stiffness and damping are tunable, the free length is fixed."""
    m = mbs.Model("tuned", dimension=2)
    bob = m.point_mass("bob", mass=2.0, position=(0.0, -1.0))
    pull = m.input("pull", min=-50.0, max=50.0, unit="N", description="Force to the right")
    m.force("pull", bob, inputs=(pull, None))
    spring = m.spring_damper("spring", (m.ground, (0.0, 0.0)), bob, stiffness=100.0, damping=1.0, free_length=0.8)
    for name, value, low, high, unit, fixed in (
        ("stiffness", 100.0, 10.0, 900.0, "N/m", False),
        ("damping", 1.0, 0.0, 20.0, "N.s/m", False),
        ("free_length", 0.8, 0.1, 2.0, "m", True),
    ):
        target = (spring, name, 1.0)
        m.parameter(
            f"spring.{name}", value, low, high, unit, f"Of the spring: {name}", targets=[target], tunable=not fixed
        )
    m.sense_position("bob.x", bob, component="x")
    m.sense_position("bob.y", bob, component="y")
    m.constant("spring.mass", 0.1, "kg", "Of the spring itself")
    return m


def turntable() -> mbs.Model:
    """A disc that a torque turns against a damper; its heading is wrapped."""
    m = mbs.Model("turntable", dimension=2, gravity=(0.0, 0.0))
    disc = m.body("chassis", mass=2.0, com=(0.0, 0.0), inertia=1.0)
    m.revolute("axle", m.ground, disc, point=(0.0, 0.0))
    angle = m.relative_angle("turned", m.ground, disc)
    damper = m.torsional_spring_damper("damper", angle, stiffness=0.0, damping=1.0)
    m.torque("motor", disc, inputs=m.input("pull", min=-50.0, max=50.0, unit="N.m"))
    m.parameter("damping", 1.0, 0.1, 10.0, "N.m.s/rad", targets=[(damper, "damping", 1.0)])
    m.sense_angle("chassis.yaw", disc, "yaw")
    m.sense_rotation("chassis.wz", disc, order=1)
    return m


def switched() -> mbs.Model:
    """An input that is a whole number beside one that is not, and what the model sees of them."""
    m = mbs.Model("switched", dimension=2, gravity=(0.0, 0.0))
    bob = m.point_mass("bob", mass=1.0, position=(0.0, 0.0))
    pull = m.input("pull", min=-5.0, max=5.0, unit="N")
    gear = m.input("gear", min=-1.0, max=3.0, start=1.0, whole=True)
    m.force("pull", bob, inputs=(pull, None))
    m.sense_input("gear_used", gear)
    m.sense_position("bob.x", bob, component="x")
    return m
