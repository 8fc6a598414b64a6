"""Run in equal steps, with coarser or refined runs that estimate its error."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mbs.common.progress import progress_for
from mbs.kernel.header.enumerations import Status
from mbs.kernel.header.limits import MOST_PARTS, WRONG_ERROR
from mbs.kernel.header.steps import Balance, BranchKind
from mbs.kernel.header.structures import ComparedFields
from mbs.results import accuracy
from mbs.results.accuracy import Accuracy
from mbs.results.comparison import compared_sensors, has_recovered
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.roads.steep_faces import RoadWarning
from mbs.settings.input_signals import Signal
from mbs.simulation import refined_run
from mbs.simulation.arguments import count_steps
from mbs.simulation.branch_warning import BranchWarning
from mbs.simulation.coarser_run import CoarserRuns
from mbs.simulation.large_bending import BendingWarning
from mbs.simulation.march import march
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System

Warned: TypeAlias = "list[tuple[type[Warning], str]]"


def run_fixed_steps(
    system: System,
    start: Callable[[float], SteppedSystem],
    t0: float,
    t_end: float,
    h: float,
    inputs: Mapping[str, Signal] | None,
    every: int,
    progress: bool | Callable[[float], None] | None,
    estimate_error: bool | float | None,
    before: dict[str, ComparedFields] | None = None,
    divisor: int = 0,
    warned: Warned | None = None,
) -> Trajectory:
    """Run in steps of `h`, s, with further runs that estimate its error, see `estimate_accuracy`.

    `start`: function that makes the simulation for a step, s; `before`, `divisor`: as in `RefinedRuns`; `warned`: list
    to which warnings except `Accuracy.message` are added, also if the run fails; None: they are issued.
    """
    is_checked = estimate_error is not False
    max_cost = accuracy.MAX_COST if estimate_error is None or isinstance(estimate_error, bool) else estimate_error
    records_coordinates = is_checked or before is not None
    sample_interval = accuracy.sampling_interval(every, count_steps(t0, t_end, h)) if is_checked else every
    thinning = every // sample_interval
    stepped = list[SteppedSystem]()
    path = list[tuple[int, Mapping[str, float]]]()
    run_accuracy: Accuracy | None = None

    def record_path(values: NDArray[np.float64]) -> bool:
        path.append((len(values), stepped[0].instance.report()))
        return False

    def march_from_start(
        step: float,
        every: int,
        progress: Callable[[float], None],
        records_coordinates: bool,
        iterations: int = 0,
        watch: refined_run.Watch | None = None,
    ) -> refined_run.Run:
        simulation = start(step)
        if iterations:
            simulation.change_settings(replace(simulation.settings, step_iterations=iterations))
        if step > h:  # a coarser run; a finer one is divided as the run that it recommends
            simulation.instance.set_settings(part_ratio=step / h)
        stepped.append(simulation)
        if len(stepped) == 1 and is_checked and before is None:  # only coarser runs that may end early need the path
            watch = record_path
        return march(simulation, t_end, step, inputs, every, progress, records_coordinates, thinning, watch)

    try:
        with progress_for(progress) as bar:
            first_fraction = 1.0 / 3.0 if estimate_error is True else 1.0
            run = march_from_start(
                h, sample_interval, lambda done: bar.update(first_fraction * done), records_coordinates
            )
            run_accuracy = run[0].accuracy
            refined = refined_run.RefinedRuns(
                system, run, march_from_start, h, sample_interval, bar.update, before, divisor, inputs, max_cost, path
            )
            if is_checked:
                run_accuracy = estimate_accuracy(refined, always=estimate_error is True)
            refined.add_ends()
    except SimulationError as error:
        if error.trajectory is not None:
            error.trajectory = error.trajectory.thinned(thinning)
        raise
    finally:  # warnings about the first run are issued even if it failed
        for category, text in _warnings_of(stepped[0], run_accuracy) if stepped else ():
            if warned is None:
                warnings.warn(text, category, stacklevel=4)
            else:
                warned.append((category, text))
    trajectory = run[0].thinned(thinning)
    trajectory.accuracy = run_accuracy
    if run_accuracy is not None and run_accuracy.notice:
        trajectory.notices += (run_accuracy.notice,)
    return trajectory


def _warnings_of(first: SteppedSystem, run_accuracy: Accuracy | None) -> Warned:
    """Warnings about the first run except `Accuracy.message`. `run_accuracy`: None if the run failed."""
    if first.report.branch_kind == BranchKind.JUMP:
        branch = first.branch_change
    else:
        branch = run_accuracy.branch if run_accuracy is not None else ""
    bending = first.bending.message_once()
    road = first.road_text if run_accuracy is not None else ""  # the error of a failed run has this message already
    messages = ((BranchWarning, branch), (BendingWarning, bending), (RoadWarning, road))
    return [(category, text) for category, text in messages if text]


def estimate_accuracy(refined: refined_run.RefinedRuns, always: bool) -> Accuracy | None:
    """Accuracy of a run after the further runs that it needs.

    Without `RefinedRuns.before` a run that is not smooth is first compared with `CoarserRuns` and refined if they
    differ. If the next refined run exceeds the remaining budget, the message says so.

    `always`: whether a smooth run is refined too.
    """
    system, run = refined.system, refined.run
    report, estimate = run[0].report, run[0].accuracy
    if report is None or estimate is None or run[0].settings is None:
        return estimate
    method, balance = run[0].settings.method, accuracy.balance_text(report)
    needed_check = accuracy.required_check(report, method, has_recovered(refined.compared))
    if len(run[0].t) < 2 or not (always or refined.divisor or needed_check):
        return estimate
    rest = accuracy.rest_text(run[0], compared_sensors(system)) if refined.rests else ""
    if not always and refined.before is None and needed_check == accuracy.COARSER:
        if refined.rests:
            return replace(estimate, notice=rest)
        confirmed = CoarserRuns(refined).verdict()
        if confirmed is not None:
            return confirmed
    try:
        estimate = refined.verdict()
    except refined_run.BudgetExceededError:
        further_costs = [refined.h / refined.tried * factor for factor in (1, 2, 4, MOST_PARTS)]
        needed = refined.cost + sum(cost for cost in further_costs if cost < (MOST_PARTS + 0.5) * refined.parts)
        estimate = refined.known or estimate
        text = accuracy.budget_text(estimate, refined.tried, refined.max_cost, needed)
        return replace(estimate, check_cost=refined.cost, message=f"{balance} {text}".strip())
    except SimulationError as error:
        text = (
            f"A refined run with steps of {refined.tried:g} s was refused, so the result is not to be trusted: {error}"
        )
        if error.status == Status.ROAD_LOST:  # not a fault of the steps
            text = f"The error of the run is not known: in a refined run with steps of {refined.tried:g} s {error}"
        return replace(estimate, check_cost=refined.cost, message=text)
    branch = run[0].branch_change if refined.left_alone else ""
    error_text = refined.text(estimate) if (estimate.error or 0.0) > WRONG_ERROR else ""
    # an open balance is evidence against the run if the balance of the finest run is wrong too
    if not (error_text or (balance and refined.finest.balance == Balance.WRONG)):
        notice = f"{balance} {accuracy.RIGHT}" if balance else rest
        return replace(estimate, branch=branch, notice=notice)
    step_errors = refined.tried_steps(estimate) if error_text else []
    message = " ".join(filter(None, [error_text, balance, accuracy.remedy(system, method, step_errors)]))
    return replace(estimate, check_cost=refined.cost, branch=branch, message=message)
