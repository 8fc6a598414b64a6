"""What the kernel refused, in a sentence for people."""

from __future__ import annotations

import math

import numpy as np

from mbs.kernel.binding import KernelError, Status, open_row
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.settings.input_signals import unit_text
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
    simulation: SteppedSystem, what: str, error: KernelError, trajectory: Trajectory | None = None, ahead: float = 0.0
) -> SimulationError:
    """An error of the kernel as a SimulationError.

    `simulation`: in the last good state; `what`: the beginning of the sentence: what was tried; `trajectory`: what was
    recorded until then; `ahead`: how far drives are followed, s, if not over the step that was tried. Result: status,
    reason and remedy; of a step that did not converge also the worst row and the worst balance.
    """
    beyond = beyond_reach(simulation, ahead or simulation.step_tried) if error.status in NEAR_AN_END else ""
    message = f"{what}: {error.message}{beyond or _remedy(simulation, error.status)}"
    report = simulation.instance.report()
    # neither row nor balance is at fault where nothing was solved yet, or all was but did work
    unsolved = not report["factorizations"]
    if not (unsolved or beyond) and error.status not in (
        Status.WRONG_METHOD,
        Status.NO_TREE,
        Status.START_REFUSED,
        Status.UNRESOLVED,
        Status.TURNS_TOO_FAR,
        Status.TOO_DEAR,
        Status.TOO_STIFF,
        Status.TOO_FAR,
        Status.ROAD_LOST,
        Status.WHEEL_IN_ROAD,
        Status.BAD_NORMAL,
        Status.BEYOND_TABLE,
    ):
        message += _worst_equations(simulation, report)
    refused = SimulationError(message, simulation.time, error.status, trajectory)
    refused.final = bool(beyond)
    return refused


def _remedy(simulation: SteppedSystem, status: int) -> str:
    """The remedy that follows from the status alone."""
    if status in (Status.WRONG_METHOD, Status.NO_TREE):
        method, words = simulation.settings.method, simulation.instance.method_excludes()
        if status == Status.NO_TREE:
            why = f"Here {prepared(simulation.system)[1]['report']['no_tree']}. The method is {method!r}"
        else:
            why = f"{method!r} takes no {words}"
        return f" {why}; 'ali3p' takes every System."
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
        return _beyond_table(simulation)
    if status == Status.NO_EQUILIBRIUM:
        return _farthest_changed(simulation)
    if status == Status.TURNS_TOO_FAR:
        rate = simulation.instance.report()["fastest_rate"]
        return f" Its rate is {rate:.3g} rad/s; a step of {0.49 / rate:.2g} s follows it, so do more `max_halvings`."
    rate = simulation.instance.report()["fastest_rate"] if status == Status.TOO_STIFF else 0.0
    if rate > 0.0:
        h = simulation.step_tried
        return (
            f" Its rate here is {rate:.3g} 1/s, which times the step of {h:g} s is {rate * h:.3g}; that should be "
            f"below about {STIFF_STEP:g}. Implicit methods ('ali3p', 'radau_5') need not follow it."
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
    more = f" and {len(names) - MOST_NAMED} others" if len(names) > MOST_NAMED else ""
    return (
        f" Shorter steps do not help: driven by {', '.join(names[:MOST_NAMED])}{more} the joints can be closed until "
        f"about t = {simulation.time + closed:.5g} s, where two ways to close them meet, and not behind it. End the "
        f"run before, or drive it less far."
    )


def _closes(evaluator: Evaluator, ahead: float) -> bool:
    """Whether positions near the state close all rows so many seconds later."""
    q, t, most = evaluator.state.q, evaluator.time + ahead, 0.0
    for _ in range(ITERATIONS):
        phi, jacobian, _ = evaluator.constraints(q, evaluator.state.qd, t)
        left = float(np.abs(phi).max())
        most = most or max(left, RANK_TOLERANCE * max(1.0, float(np.abs(q).max())) / CLOSED)
        if not left < math.inf or left <= CLOSED * most:
            break
        q = q - np.linalg.lstsq(jacobian, phi, rcond=RANK_TOLERANCE)[0]
    return left <= CLOSED * most


def _beyond_table(simulation: SteppedSystem) -> str:
    """The coordinate that is farthest beyond its table."""
    column, value, first, last = simulation.instance.beyond_table()
    name = prepared(simulation.system)[1]["coordinates"][column]
    return (
        f" {name!r} is {value:.4g}; its table goes from {first:.4g} to {last:.4g}: give it one that covers what the "
        "run can reach."
    )


def _farthest_changed(simulation: SteppedSystem) -> str:
    """The parameters that were changed by most of their ranges."""
    changed = []
    for k, entry in enumerate(prepared(simulation.system)[1]["parameters"]):
        value, span = simulation.instance.get_parameter(k), entry["max"] - entry["min"]
        if value != entry["value"]:
            words = f"{entry['name']!r} is {value:g}{unit_text(entry['unit'])} in place of {entry['value']:g}"
            changed.append((abs(value - entry["value"]) / span if span < math.inf else math.inf, words))
    changed.sort(key=lambda item: -item[0])
    said = "; ".join(words for _, words in changed[:MOST_NAMED])
    more = f" (and {len(changed) - MOST_NAMED} others)" if len(changed) > MOST_NAMED else ""
    return f" {said}{more}: set them nearer to the values that the model was compiled with." if said else ""


def _worst_equations(simulation: SteppedSystem, report: dict[str, float]) -> str:
    """The constraint row and the balance that are farthest from zero."""
    meta, said = prepared(simulation.system)[1], ""
    worst = open_row(report, [row["name"] for row in meta["rows"]])
    if worst:
        said += f" Worst constraint: {worst}."
    if simulation.system.fineness * simulation.settings.tolerance_r < report["residual"] < math.inf:
        name = meta["coordinates"][int(report["worst_coordinate"])]
        said += f" Worst balance: {name!r}, residual {report['residual']:.3g}."
    return said
