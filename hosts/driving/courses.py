"""The courses that manoeuvres name."""

from ali3.iso_3888 import Track, lanes
from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.driving.course import Course

TRACKS: dict[str, Track] = {"iso_3888_1": "ISO 3888-1", "iso_3888_2": "ISO 3888-2"}
"""Tracks by their names in manoeuvres."""


def course_of(name: str, vehicle_width: float, x_start: float = 15.0) -> Course:
    """The course of a name.

    `name`: one of `TRACKS`; `vehicle_width`: without mirrors, m; `x_start`: of the first lane, m. Raises `HostError` if
    there is no such course.
    """
    if name not in TRACKS:
        near = did_you_mean(name, TRACKS, f"known are: {', '.join(TRACKS)}")
        raise HostError(f"There is no course '{name}'{near}")
    return Course(TRACKS[name], lanes(TRACKS[name], vehicle_width, x_start))
