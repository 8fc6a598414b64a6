"""Tyres of the prototype car: about 145/80 R12 in front and 155/80 R13 behind.

SI units, forces per tyre, slip in m/m. [P] the paper. The horizontal curves follow the load-proportional pattern of a
70 % section tyre in TMeasy (W. Hirschberg, G. Rill, H. Weinfurter, "Tire model TMeasy", Vehicle System Dynamics 45(S1),
2007, 101-119; numbers as in Project Chrono's TMeasy tyre) at a nominal load of 1500 N. [A] assumed.
"""

from __future__ import annotations

from mbs.elements.tyre import Tyre, TyreCurve

FRICTION = 1.2705  # dry asphalt: 1.125 times the 1694 N / 1500 N of the curves [A]
RADIUS = {"front": 0.27, "rear": 0.29}  # [P]
BOTTOMING_RADIUS = {"front": 0.18, "rear": 0.19}  # rim and 1 cm [A]

NOMINAL_LOAD = 1500.0  # N [A]

# pairs: at the nominal load and at twice of it
LONGITUDINAL = TyreCurve(
    slope=(27561.0, 58401.0),
    max_force=(1694.0, 3269.0),
    max_slip=(0.13913, 0.13913),
    slide_force=(1202.0, 2308.0),
    slide_slip=(0.66667, 0.66667),
)
LATERAL = TyreCurve(
    slope=(23974.0, 38553.0),
    max_force=(1501.0, 2741.0),
    max_slip=(0.14852, 0.18504),
    slide_force=(1250.0, 2320.0),
    slide_slip=(0.96524, 1.0714),
)


def tyre(axle: str) -> Tyre:
    """The tyre of the "front" or "rear" axle."""
    return Tyre(
        radius=RADIUS[axle],
        bottoming_radius=BOTTOMING_RADIUS[axle],
        stiffness=60000.0,  # [P]
        damping=200.0,  # [A]
        bottoming_stiffness=300000.0,  # five times the radial stiffness [A]
        longitudinal=LONGITUDINAL,
        lateral=LATERAL,
        trail=(0.178, 0.190),
        trail_zero=(0.16337, 0.20355),
        trail_end=(0.96524, 1.0714),
        carcass_stiffness=(150000.0, 80000.0),  # longitudinal, lateral [A]
        carcass_damping=(500.0, 500.0),  # [A]
        nominal_load=NOMINAL_LOAD,
        max_load_factor=3.5,
        rolling_resistance=0.015,  # [A]
    )
