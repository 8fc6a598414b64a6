"""Flexible bodies that bend more within their floating frame than their shapes hold for.

A reduced body is linear in its amplitudes: its nodes move across, but the shortening of a bent line, of second order in
the slope, is left out. Between the ends of an arc of slope s on either side of its middle that is s^2/6 of its length.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mbs.frames import FlexibleShapes, Frames

Array = NDArray[np.float64]

MOST_TURN = 0.1  # rad, of a node in its floating frame; lengths are then off by 0.2 %


class BendingWarning(UserWarning):
    """A flexible body bends more than its modes hold for."""


class BendingWatch:
    """Largest turn of a node in its floating frame over the states that were shown.

    Parameters
    ----------
    frames : Frames or None
        None, or one without flexible bodies, watches nothing.
    """

    def __init__(self, frames: Frames | None) -> None:
        self.frames = frames
        self.turn, self.time = 0.0, 0.0
        self.body: FlexibleShapes | None = None

    @property
    def watches(self) -> bool:
        """Whether there is a body that bends."""
        return self.frames is not None and bool(self.frames.flexible)

    def look(self, t: float, q: Array) -> None:
        """Take a state into account: coordinates `q` (nq,) at `t`, s."""
        if self.frames is None or not self.frames.flexible:
            return
        full = self.frames.T @ q + self.frames.constant
        for body in self.frames.flexible:
            amplitudes = full[body.first : body.first + body.turns.shape[2]]
            turn = float(np.linalg.norm(body.turns @ amplitudes, axis=1).max())
            if turn > self.turn:
                self.turn, self.time, self.body = turn, t, body

    @property
    def message(self) -> str:
        """One sentence with a remedy where a body bent too far, else empty."""
        if self.body is None or self.turn <= MOST_TURN:
            return ""
        parts = int(np.ceil(self.turn / MOST_TURN))
        return (
            f"The flexible body {self.body.name!r} bends by {self.turn:.2g} rad in its floating frame at "
            f"t = {self.time:.4g} s. Its modes are linear: lengths along it are off by about {self.turn**2 / 6.0:.1%} and "
            f"the deflection within it by as much. Divide it into {parts} or more bodies welded end to end."
        )
