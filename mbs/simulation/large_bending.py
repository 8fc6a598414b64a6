"""Warning about flexible bodies that are bent or loaded beyond the range of their linear modes.

A reduced body is linear in its amplitudes: it leaves out the shortening of a bent line (s^2/6 of its length between
ends of the slopes s and -s) and the stiffening or softening by axial forces. The second is the larger: in the falling
soft pendulum of `tests/flexible_engine/test_large_deflections.py`, against a geometrically exact beam, the end of a
chain of 1, 2, 4 and 8 bodies is off by 11, 4.8, 2.1 and 1.4 mm of 1 m where its bodies bend by 0.045, 0.028, 0.014 and
0.007 rad. A column at half of its Euler load, in 1, 2 and 4 bodies that carry 50, 12 and 3 % of their buckling load,
has a frequency 42, 9.3 and 2.4 % too high.
"""

import warnings

import numpy as np
from numpy.typing import NDArray

from mbs.common.frames import FlexibleShapes, Frames

Array = NDArray[np.float64]

MAX_TURN = 0.04  # rad; largest rotation of a node in its floating frame
END_ERROR = 0.25  # error at the end of the soft pendulum, relative to the turn times its length
MAX_SHARE = 0.05  # axial forces as part of the buckling load, `AxialStiffening.share`, root mean square


class BendingWarning(UserWarning):
    """A flexible body is bent or loaded beyond the range of its linear modes."""


class BendingWatch:
    """Largest rotation of a node in its floating frame, and axial forces of each body, among the observed states.

    `frames`: frames of the System; None or without flexible bodies: nothing is observed. Axial forces count by their
    mean square: a short peak changes little, a lasting force the frequencies.
    """

    def __init__(self, frames: Frames | None) -> None:
        self.frames = frames
        self.turn, self.time = 0.0, 0.0
        self.body: FlexibleShapes | None = None
        self._shares: dict[str, float] = {}  # sums of the squares by body
        self._states = 0
        self._was_reported = False

    @property
    def has_flexible_bodies(self) -> bool:
        """Whether there is a flexible body."""
        return self.frames is not None and bool(self.frames.flexible)

    def observe(self, t: float, q: Array) -> None:
        """Observe a state: coordinates `q` (nq,) at time `t`, s."""
        if self.frames is None or not self.frames.flexible:
            return
        self._states += 1
        full = self.frames.T @ q + self.frames.constant
        for body in self.frames.flexible:
            amplitudes = full[body.first : body.first + body.turns.shape[2]]
            turn = float(np.linalg.norm(body.turns @ amplitudes, axis=1).max())
            if turn > self.turn:
                self.turn, self.time, self.body = turn, t, body
            square = body.axial.share(amplitudes, MAX_SHARE) ** 2
            self._shares[body.name] = self._shares.get(body.name, 0.0) + square

    @property
    def message(self) -> str:
        """Text of the warning with a remedy if a body was bent or loaded too far, otherwise empty."""
        sentences = []
        if self.body is not None and self.turn > MAX_TURN:
            # beyond its length an error is no estimate, as in a beam that rotates faster than it can vibrate
            runs_away = END_ERROR * self.turn > 1.0
            sentences.append(
                f"The flexible body {self.body.name!r} bends by {self.turn:.2g} rad in its floating frame at "
                f"t = {self.time:.4g} s. Its modes are linear: they leave out its shortening and the stiffening by "
                f"axial forces, so "
                + (
                    "its motion means nothing. Divide it into bodies welded end to end, and these again, until there "
                    "is no such warning."
                    if runs_away
                    else f"positions of its ends may be off by {END_ERROR * self.turn:.1%} of its length. Divide it "
                    f"into {int(np.ceil(self.turn / MAX_TURN))} or more bodies welded end to end."
                )
            )
        name = max(self._shares, key=self._shares.__getitem__, default="")
        share = float(np.sqrt(self._shares[name] / self._states)) if name else 0.0
        if share > MAX_SHARE:
            sentences.append(
                f"The flexible body {name!r} carries axial forces of {share:.2g} times its buckling load with its "
                "frame clamped (root mean square). Its modes leave out that these stiffen or soften it, so its bending "
                "stiffness is off by about that part, its frequencies by half of it, near buckling by more. Divide it "
                f"into {int(np.ceil(np.sqrt(share / MAX_SHARE)))} or more bodies welded end to end, each with its "
                "reference node in its middle."
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


def warn_of_state(frames: Frames | None, t: float, q: Array, stacklevel: int) -> None:
    """Issue the warning for one state about which a System is linearised: coordinates `q` (nq,) at time `t`, s."""
    watch = BendingWatch(frames)
    watch.observe(t, q)
    watch.warn(stacklevel + 1)
