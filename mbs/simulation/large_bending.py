"""Warning about flexible bodies that bend beyond the range of their linear modes.

A reduced body is linear in its amplitudes: it leaves out the shortening of a bent line (s^2/6 of its length between
ends of the slopes s and -s) and the stiffening or softening by axial forces. The second is the larger: in the falling
soft pendulum of `tests/flexible_engine/test_large_deflections.py`, against a geometrically exact beam, the end of a
chain of 1, 2, 4 and 8 bodies is off by 11, 4.8, 2.1 and 1.4 mm of 1 m where its bodies bend by 0.045, 0.028, 0.014 and
0.007 rad.
"""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

from mbs.common.frames import FlexibleShapes, Frames

Array = NDArray[np.float64]

MAX_TURN = 0.04  # rad; largest rotation of a node in its floating frame
END_ERROR = 0.25  # error at the end of the soft pendulum, relative to the turn times its length


class BendingWarning(UserWarning):
    """A flexible body bends beyond the range of its linear modes."""


class BendingWatch:
    """Largest rotation of a node in its floating frame among the observed states.

    `frames`: frames of the System; None or without flexible bodies: nothing is observed.
    """

    def __init__(self, frames: Frames | None) -> None:
        self.frames = frames
        self.turn, self.time = 0.0, 0.0
        self.body: FlexibleShapes | None = None
        self._was_reported = False

    @property
    def has_flexible_bodies(self) -> bool:
        """Whether there is a flexible body."""
        return self.frames is not None and bool(self.frames.flexible)

    def observe(self, t: float, q: Array) -> None:
        """Observe a state: coordinates `q` (nq,) at time `t`, s."""
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
        """Text of the warning with a remedy if a body bent too far, otherwise empty."""
        if self.body is None or self.turn <= MAX_TURN:
            return ""
        divisions = int(np.ceil(self.turn / MAX_TURN))
        return (
            f"The flexible body {self.body.name!r} bends by {self.turn:.2g} rad in its floating frame at "
            f"t = {self.time:.4g} s. Its modes are linear: they leave out its shortening and the stiffening by axial "
            f"forces, so positions of its ends may be off by {END_ERROR * self.turn:.1%} of its length. Divide it into "
            f"{divisions} or more bodies welded end to end."
        )

    def message_once(self) -> str:
        """Return the message on the first call that has one, otherwise an empty text."""
        text = "" if self._was_reported else self.message
        self._was_reported = self._was_reported or bool(text)
        return text

    def warn(self, stacklevel: int) -> None:
        """Issue the warning, once."""
        if text := self.message_once():
            warnings.warn(text, BendingWarning, stacklevel=stacklevel)
