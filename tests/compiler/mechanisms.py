"""Models that between them use every kind of row."""

from functools import cache

import numpy as np

from mbs import Model, System, compile
from mbs.scenes import bricard, double_four_bar


def rows_of_every_kind():
    """A spatial tree and loop with universal, cylindrical, line, distance, angle, sliding and driven rows."""
    m = Model("every row")
    inertia = np.array([[0.3, 0.02, -0.01], [0.02, 0.25, 0.03], [-0.01, 0.03, 0.4]])
    places = np.array([(0.4, 0.1, 0.0), (0.9, 0.5, 0.2), (1.5, 0.3, -0.4), (0.2, 0.9, 0.8), (1.1, 1.2, 0.3)])
    a, b, c, d, e = (m.body(f"body {k}", mass=1.0 + 0.3 * k, com=p, inertia=inertia) for k, p in enumerate(places))
    m.revolute("hinge", m.ground, a, point=(0, 0, 0), axis=(0.1, 0.2, 1.0))
    m.universal("cross", a, b, point=(0.7, 0.3, 0.1), axis_1=(0, 1, 0.2), axis_2=(1, 0, 0.1))
    m.cylindrical("tube", b, c, point=(1.2, 0.4, 0.0), axis=(1, -0.2, 0.3))
    m.point_on_line("line", (d, (0.3, 0.8, 0.7)), (a, (0.3, 0.8, 0.7)), axis=(0.5, 1, 0))
    m.prismatic("slide", e, d, point=(0.8, 1.0, 0.5), axis=(0, 1, 1))
    m.distance("rod", (d, (0.1, 1.1, 0.9)), (c, (1.4, 0.2, -0.3)))
    theta = m.relative_angle("theta", a, b, axis=(1, 0.3, 0.2), zero=0.3)
    m.armature("rotor", theta, inertia=0.01)
    steer = m.input("steer", start=0.05, min=-1.0, max=1.0)
    rack = m.guide_input("rack", input=steer, gain=0.5, frequency=2.0)
    m.distance(
        "tie", m.slide("end", a, point=(0.2, -0.3, 0.1), direction=(0, 0.6, 0.8), guide=rack), (b, (1, 0.2, 0.5))
    )
    wheel = m.spin(
        "wheel", carrier=e, centre=(1.2, 1.3, 0.3), axis=(0, 1, 0), mass=2.0, spin_inertia=0.2, diametral_inertia=0.12
    )
    m.initial_rate(wheel, 20.0)
    m.initial_velocity(a, linear=(0.1, -0.2, 0.0), angular=(0.0, 0.1, 0.6))
    m.spring_damper("spring", (m.ground, (0.0, 0.0, 1.0)), (c, (1.5, 0.3, -0.4)), stiffness=50.0, damping=2.0)
    return m


MODELS = {
    "every row": rows_of_every_kind,
    "bricard": bricard.build,
    "four-bar": lambda: double_four_bar.build(3),
    "long four-bar": lambda: double_four_bar.build(40),
}


@cache
def compiled(name: str) -> System:
    """The System of a model."""
    return compile(MODELS[name]())
