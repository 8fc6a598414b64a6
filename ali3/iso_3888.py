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
_SECOND_CENTRE = 3.5  # m, y of the centre of the second lane of ISO 3888-1
_GAP = 1.0  # m in y between the first and the second lane of ISO 3888-2


@dataclass(frozen=True)
class Gate:
    """A straight lane along x; all fields in m."""

    x_start: float
    x_end: float
    y_right: float
    y_left: float

    @property
    def centre(self) -> float:
        """Middle of the lane, m."""
        return 0.5 * (self.y_right + self.y_left)


def lanes(track: Track, vehicle_width: float, x_start: float = 0.0) -> tuple[Gate, ...]:
    """The three lanes of a track; x along the centre line of the first lane, y to the left.

    `vehicle_width`: width b of the vehicle without mirrors, m; `x_start`: beginning of the first lane, m.

    Notes
    -----
    ISO 3888-1: widths 1.1 b + 0.25 m, 1.2 b + 0.25 m, 1.3 b + 0.25 m; the second lane is taken 3.5 m to the left of the
    others, centre to centre. ISO 3888-2: widths 1.1 b + 0.25 m, b + 1 m, max(1.3 b + 0.25 m, 3 m); a gap of 1 m in y
    between the first lane and the second, right edges of the first and the third lane in line. From public summaries of
    the standards, not from their text.
    """
    x_ends = [x_start + end for end in accumulate((0.0, *_SECTIONS[track]))]
    first_half = 0.5 * (1.1 * vehicle_width + 0.25)
    if track == "ISO 3888-1":
        second_half, third_half = (0.5 * (factor * vehicle_width + 0.25) for factor in (1.2, 1.3))
        edges = (
            (-first_half, first_half),
            (_SECOND_CENTRE - second_half, _SECOND_CENTRE + second_half),
            (-third_half, third_half),
        )
    else:
        second_right = first_half + _GAP
        third_width = max(1.3 * vehicle_width + 0.25, 3.0)
        edges = (
            (-first_half, first_half),
            (second_right, second_right + vehicle_width + 1.0),
            (-first_half, third_width - first_half),
        )
    return tuple(Gate(x_ends[2 * k], x_ends[2 * k + 1], right, left) for k, (right, left) in enumerate(edges))
