"""Makes the missing runs of a study, in processes of this machine or on the workers of a cluster."""

from __future__ import annotations

import sys
from collections.abc import Generator
from contextlib import ExitStack, closing
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ali3.cores import available_cores
from ali3.isolated_processes import Lost
from hosts.experiment.experiment import Runner
from hosts.study.outcome_table import Row
from hosts.study.plan import Plan
from hosts.study.study_runs import experiment_of, outcome_of, report_start
from hosts.study.worker_data import Outcome, Run

if TYPE_CHECKING:
    from hosts.experiment.cluster_runs import ClusterRuns

_CHUNK_BYTES = 20e6  # of signals in the results of a chunk of runs
_BLOCK = 1000  # runs that are prepared at a time


def make_runs(
    plan: Plan, seconds: float, done: NDArray[np.bool_], scheduler: str | None, workers: int | None
) -> Generator[Row]:
    """Make the runs that are not done, on a cluster or in processes of this machine.

    `seconds`: estimated time of a run; `done`: shape (runs,).
    """
    work, count = plan.work, int(np.count_nonzero(done))
    experiment, runs = experiment_of(work, plan.fmu), missing_runs(plan, done)
    with ExitStack() as stack:
        runner: Runner[Run, Outcome]
        if scheduler is None:
            runner = experiment.pool(workers or available_cores())
        else:
            from hosts.experiment.cluster import connected

            client = stack.enter_context(connected(scheduler))
            runner = stack.enter_context(cluster_runner(client, plan, seconds, plan.runs - count))
        results = stack.enter_context(closing(experiment.results(runs, runner, whole=plan.runs, before=count)))
        for _, run, result in results:
            outcome = outcome_of(work, result)
            if scheduler is not None and isinstance(result, Lost):
                print(f"note: Run {run.index} failed. {outcome.reason}", file=sys.stderr)
            yield run, outcome


def missing_runs(plan: Plan, done: NDArray[np.bool_]) -> Generator[Run]:
    """Runs that are not done, in the order of their numbers. `done`: shape (runs,)."""
    for first in range(0, len(done), _BLOCK):
        indices = (first + np.flatnonzero(~done[first : first + _BLOCK])).tolist()
        for run in plan.runs_at(indices) if indices else []:
            report_start(plan.work, run)
            yield run


def cluster_runner(client: Any, plan: Plan, seconds: float, runs: int) -> ClusterRuns[Run, Outcome]:
    """The runner of a cluster, after sending the study to its workers. `seconds`: estimated time of a run."""
    from hosts.experiment.cluster import send_experiment
    from hosts.experiment.cluster_runs import ChunkSize, ClusterRuns
    from hosts.experiment.cluster_worker import UnpackedFmu

    work = plan.work
    unpacked_fmu = UnpackedFmu(plan.key, work.fmu.path.name, work.sha256, work.program, partial(experiment_of, work))
    send_experiment(client, unpacked_fmu, plan.fmu)
    bytes_a_run = max(8 * job.samples * len(work.signals) for job in work.jobs) + 1
    size = ChunkSize(seconds, sum(client.nthreads().values()), int(_CHUNK_BYTES / bytes_a_run))
    return ClusterRuns(client, unpacked_fmu, runs, size)
