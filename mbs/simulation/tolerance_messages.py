"""Messages about a run with a tolerance that was refused or is exceeded."""

import warnings

from mbs.kernel.binding import KernelError, Status
from mbs.kernel.header.limits import STILL, WRONG_ERROR
from mbs.results.accuracy import GOAL_ERROR, AccuracyWarning
from mbs.results.simulation_error import SimulationError
from mbs.results.step_control import ALLOWED, Control
from mbs.results.trajectory import Trajectory
from mbs.simulation.controlled_run import ControlledRun
from mbs.simulation.refusal import beyond_reach, refusal

LOOKED_AHEAD = 1e-3  # of the run: how far behind the place where steps end a drive may lead loops no further


def _run_at(run: ControlledRun, wanted: float) -> str:
    """The tolerance of a run beside the one that was asked for."""
    return f"{wanted:g}" if run.tolerance == wanted else f"{run.tolerance:g} (in a run on the way to {wanted:g})"


def stalled(run: ControlledRun, wanted: float, so_far: Trajectory) -> SimulationError:
    """That steps err more than they may however short they are, with what was recorded until then."""
    time, beyond = run.simulation.time, beyond_reach(run.simulation, LOOKED_AHEAD * run.task.span)
    error = SimulationError(
        f"A tolerance of {_run_at(run, wanted)} cannot be held by {run.settings.method!r}: until t = {time:g} s "
        f"{run.fields.forced + run.fields.over_share} of {run.fields.accepted} steps erred more than their share of "
        f"it, even with steps of {run.fields.smallest:.1e} s"
        f"{f'.{beyond}' if beyond else '; take a larger tolerance or another method.'}",
        time,
        Status.NOT_CONVERGED,
        so_far,
    )
    error.final = bool(beyond)
    return error


def refused(run: ControlledRun, wanted: float, so_far: Trajectory, error: KernelError) -> SimulationError:
    """The failure with what was recorded until then."""
    simulation = run.simulation
    if error.status in (Status.NO_TREE, Status.WRONG_METHOD):
        return refusal(simulation, "The run was refused", error, so_far)
    what = (
        f"With a tolerance of {_run_at(run, wanted)} no step from t = {simulation.time:g} s succeeded, "
        f"the last one tried was {run.fields.h:.2g} s long"
    )
    simulation.step_tried = run.fields.h
    return refusal(simulation, what, error, so_far, LOOKED_AHEAD * run.task.span)


def warn_of_tolerance(control: Control, guess: float) -> None:
    """Of a run whose `guess` of its error is above what it may be, or much of the motion."""
    error, moved = guess * control.length, control.moved
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
    forced = f", {control.forced} steps of the least size exceeded their share of it" if control.forced else ""
    warnings.warn(
        f"The error of this run is estimated as {control.error:.1e} of the model's length, more than {ALLOWED:g} times "
        f"the tolerance of {control.tolerance:g}, after {control.runs} runs{forced}. Small errors grow in this motion, "
        f"or round-off is reached: shorten the time, accept a larger tolerance or name another method than "
        f"{control.method!r}.",
        AccuracyWarning,
        stacklevel=5,
    )
