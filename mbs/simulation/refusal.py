"""Error message for a call or step that the kernel refused."""

import math

import numpy as np

from ali3.message_text import unit_text
from mbs.kernel.binding import KernelError, Status, open_row
from mbs.kernel.binding.errors import status_cause, status_remedy
from mbs.kernel.header.enumerations import Cause
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.simulation.evaluator import RANK_TOLERANCE, Evaluator
from mbs.simulation.prepared_system import prepared
from mbs.simulation.stepped_system import SteppedSystem

MAX_NAMES = 3  # largest number of names in one sentence
NEAR_AN_END = (Status.NOT_CONVERGED, Status.TOO_MUCH_WORK, Status.TOO_STIFF, Status.UNRESOLVED)
"""Failures of steps where drives reach the end of the motion of a loop: there speeds grow without bound."""
CLOSED = 1e-6  # of the residual of the driven step: largest residual of closed rows; solved rows reach round-off
ITERATIONS, HALVINGS = 30, 12  # largest numbers: of Newton's iterations for positions, of bisections of the time
STIFF_STEP = 1.0  # largest product of rate and step with which an explicit method is accurate


def refusal(
    simulation: SteppedSystem,
    subject: str,
    error: KernelError,
    trajectory: Trajectory | None = None,
    ahead: float = 0.0,
    *,
    step_given: bool = False,
) -> SimulationError:
    """Make a `SimulationError` of an error of the kernel, with its reason, numbers and a remedy.

    Parameters
    ----------
    simulation : SteppedSystem
        In the last good state.
    subject : str
        Beginning of the message: the action that failed.
    error : KernelError
        Error of the kernel.
    trajectory : Trajectory, optional
        Record of the run until then.
    ahead : float
        Time over which drives are followed, s; 0: the step that was tried.
    step_given : bool
        Whether the caller chose the length of the step.
    """
    status, cause = error.status, status_cause(error.status)
    end_of_motion = end_of_motion_text(simulation, ahead or simulation.step_tried) if status in NEAR_AN_END else ""
    message = f"{subject}: {error.message}{end_of_motion}"
    if not end_of_motion:
        message += _status_text(simulation, status)
        if step_given or cause not in (Cause.STEP, Cause.EQUATIONS):
            message += f" {status_remedy(status)}"
        report = simulation.instance.report()
        # without a factorization no equation was solved
        if cause in (Cause.START, Cause.EQUATIONS) and report["factorizations"]:
            message += _worst_equations_text(simulation, report)
    simulation_error = SimulationError(message, simulation.time, status, trajectory)
    simulation_error.final = bool(end_of_motion)
    return simulation_error


def _status_text(simulation: SteppedSystem, status: int) -> str:
    """Names and numbers that belong to a status, in sentences."""
    if status in (Status.WRONG_METHOD, Status.NO_TREE):
        method, reason = simulation.settings.method, simulation.instance.method_excludes()
        if status == Status.NO_TREE:
            return f" Here {prepared(simulation.system).meta['report']['no_tree']}. The method is {method!r}."
        return f" {method!r} takes no {reason}."
    if status == Status.START_REFUSED:
        height, element, reason = simulation.instance.start_excess()
        name = prepared(simulation.system).meta["elements"][element]["name"]
        return f" '{name}' {reason}. {height:.3g} m higher (z of the pose) it would be clear of it."
    if status == Status.ROAD_LOST:
        return f" Of the road {simulation.instance.road_lost()}."
    if status == Status.WHEEL_IN_ROAD:
        element, reason = simulation.instance.wheel_in_road()
        return f" '{prepared(simulation.system).meta['elements'][element]['name']}': {reason}."
    if status == Status.BEYOND_TABLE:
        column, value, first, last = simulation.instance.beyond_table()
        name = prepared(simulation.system).meta["coordinates"][column]
        return f" {name!r} is {value:.4g}; its table goes from {first:.4g} to {last:.4g}."
    if status == Status.NO_EQUILIBRIUM:
        return _changed_parameters_text(simulation)
    rate = simulation.instance.report()["fastest_rate"]
    if status == Status.TURNS_TOO_FAR:
        remedy = f"a step of {0.49 / rate:.2g} s follows it, and so do more `max_halvings`"
        return f" Its rate is {rate:.3g} rad/s; {remedy}."
    if status == Status.TOO_STIFF and rate > 0.0:
        h = simulation.step_tried
        return (
            f" Its rate here is {rate:.3g} 1/s, which times the step of {h:g} s is {rate * h:.3g}; that should be "
            f"below about {STIFF_STEP:g}."
        )
    return ""


