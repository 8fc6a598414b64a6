"""Sentence about a call or step that the kernel refused."""

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

MOST_NAMED = 3  # changed parameters in one sentence
NEAR_AN_END = (Status.NOT_CONVERGED, Status.TOO_DEAR, Status.TOO_STIFF, Status.UNRESOLVED)
"""How steps fail where a drive leads loops no further: there speeds grow without bound."""
CLOSED = 1e-6  # of what a drive opens in a step: positions that are solved are closed to round-off, others to a tenth
ITERATIONS, HALVINGS = 30, 12  # of Newton's loop for positions alone; of the step, to find where it ends to close
STIFF_STEP = 1.0  # fastest rate times step that an explicit method follows well


def refusal(
    simulation: SteppedSystem,
    what: str,
    error: KernelError,
    trajectory: Trajectory | None = None,
    ahead: float = 0.0,
    *,
    step_given: bool = False,
) -> SimulationError:
    """An error of the kernel as a SimulationError: status, reason, its numbers and remedy.

    `simulation`: in the last good state; `what`: the beginning of the sentence: what was tried; `trajectory`: what was
    recorded until then; `ahead`: how far drives are followed, s, if not over the step that was tried; `step_given`:
    a step was refused whose length is the caller's choice. Equations that are not met are named with the worst one.
    """
    status, cause = error.status, status_cause(error.status)
    beyond = beyond_reach(simulation, ahead or simulation.step_tried) if status in NEAR_AN_END else ""
    message = f"{what}: {error.message}{beyond}"
    if not beyond:
        message += _numbers(simulation, status)
        if step_given or cause not in (Cause.STEP, Cause.EQUATIONS):
            message += f" {status_remedy(status)}"
        report = simulation.instance.report()
        # neither row nor balance is at fault where nothing was solved yet, or all was but did work
        if cause in (Cause.START, Cause.EQUATIONS) and report["factorizations"]:
            message += _worst_equations(simulation, report)
    refused = SimulationError(message, simulation.time, status, trajectory)
    refused.final = bool(beyond)
    return refused


def _numbers(simulation: SteppedSystem, status: int) -> str:
    """The names and numbers of a status, in sentences."""
    if status in (Status.WRONG_METHOD, Status.NO_TREE):
        method, words = simulation.settings.method, simulation.instance.method_excludes()
        if status == Status.NO_TREE:
            return f" Here {prepared(simulation.system)[1]['report']['no_tree']}. The method is {method!r}."
        return f" {method!r} takes no {words}."
    if status == Status.START_REFUSED:
        height, element, words = simulation.instance.start_excess()
        name = prepared(simulation.system)[1]["elements"][element]["name"]
        return f" '{name}' {words}. {height:.3g} m higher (z of the pose) it would be clear of it."
    if status == Status.ROAD_LOST:
        return f" Of the road {simulation.instance.road_lost()}."
    if status == Status.WHEEL_IN_ROAD:
        element, words = simulation.instance.wheel_in_road()
        return f" '{prepared(simulation.system)[1]['elements'][element]['name']}': {words}."
    if status == Status.BEYOND_TABLE:
        column, value, first, last = simulation.instance.beyond_table()
        name = prepared(simulation.system)[1]["coordinates"][column]
        return f" {name!r} is {value:.4g}; its table goes from {first:.4g} to {last:.4g}."
    if status == Status.NO_EQUILIBRIUM:
        return _farthest_changed(simulation)
    rate = simulation.instance.report()["fastest_rate"]
    if status == Status.TURNS_TOO_FAR:
        enough = f"a step of {0.49 / rate:.2g} s follows it, and so do more `max_halvings`"
        return f" Its rate is {rate:.3g} rad/s; {enough}."
    if status == Status.TOO_STIFF and rate > 0.0:
        h = simulation.step_tried
        return (
            f" Its rate here is {rate:.3g} 1/s, which times the step of {h:g} s is {rate * h:.3g}; that should be "
            f"below about {STIFF_STEP:g}."
        )
    return ""


def beyond_reach(simulation: SteppedSystem, ahead: float) -> str:
    """Where within so many seconds, s, drives over time lead loops no further, in a sentence.

    Empty where the rows can be closed at its end by positions alone, or do not depend on time.
    """
    rows = np.unique(simulation.system.arrays["gterm_row"])
    if not len(rows) or not ahead > 0.0:
        return ""
    evaluator, closed, opened = Evaluator(simulation), 0.0, ahead
    if _closes(evaluator, opened) or not _closes(evaluator, closed):
        return ""
    for _ in range(HALVINGS):
        middle = 0.5 * (closed + opened)
        closed, opened = (middle, opened) if _closes(evaluator, middle) else (closed, middle)
    meta = prepared(simulation.system)[1]
    names = [repr(meta["rows"][row]["name"]) for row in rows]
    suffix = f" and {len(names) - MOST_NAMED} others" if len(names) > MOST_NAMED else ""
    return (
        f" Shorter steps do not help: driven by {', '.join(names[:MOST_NAMED])}{suffix} the joints can be closed until "
        f"about t = {simulation.time + closed:.5g} s, where two ways to close them meet, and not behind it. End the "
        f"run before, or drive it less far."
    )


def _closes(evaluator: Evaluator, ahead: float) -> bool:
    """Whether positions near the state close all rows so many seconds later."""
    q, t, most = evaluator.state.q, evaluator.time + ahead, 0.0
    for _ in range(ITERATIONS):
        phi, jacobian, _ = evaluator.constraints(q, evaluator.state.qd, t)
        residual = float(np.abs(phi).max())
        most = most or max(residual, RANK_TOLERANCE * max(1.0, float(np.abs(q).max())) / CLOSED)
        if not residual < math.inf or residual <= CLOSED * most:
            break
        q = q - np.linalg.lstsq(jacobian, phi, rcond=RANK_TOLERANCE)[0]
    return residual <= CLOSED * most


def _farthest_changed(simulation: SteppedSystem) -> str:
    """The parameters that were changed by most of their ranges."""
    changed = []
    for k, entry in enumerate(prepared(simulation.system)[1]["parameters"]):
        value, span = simulation.instance.get_parameter(k), entry["max"] - entry["min"]
        if value != entry["value"]:
            words = f"{entry['name']!r} is {value:g}{unit_text(entry['unit'])} in place of {entry['value']:g}"
            changed.append((abs(value - entry["value"]) / span if span < math.inf else math.inf, words))
    changed.sort(key=lambda item: -item[0])
    changes_text = "; ".join(words for _, words in changed[:MOST_NAMED])
    suffix = f" (and {len(changed) - MOST_NAMED} others)" if len(changed) > MOST_NAMED else ""
    return f" {changes_text}{suffix}." if changes_text else ""


def _worst_equations(simulation: SteppedSystem, report: dict[str, float]) -> str:
    """The constraint row and the balance that are farthest from zero."""
    meta, worst_text = prepared(simulation.system)[1], ""
    worst = open_row(report, [row["name"] for row in meta["rows"]])
    if worst:
        worst_text += f" Worst constraint: {worst}."
    if simulation.system.fineness * simulation.settings.tolerance_r < report["residual"] < math.inf:
        name = meta["coordinates"][int(report["worst_coordinate"])]
        worst_text += f" Worst balance: {name!r}, residual {report['residual']:.3g}."
    return worst_text
