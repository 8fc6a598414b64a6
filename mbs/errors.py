"""The errors of the modelling vocabulary and of stepping."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbs.trajectory import Trajectory


class ModelError(ValueError):
    """A model that cannot be: one sentence that names the part, the value and what would be right."""


class ArgumentTypeError(TypeError, ValueError):
    """An argument that is a thing of another kind: one sentence that says which kind is needed.

    It is a TypeError, as everywhere in Python, and a ValueError, as all errors of values here.
    """


class SimulationError(RuntimeError):
    """A step, an initialisation or a restore that the kernel refused; the last good state is kept.

    Attributes
    ----------
    time : float
        Of the last good state, s.
    status : int
        Code of the kernel.
    trajectory : Trajectory or None
        What a run had recorded so far.
    """

    def __init__(self, message: str, time: float, status: int, trajectory: Trajectory | None = None) -> None:
        super().__init__(message)
        self.time = time
        self.status = status
        self.trajectory = trajectory


class PoseError(SimulationError, ValueError):
    """A pose for a System that takes none: a start that is refused, and an argument that cannot be."""
