"""The road under a car that is given no other: level with a kerb, far away unless set."""

from __future__ import annotations

import math

import numpy as np

from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad, Road
from mbs.model import Model
from mbs.vehicle.quantities import RoadFriction
from mbs.vehicle.section import Section

FAR_AWAY = 1e6  # m: the default kerb lies where no manoeuvre goes
KERB_HEIGHT = 0.08  # m, of the paper's test


class RoadSection(Section):
    """Road under the car."""

    friction: RoadFriction
    """Largest longitudinal tyre force over load at the tyre's nominal load."""

    def default(self) -> KerbRoad:
        """Level ground with a kerb."""
        return KerbRoad(FAR_AWAY, KERB_HEIGHT, -KERB_HEIGHT, "before", self.friction)

    def parameters(self, m: Model, road: Road | None, ground: int, nominal_load: float) -> None:
        """What a user may set of the road.

        Parameters
        ----------
        m : Model
            The car.
        road : Road or None
            Under it; None: `default`.
        ground : int
            Its number in the model.
        nominal_load : float
            Of the tyres, N, for the description.
        """
        names = (road or KerbRoad).real_names
        target = ("road", ground)
        if "friction" in names:
            friction = (
                road.friction if isinstance(road, KerbRoad | PlaneRoad) else self.friction if road is None else 1.0
            )
            m.parameter(
                "road.friction",
                friction,
                0.0,
                2.0,
                "1",
                ("factor on the friction of the road" if isinstance(road, GridRoad) else "friction coefficient")
                + f": largest longitudinal tyre force over load at {nominal_load:g} N",
                targets=[(target, names.index("friction"), 1.0)],
            )
        if road is None:
            place, low, step = (names.index(n) for n in ("position", "lower_height", "step"))
            m.parameter(
                "road.kerb_x",
                FAR_AWAY,
                -FAR_AWAY,
                FAR_AWAY,
                "m",
                "x of the kerb's edge",
                targets=[(target, place, 1.0)],
            )
            m.parameter(
                "road.kerb_height",
                KERB_HEIGHT,
                0.001,
                0.5,
                "m",
                "drop behind the kerb's edge",
                targets=[(target, low, -1.0), (target, step, 1.0)],
            )


def level_within(road: Road | None, footprint: tuple[tuple[float, float], tuple[float, float]]) -> bool:
    """Whether a road is level under the car as drawn.

    Parameters
    ----------
    road : Road or None
        None: level.
    footprint : pair of (float, float)
        Least and largest x and y of the car, m.
    """
    if isinstance(road, PlaneRoad):
        return road.grade_x == 0.0 and road.grade_y == 0.0
    if isinstance(road, GridRoad):
        heights = np.asarray(road.heights, float)
        cells = []
        for k, (low, high) in enumerate(footprint):
            # a cell takes its slopes from one point more on each side
            first = math.floor((low - road.origin[k]) / road.spacing[k]) - 1
            last = math.ceil((high - road.origin[k]) / road.spacing[k]) + 1
            cells.append(np.clip(np.arange(first, last + 1), 0, heights.shape[k] - 1))
        return float(np.ptp(heights[np.ix_(*cells)])) == 0.0
    return True
