"""Scenes that start in static equilibrium, with a spring or a payload as a parameter."""

from dataclasses import replace

from mbs import Model
from mbs.elements.input_force import InputForce
from mbs.scenes import prototype_car

MASS = 2.0  # kg
STIFFNESS = 1000.0  # N/m
FRONT = ("spring FL", "spring FR")


def hanging() -> Model:
    """A mass that hangs on a spring below the origin, guided along z; its length without load is 1 m."""
    m = Model("hanging mass")
    mass = m.body("mass", mass=MASS, com=(0.0, 0.0, -1.0), inertia=(0.1, 0.1, 0.1))
    m.prismatic("guide", mass, m.ground, axis=(0, 0, 1))
    spring = m.spring_damper(
        "spring", (m.ground, (0.0, 0.0, 0.0)), (mass, (0.0, 0.0, -1.0)), stiffness=STIFFNESS, free_length=1.0
    )
    m.parameter("k", STIFFNESS, 0.0, 1e4, "N/m", "stiffness", targets=[(spring, "stiffness", 1.0)])
    one = m.input("one", start=1.0, min=0.0, max=1.0)
    load = m.add(InputForce(one.index, (0.0,)).record("payload", [mass.point((0.0, 0.0, -1.0))[2]]))
    m.parameter("payload", 0.0, 0.0, 100.0, "N", "weight of the payload", targets=[(load, "weight_0", -1.0)])
    m.sense_position("z", mass, (0.0, 0.0, -1.0), "z")
    m.start_in_equilibrium = True
    return m


def car(stiffness: float, fidelity: int = 0) -> Model:
    """The prototype car built with front springs of another stiffness, N/m, which is the parameter front.stiffness."""
    m = prototype_car.build(None, fidelity)
    for k, element in enumerate(m.elements):
        if element.name in FRONT:
            real = list(element.real)
            real[list(element.real_names).index("stiffness")] = stiffness
            m.elements[k] = replace(element, real=tuple(real))
    m.parameters = [p for p in m.parameters if p.name != "front.spring.stiffness"]  # a number has one parameter
    targets = [(name, "stiffness", 1.0) for name in FRONT]
    m.parameter("front.stiffness", stiffness, 5e3, 4e4, "N/m", "stiffness of the front springs", targets=targets)
    return m
