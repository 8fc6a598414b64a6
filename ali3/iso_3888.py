"""The lanes of the tracks of ISO 3888, for manoeuvres and for the cones of worlds."""

from dataclasses import dataclass
from itertools import accumulate
from typing import Literal

Track = Literal["ISO 3888-1", "ISO 3888-2"]

_SECTIONS: dict[Track, tuple[float, ...]] = {
    "ISO 3888-1": (15.0, 30.0, 25.0, 25.0, 30.0),
    "ISO 3888-2": (12.0, 13.5, 11.0, 12.5, 12.0),
}
"""Lengths of lanes and of the gaps between them, in alternation, m."""


@dataclass(frozen=True)
class Gate:
    """A lane with straight edges along x."""

    x_start: float
    x_end: float
    y_right: float
    y_left: float
    """`x_start`, `x_end`, `y_right`, `y_left`: m."""

    @property
    def centre(self) -> float:
        """Middle of the lane, m."""
        return 0.5 * (self.y_right + self.y_left)


def lanes(track: Track, vehicle_width: float, x_start: float = 0.0) -> tuple[Gate, ...]:
    """The three lanes of a track; x runs along the middle of the first one.

    `track`: "ISO 3888-1" or "ISO 3888-2"; `vehicle_width`: without mirrors, m; `x_start`: where the first lane begins,
    m.

    Notes
    -----
    Lanes of ISO 3888-1 are 1.1, 1.2 and 1.3 times as wide as the vehicle and 0.25 m more; the second one is taken 3.5 m
    to the left from middle to middle. Those of ISO 3888-2 are 1.1 widths and 0.25 m, the width and 1 m, and 1.3 widths
    and 0.25 m but at least 3 m wide; the second one begins 1 m to the left of the first one, and the right edges of the
    first and the last one are in one line. From public summaries of the standards, not from their text.
    """
    x_ends = [x_start + end for end in accumulate((0.0, *_SECTIONS[track]))]
    first_half = 0.5 * (1.1 * vehicle_width + 0.25)
    if track == "ISO 3888-1":
        second_half, third_half = (0.5 * (factor * vehicle_width + 0.25) for factor in (1.2, 1.3))
        edges = ((-first_half, first_half), (3.5 - second_half, 3.5 + second_half), (-third_half, third_half))
    else:
        second_right = first_half + 1.0
        last_width = max(1.3 * vehicle_width + 0.25, 3.0)
        edges = (
            (-first_half, first_half),
            (second_right, second_right + vehicle_width + 1.0),
            (-first_half, last_width - first_half),
        )
    return tuple(Gate(x_ends[2 * k], x_ends[2 * k + 1], right, left) for k, (right, left) in enumerate(edges))
