"""Published figures of tests, beside figures of the cars of the package."""

from collections.abc import Callable, Sequence
from typing import Any

from benchmarks.shared.command import watched
from benchmarks.validation import acceleration, avoidance, commonroad, tyre_rig
from benchmarks.validation.commonroad_reference import CARS
from benchmarks.validation.published_figures import Published

COLUMNS = {"test": "", "published": "", "read within": ".2g", "car": ".4g", "verdict": ""}
_SOURCE = "its multi-body model"
_STORED = 1e-6  # relative rounding of the stored values
_QUANTITIES = (
    ("step_steer", "yaw_rate", "rad/s", "0.02 rad of the front wheels, as published: yaw rate after 3 s"),
    ("consistent_step_steer", "yaw_rate", "rad/s", "0.02 rad of the front wheels, consistent: yaw rate after 3 s"),
    ("consistent_step_steer", "roll", "rad", "0.02 rad of the front wheels, consistent: roll after 3 s"),
    ("consistent_step_steer", "y", "m", "0.02 rad of the front wheels, consistent: way to the side after 3 s"),
    ("braking", "vx", "m/s", "4 m/s² of brakes from 25 m/s: speed after 3 s"),
    ("braking", "pitch", "rad", "4 m/s² of brakes from 25 m/s: pitch after 3 s"),
)


def by_commonroad(cars: Sequence[str] = CARS) -> list[tuple[Published, float]]:
    """Final values of CommonRoad's model, from its stored runs, each with the value of the car here."""
    results = []
    for car in cars:
        for manoeuvre, quantity, unit, text in _QUANTITIES:
            both = commonroad.compare(car, manoeuvre)
            published = float(both.reference[quantity][-1])
            figure = Published(f"{car}, {text}", unit, {_SOURCE: published}, _STORED * abs(published))
            results.append((figure, float(both.simulated[quantity][-1])))
    return results


def rows() -> list[dict[str, Any]]:
    """Rows of the table."""
    tests: tuple[Callable[[], list[tuple[Published, float]]], ...] = (
        acceleration.compared,
        avoidance.compared,
        tyre_rig.compared,
        by_commonroad,
    )
    return [figure.row(value) for test in watched(tests) for figure, value in test()]
