"""A light car's tyre for the tests: 155/80 R13 class, project data, in the form of the element."""

import numpy as np

from mbs.elements import PlaneRoad, Road, Tyre, TyreCurve
from tests.elements.harness import Element, vectors

LONGITUDINAL = TyreCurve((27561.0, 58401.0), (1694.0, 3269.0), (0.13913, 0.13913), (1202.0, 2308.0), (0.66667, 0.66667))
LATERAL = TyreCurve((23974.0, 38553.0), (1501.0, 2741.0), (0.14852, 0.18504), (1250.0, 2320.0), (0.96524, 1.0714))
TYRE = Tyre(
    radius=0.27,
    bottoming_radius=0.18,
    stiffness=60000.0,
    damping=200.0,
    bottoming_stiffness=300000.0,
    longitudinal=LONGITUDINAL,
    lateral=LATERAL,
    trail=(0.178, 0.190),
    trail_zero=(0.16337, 0.20355),
    trail_end=(0.96524, 1.0714),
    carcass_stiffness=(150000.0, 80000.0),
    carcass_damping=(500.0, 500.0),
    nominal_load=1500.0,
    reference_friction=1694.0 / 1500.0,
    rolling_resistance=0.015,
)


def tyre_element(tyre: Tyre = TYRE, road: Road | None = None) -> Element:
    """The tyre on a road; without one on a level plane with the friction at which its curves hold."""
    centre, axis, spin = vectors(3, 3, 1)
    record = tyre.record("tyre", centre, axis, spin[0], 0)
    return Element(record, PlaneRoad(friction=tyre.reference_friction) if road is None else road)


def upright(height: float, x: float = 0.0) -> np.ndarray:
    """Signals of a wheel upright at `height` heading along x."""
    return np.array([x, 0.0, height, 0.0, 1.0, 0.0, 0.0])
