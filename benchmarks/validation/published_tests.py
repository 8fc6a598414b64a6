"""Published figures of other tests beside the same figures of the cars of the package."""

from collections.abc import Callable, Sequence
from typing import Any

from benchmarks.shared.command import watched
from benchmarks.validation import acceleration, avoidance, commonroad, tyre_rig
from benchmarks.validation.commonroad_reference import CARS
from benchmarks.validation.published_figures import Published

COLUMNS = {"test": "", "published": "", "read within": ".2g", "car": ".4g", "verdict": ""}
_SOURCE = "its multi-body model"
_STORED = 1e-6  # of a value: six digits
_ASKED = (
    ("step_steer", "yaw_rate", "rad/s", "0.02 rad of the front wheels, as published: yaw rate after 3 s"),
    ("consistent_step_steer", "yaw_rate", "rad/s", "0.02 rad of the front wheels, consistent: yaw rate after 3 s"),
    ("consistent_step_steer", "roll", "rad", "0.02 rad of the front wheels, consistent: roll after 3 s"),
    ("consistent_step_steer", "y", "m", "0.02 rad of the front wheels, consistent: way to the side after 3 s"),
    ("braking", "vx", "m/s", "4 m/s² of brakes from 25 m/s: speed after 3 s"),
    ("braking", "pitch", "rad", "4 m/s² of brakes from 25 m/s: pitch after 3 s"),
)


def by_commonroad(cars: Sequence[str] = CARS) -> list[tuple[Published, float]]:
    """Last values of CommonRoad's model, of its stored runs, and of the cars here."""
    results = []
    for car in cars:
        for manoeuvre, quantity, unit, text in _ASKED:
            both = commonroad.compared(car, manoeuvre)
            published = float(both.reference[quantity][-1])
            figure = Published(f"{car}, {text}", unit, {_SOURCE: published}, _STORED * abs(published))
            results.append((figure, float(both.found[quantity][-1])))
    return results


PARTS: dict[str, Callable[[], list[tuple[Published, float]]]] = {
    "from rest": acceleration.compared,
    "avoidance": avoidance.compared,
    "tyre": tyre_rig.compared,
    "CommonRoad": by_commonroad,
}


def rows() -> list[dict[str, Any]]:
    """The table, in the order of the parts; those that fail stay in it."""
    return [figure.row(value) for part in watched(list(PARTS.values())) for figure, value in part()]
