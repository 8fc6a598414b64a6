"""Verdict on a run in equal steps: which further runs it needs, and what they say."""

from dataclasses import replace

from mbs.kernel.header.enumerations import Status
from mbs.kernel.header.limits import MOST_PARTS, WRONG_ERROR
from mbs.kernel.header.steps import Balance
from mbs.results import accuracy
from mbs.results.accuracy import Accuracy
from mbs.results.comparison import compared_sensors, has_recovered
from mbs.results.simulation_error import SimulationError
from mbs.simulation.coarser_run import CoarserRuns
from mbs.simulation.refined_run import BudgetExceededError, RefinedRuns


def verdict_on(refined: RefinedRuns, always: bool) -> Accuracy | None:
    """Accuracy of a run after the further runs that it needs.

    A run that is plainly smooth needs none. One that goes on from no other is first compared with `CoarserRuns`, and
    refined if they differ. `always`: it is refined in any case.
    """
    run = refined.run[0]
    if run.report is None or run.accuracy is None or run.settings is None or len(run.t) < 2:
        return run.accuracy
    needed_check = accuracy.required_check(run.report, run.settings.method, has_recovered(refined.compared))
    if not (always or refined.divisor or needed_check):
        return run.accuracy
    rest = accuracy.rest_text(run, compared_sensors(refined.system)) if refined.rests else ""
    if not always and refined.before is None and needed_check == accuracy.COARSER:
        if refined.rests:
            return replace(run.accuracy, notice=rest)
        confirmed = CoarserRuns(refined).verdict()
        if confirmed is not None:
            return confirmed
    try:
        known = refined.verdict()
    except BudgetExceededError:
        return _unchecked(refined)
    except SimulationError as error:
        return replace(run.accuracy, check_cost=refined.cost, message=_refusal_text(refined.tried, error))
    return _judged(refined, known, rest)


def _unchecked(refined: RefinedRuns) -> Accuracy:
    """Accuracy of a run of which the next refined run exceeds the budget, with a budget that suffices."""
    report, known = refined.run[0].report, refined.known
    assert report is not None
    assert known is not None
    further_costs = [refined.h / refined.tried * factor for factor in (1, 2, 4, MOST_PARTS)]
    needed = refined.cost + sum(cost for cost in further_costs if cost < (MOST_PARTS + 0.5) * refined.parts)
    text = accuracy.budget_text(known, refined.tried, refined.max_cost, needed)
    return replace(known, check_cost=refined.cost, message=f"{accuracy.balance_text(report)} {text}".strip())


def _refusal_text(step: float, error: SimulationError) -> str:
    """Sentence about a refined run in steps of `step`, s, that ended with `error`."""
    if error.status == Status.ROAD_LOST:  # not a fault of the steps
        return f"The error of the run is not known: in a refined run with steps of {step:g} s {error}"
    return f"A refined run with steps of {step:g} s was refused, so the result is not to be trusted: {error}"


def _judged(refined: RefinedRuns, known: Accuracy, rest: str) -> Accuracy:
    """`known`, the accuracy by refined runs, with the message or notice that follows; `rest`: notice of a rest."""
    run = refined.run[0]
    assert run.report is not None
    balance, branch = accuracy.balance_text(run.report), run.branch_change if refined.left_alone else ""
    error_text = refined.text(known) if (known.error or 0.0) > WRONG_ERROR else ""
    # an open balance is evidence against the run if the balance of the finest run is wrong too
    if not (error_text or (balance and refined.finest.balance == Balance.WRONG)):
        return replace(known, branch=branch, notice=f"{balance} {accuracy.RIGHT}" if balance else rest)
    step_errors = refined.tried_steps(known) if error_text else []
    remedy = accuracy.remedy(refined.system, refined.method, step_errors)
    message = " ".join(filter(None, [error_text, balance, remedy]))
    return replace(known, check_cost=refined.cost, branch=branch, message=message)
