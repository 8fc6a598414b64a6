"""Warning about flexible bodies that are bent or loaded beyond the range of their linear modes.

A reduced body is linear in its amplitudes: it leaves out the shortening of a bent line (s^2/6 of its length between
ends of the slopes s and -s) and the stiffening or softening by axial forces. The second is the larger: in the falling
soft pendulum of `tests/flexible_engine/test_large_deflections.py`, against a geometrically exact beam, the end of a
chain of 1, 2, 4 and 8 bodies is off by 11, 4.8, 2.1 and 1.4 mm of 1 m where its bodies bend by 0.045, 0.028, 0.014 and
0.007 rad. A column at half of its Euler load, in 1, 2 and 4 bodies that carry 50, 12 and 3 % of their buckling load,
has a frequency 42, 9.3 and 2.4 % too high.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.frames import Frames

Array = NDArray[np.float64]

MAX_TURN = 0.04  # rad; largest rotation of a node in its floating frame
END_ERROR = 0.25  # error at the end of the soft pendulum, relative to the turn times its length
MAX_SHARE = 0.05  # axial forces as part of the buckling load, `AxialStiffening.share`


class BendingWarning(UserWarning):
    """A flexible body is bent or loaded beyond the range of its linear modes."""


@dataclass
class Peak:
    """Largest value of a number, with its time, s, and body."""

    value: float = 0.0
    time: float = 0.0
    body: str = ""

    def raise_to(self, value: float, time: float, body: str) -> None:
        """Take a value that is larger."""
        if value > self.value:
            self.value, self.time, self.body = value, time, body


class BendingWatch:
    """Largest rotation of a node in its floating frame, and largest axial forces, among the observed states.

    `frames`: frames of the System; None or without flexible bodies: nothing is observed.
    """

    def __init__(self, frames: Frames | None) -> None:
        self.frames = frames
        self._turn, self._share = Peak(), Peak()
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
            self._turn.raise_to(float(np.linalg.norm(body.turns @ amplitudes, axis=1).max()), t, body.name)
            least = max(self._share.value, MAX_SHARE)
            self._share.raise_to(body.axial.share(amplitudes, least), t, body.name)

    @property
    def message(self) -> str:
        """Text of the warning with a remedy if a body was bent or loaded too far, otherwise empty."""
        turn, share, sentences = self._turn, self._share, []
        if turn.value > MAX_TURN:
            sentences.append(
                f"The flexible body {turn.body!r} bends by {turn.value:.2g} rad in its floating frame at "
                f"t = {turn.time:.4g} s. Its modes are linear: they leave out its shortening and the stiffening by "
                f"axial forces, so positions of its ends may be off by {END_ERROR * turn.value:.1%} of its length. "
                f"Divide it into {int(np.ceil(turn.value / MAX_TURN))} or more bodies welded end to end."
            )
        if share.value > MAX_SHARE:
            sentences.append(
                f"The flexible body {share.body!r} carries axial forces of {share.value:.2g} times its buckling load "
                f"(with its frame clamped) at t = {share.time:.4g} s. Its modes leave out that these stiffen or soften "
                "it, so its bending stiffness is off by about that part, its frequencies by half of it, near buckling "
                f"by more. Divide it into {int(np.ceil(np.sqrt(share.value / MAX_SHARE)))} or more bodies welded end "
                "to end, each with its reference node in its middle."
            )
        return " ".join(sentences)

    def message_once(self) -> str:
        """Return the message on the first call that has one, otherwise an empty text."""
        text = "" if self._was_reported else self.message
        self._was_reported = self._was_reported or bool(text)
        return text

    def warn(self, stacklevel: int) -> None:
        """Issue the warning, once."""
        if text := self.message_once():
            warnings.warn(text, BendingWarning, stacklevel=stacklevel)
