"""Errors of stepping, with the part of the run recorded so far."""

from mbs.results.trajectory import Trajectory


class SimulationError(RuntimeError):
    """A step, an initialisation or a restore failed in the kernel; the last good state is kept.

    Attributes
    ----------
    time : float
        Time of the last good state, s.
    status : int
        Code of the kernel.
    trajectory : Trajectory or None
        Record of the run up to the failure.
    final : bool
        Whether no other step or method would continue, as where drives reach the end of the motion of a loop.
    """

    final = False

    def __init__(self, message: str, time: float, status: int, trajectory: Trajectory | None = None) -> None:
        super().__init__(message)
        self.time = time
        self.status = status
        self.trajectory = trajectory


class PoseError(SimulationError, ValueError):
    """A pose for a System whose joints tie it to the ground: a refused start and an invalid argument."""
