"""A sledge under the names of a car, so that the host's car page is drawn without a car."""

from __future__ import annotations

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
        m.sense_acceleration(f"chassis.a{component}", body, component=component, axes="body")
    m.sense_yaw("chassis.yaw", body)
    m.sense_angular_rate("chassis.wz", body)
    m.sense_norm("speed", body.point((0.0, 0.0)), 1, "m/s")
    for wheel in WHEELS:
        m.sense_input(f"wheel_{wheel}.Fz", brake, unit="N")
    m.sense_solver("solver.iterations", "iterations")
    return m
