"""Messages about a run with a tolerance that was refused or is exceeded."""

import warnings

from mbs.kernel.binding import KernelError, Status
from mbs.kernel.header.limits import STILL, WRONG_ERROR
from mbs.results.accuracy import GOAL_ERROR, AccuracyWarning
from mbs.results.simulation_error import SimulationError
from mbs.results.step_control import FINER, Control
from mbs.results.trajectory import Trajectory
from mbs.simulation.controlled_run import ControlledRun
from mbs.simulation.refusal import end_of_motion_text, refusal

LOOK_AHEAD = 1e-3  # of the run: time for which drives are followed beyond the last step


def _tolerance_text(run: ControlledRun, tolerance: float) -> str:
    """Tolerance of a run, and the requested one if it differs."""
    return (
        f"{tolerance:g}"
        if run.tolerance == tolerance
        else f"{run.tolerance:g} (in an intermediate run towards {tolerance:g})"
    )


def stalled_error(run: ControlledRun, tolerance: float, record: Trajectory) -> SimulationError:
    """Error of a run whose steps exceed their part of the error at any length.

    `tolerance`: the requested one; `record`: trajectory until then.
    """
    time, end_of_motion = run.simulation.time, end_of_motion_text(run.simulation, LOOK_AHEAD * run.task.span)
    error = SimulationError(
        f"A tolerance of {_tolerance_text(run, tolerance)} cannot be held by {run.settings.method!r}: until "
        f"t = {time:g} s {run.fields.forced + run.fields.over_share} of {run.fields.accepted} steps erred more than "
        f"their part of it, even with steps of {run.fields.smallest:.1e} s"
        f"{f'.{end_of_motion}' if end_of_motion else '; take a larger tolerance or another method.'}",
        time,
        Status.NOT_CONVERGED,
        record,
    )
    error.final = bool(end_of_motion)
    return error


def refused_error(run: ControlledRun, tolerance: float, record: Trajectory, error: KernelError) -> SimulationError:
    """Error of a run in which a step failed; `tolerance` and `record` as in `stalled_error`."""
    simulation = run.simulation
    if error.status in (Status.NO_TREE, Status.WRONG_METHOD):
        return refusal(simulation, "The run was refused", error, record)
    subject = (
        f"With a tolerance of {_tolerance_text(run, tolerance)} no step from t = {simulation.time:g} s succeeded, "
        f"the last one tried was {run.fields.h:.2g} s long"
    )
    simulation.step_tried = run.fields.h
    return refusal(simulation, subject, error, record, LOOK_AHEAD * run.task.span)


def warn_of_tolerance(control: Control, estimate: float) -> None:
    """Warn if the estimated error, relative to the length, exceeds the tolerance or is a large part of the motion."""
    error, moved = estimate * control.length, control.moved
    if control.kept and not control.sensors and error > WRONG_ERROR * moved and moved > STILL * control.length:
        warnings.warn(
            f"The tolerance of {control.tolerance:g} is relative to the model's length of {control.length:.4g} m, and "
            f"what moves farthest moves {moved:.3g} m: the estimated error of {error:.1e} m is "
            f"{100.0 * error / moved:.2g} % of that. Give one for a sensor, in its unit, tolerance={{name: ...}}, or "
            f"tolerance={GOAL_ERROR * moved / control.length:.0e}.",
            AccuracyWarning,
            stacklevel=5,
        )
    if control.kept:
        return
    forced = f", {control.forced} steps of the least size exceeded their part of it" if control.forced else ""
    warnings.warn(
        f"The error of this run is estimated as {control.error:.1e} of the model's length, more than "
        f"{FINER:g} times the tolerance of {control.tolerance:g}, after {control.runs} runs{forced}. Small "
        f"errors grow in this motion, or round-off is reached: shorten the time, accept a larger tolerance or name "
        f"another method than {control.method!r}.",
        AccuracyWarning,
        stacklevel=5,
    )