def end_of_motion_text(simulation: SteppedSystem, ahead: float) -> str:
    """Sentence about the time within `ahead` s after which drives cannot move loops any further.

    Empty if positions close the rows at the end of that time, or the rows do not depend on time.
    """
    rows = np.unique(simulation.system.arrays["gterm_row"])
    if not len(rows) or not ahead > 0.0:
        return ""
    evaluator, lower, upper = Evaluator(simulation), 0.0, ahead
    if _can_close(evaluator, upper) or not _can_close(evaluator, lower):
        return ""
    for _ in range(HALVINGS):
        middle = 0.5 * (lower + upper)
        lower, upper = (middle, upper) if _can_close(evaluator, middle) else (lower, middle)
    meta = prepared(simulation.system).meta
    names = [repr(meta["rows"][row]["name"]) for row in rows]
    suffix = f" and {len(names) - MAX_NAMES} others" if len(names) > MAX_NAMES else ""
    return (
        f" Shorter steps do not help: driven by {', '.join(names[:MAX_NAMES])}{suffix} the joints can be closed until "
        f"about t = {simulation.time + lower:.5g} s, where two ways to close them meet, and not behind it. End the "
        f"run before, or drive it less far."
    )


def _can_close(evaluator: Evaluator, ahead: float) -> bool:
    """Whether positions near the state close all rows `ahead` s later."""
    q, t, reference = evaluator.state.q, evaluator.time + ahead, 0.0
    for _ in range(ITERATIONS):
        phi, jacobian, _ = evaluator.constraints(q, evaluator.state.qd, t)
        residual = float(np.abs(phi).max())
        reference = reference or max(residual, RANK_TOLERANCE * max(1.0, float(np.abs(q).max())) / CLOSED)
        if not residual < math.inf or residual <= CLOSED * reference:
            break
        q = q - np.linalg.lstsq(jacobian, phi, rcond=RANK_TOLERANCE)[0]
    return residual <= CLOSED * reference


def _changed_parameters_text(simulation: SteppedSystem) -> str:
    """Sentence about the parameters that were changed by the largest shares of their ranges."""
    changed = []
    for k, entry in enumerate(prepared(simulation.system).meta["parameters"]):
        value, span = simulation.instance.get_parameter(k), entry["max"] - entry["min"]
        if value != entry["value"]:
            change_text = f"{entry['name']!r} is {value:g}{unit_text(entry['unit'])} instead of {entry['value']:g}"
            changed.append((abs(value - entry["value"]) / span if span < math.inf else math.inf, change_text))
    changed.sort(key=lambda item: -item[0])
    changes_text = "; ".join(change_text for _, change_text in changed[:MAX_NAMES])
    suffix = f" (and {len(changed) - MAX_NAMES} others)" if len(changed) > MAX_NAMES else ""
    return f" {changes_text}{suffix}." if changes_text else ""


def _worst_equations_text(simulation: SteppedSystem, report: dict[str, float]) -> str:
    """Sentences about the constraint row and the balance with the largest residuals."""
    meta, text = prepared(simulation.system).meta, ""
    row_text = open_row(report, [row["name"] for row in meta["rows"]])
    if row_text:
        text += f" Worst constraint: {row_text}."
    if simulation.system.fineness * simulation.settings.tolerance_r < report["residual"] < math.inf:
        name = meta["coordinates"][int(report["worst_coordinate"])]
        text += f" Worst balance: {name!r}, residual {report['residual']:.3g}."
    return text
