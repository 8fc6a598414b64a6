"""Measurements of studies on Dask: overhead of a run, memory, disk, tasks, rows, starts."""

import gc
import multiprocessing
import subprocess
import tempfile
import time
from argparse import Namespace
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import fmpy
import numpy as np
import psutil

import mbs
from ali3.errors import UserError
from ali3.processes import module_command
from benchmarks.shared.command import watched
from fmu_src.build.build import build_fmu
from hosts.study.campaign import cluster_runner, missing_runs
from hosts.study.folder import begin_study
from hosts.study.plan import make_plan
from hosts.study.study_file import read_study_file
from hosts.study.study_runs import Bench, experiment_of, outcome_of
from hosts.study.trial_runs import make_trial_runs
from hosts.study.worker_data import Outcome

Row = dict[str, Any]
T = TypeVar("T")

_CAR = """fmu = '{fmu}'
[[manoeuvres]]
manoeuvre = "slalom"
stop_time = {stop_time!r}
[sampling]
method = "{method}"
runs = {runs}
[parameters."road.friction_factor"]
range = [0.4, 1.0]
[parameters."front.spring.stiffness"]
range = [9000.0, 20000.0]
[parameters."rear.damper.damping"]
range = [500.0, 2000.0]
[measures]
peak_ay = "max(abs(chassis.ay))"
roll = "rms(chassis.roll)"
load = "min(wheel_FL.Fz)"
"""
_SPRING = """fmu = '{fmu}'
[[manoeuvres]]
name = "release"
stop_time = {stop_time!r}
[sampling]
method = "{method}"
runs = {runs}
[parameters."spring.stiffness"]
range = [50.0, 200.0]
[parameters."spring.damping"]
range = [0.0, 5.0]
[measures]
low = "min(bob.y)"
end = "final(bob.y)"
"""
PARTS = ("overhead", "memory", "single")
_LOOP = 50
OPTIONS = {
    "fmu": ("dist/PrototypeCar.fmu", "of the car"),
    "runs": (200, "of the car"),
    "seconds": (0.1, "of a run of the car, s"),
    "workers": ((1, 2), "of the cluster"),
    "sizes": ((500, 2000), "runs of a small FMU"),
    "rows": (100_000, "of the plan and the writer alone"),
    "tasks": (2000, "that are empty"),
}
TEXTS = {"car": _CAR, "spring": _SPRING}
"""Study files by case."""


def spring_fmu(folder: Path) -> Path:
    """Build an FMU whose run takes about a millisecond."""
    m = mbs.Model("spring", dimension=2)
    bob = m.point_mass("bob", mass=2.0, position=(0.0, -1.0))
    spring = m.spring_damper("spring", (m.ground, (0.0, 0.0)), bob, stiffness=100.0, damping=1.0, free_length=0.8)
    for name, value, high, unit in (("stiffness", 100.0, 900.0, "N/m"), ("damping", 1.0, 20.0, "N.s/m")):
        m.parameter(f"spring.{name}", value, 0.0, high, unit, f"Of the spring: {name}", targets=[(spring, name, 1.0)])
    m.sense_position("bob.y", bob, component="y")
    return build_fmu(mbs.compile(m), "spring", folder, [fmpy.platform])


def in_new_process(work: Callable[..., T], *arguments: Any) -> T:
    """Call a function in a new process, so that its memory can be measured."""
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        return pool.submit(work, *arguments).result()


def plan_of(case: str, fmu: Path, runs: int, stop_time: float, folder: Path, method: str = "sobol") -> Any:
    """Write the file of a study into a folder and make its plan. `stop_time`: s."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{case}.toml"
    text = TEXTS[case].format(fmu=fmu.absolute(), stop_time=stop_time, runs=runs, method=method)
    file.write_text(text, encoding="utf-8")
    return make_plan(read_study_file(file)[0], file, fmu.absolute())


def stop_time_for(case: str, fmu: Path, seconds: float, folder: Path) -> float:
    """Simulated time, s, of a run that takes `seconds` in a plain loop."""
    trial = 1.0
    return round(max(0.1, trial * seconds / plain_loop(case, fmu, 5, trial, folder)["run_s"]), 2)


def plain_loop(case: str, fmu: Path, runs: int, stop_time: float, folder: Path) -> Row:
    """Row of runs one after the other without Dask, after one to warm up."""
    plan = plan_of(case, fmu, max(runs, 2), stop_time, folder)
    job, work = plan.work.jobs[0], replace(plan.work, reuse=True)
    bench, block = Bench(work, plan.fmu), plan.points.block(0, runs)
    values = [{name: column[k] for name, column in block.items()} for k in range(runs)]
    try:
        bench.run(job, values[0], 0)
        begin = time.perf_counter()
        for value in values:
            bench.run(job, value, 0)
        return {"table": "loop", "case": case, "runs": runs, "run_s": (time.perf_counter() - begin) / runs}
    finally:
        bench.close()


@contextmanager
def _cluster(workers: int) -> Iterator[str]:
    """Context of a Dask cluster with workers on this machine, one process each; yields the scheduler's address."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=workers, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0", silence_logs=50
    ) as cluster:
        yield cluster.scheduler_address


def study_runs(case: str, fmu: Path, runs: int, workers: int, stop_time: float, folder: Path) -> Row:
    """Row of a study on a Dask cluster, without its start: time in addition to the runs, memory, disk."""
    from hosts.experiment.cluster import connected
    from hosts.experiment.store import ResultStore
    from hosts.study.outcome_table import OutcomeTable
    from hosts.study.outcome_table import Row as StudyRow
    from hosts.study.parts import part_files
    from hosts.study.store import read_study

    plan = plan_of(case, fmu, runs, stop_time, folder)
    trial = make_trial_runs(plan)
    plan = replace(plan, work=replace(plan.work, reuse=trial.reuse))
    begin_study(folder, plan.record, b"", plan.fmu)
    process, memory = psutil.Process(), [0.0]
    with (
        _cluster(workers) as address,
        connected(address) as client,
        ResultStore[StudyRow](folder, StudyRow, "measures a study") as store,
    ):
        store.attach_table(OutcomeTable(folder, plan.record))
        runner = cluster_runner(client, plan, trial, plan.runs)
        before, processor, started = process.memory_info().rss, sum(process.cpu_times()[:2]), time.perf_counter()
        results = experiment_of(plan.work, plan.fmu).results(
            missing_runs(plan, np.zeros(plan.runs, np.bool_)), runner, whole=plan.runs
        )
        for _, run, result in results:
            store.add(str(run.index), "", (run, outcome_of(plan.work, result)))
            memory.append(process.memory_info().rss)
        store.write()
        elapsed, processor = time.perf_counter() - started, sum(process.cpu_times()[:2]) - processor
        of_worker = max(p.memory_info().rss for p in process.children(recursive=True))
    frame = read_study(folder)
    assert len(frame) == runs
    walls = frame["wall_seconds"].to_numpy()
    overhead = workers * elapsed - walls.sum()
    files = part_files(folder)
    return {
        "table": "runs",
        "case": case,
        "workers": workers,
        "runs": runs,
        "failed": int((frame["status"] == "failed").sum()),
        "run, s": float(walls.mean()),
        "elapsed_s": elapsed,
        "runs/s": runs / elapsed,
        "overhead, ms/run": 1e3 * float(overhead) / runs,
        "overhead": float(overhead / walls.sum()),
        "chunks": runner.chunks,
        "main, ms/run": 1e3 * processor / runs,
        "main before, MB": 1e-6 * before,
        "main at most, MB": 1e-6 * max(memory),
        "worker, MB": 1e-6 * of_worker,
        "bytes/run": sum(f.stat().st_size for f in files) / runs,
        "parts": len(files),
    }


def start_again(case: str, runs: int, folder: Path) -> Row:
    """Row of the command on a folder with all rows: the time to detect that no run is missing."""
    file = folder / f"{case}.toml"
    command = module_command("ali3", "study", str(file), "--out", str(folder), "--no-report")
    begin = time.perf_counter()
    completed = subprocess.run(command, check=False, capture_output=True, text=True)
    if completed.returncode != 0 or f"{runs} of {runs} runs are there" not in completed.stdout:
        raise RuntimeError(f"the study was not found whole: {completed.stdout} {completed.stderr}")
    return {"table": "start again", "case": case, "runs": runs, "start_s": time.perf_counter() - begin}


def measure_plan(case: str, fmu: Path, runs: int, method: str, folder: Path) -> Row:
    """Row of the time and memory of a plan, and of its points block by block."""
    plan_of(case, fmu, 16, 1.0, folder, method)
    gc.collect()
    before, begin = psutil.Process().memory_info().rss, time.perf_counter()
    plan = plan_of(case, fmu, runs, 1.0, folder, method)
    seconds, size = time.perf_counter() - begin, 1000
    begin = time.perf_counter()
    for first in range(0, runs, size):
        plan.points.block(first, min(size, runs - first))
    blocks = time.perf_counter() - begin
    memory = psutil.Process().memory_info().rss - before
    row = {"table": "plan", "method": method, "runs": runs, "start_s": seconds}
    return row | {"main_ms": 1e3 * blocks / runs, "main_mb": 1e-6 * memory}


def measure_writer(case: str, fmu: Path, rows: int, folder: Path) -> Row:
    """Row of the writer: times to write random rows in chunks of 20, to check the files, and to open them in pandas."""
    from hosts.study.damaged_files import sound_runs
    from hosts.study.outcome_table import OutcomeTable
    from hosts.study.parts import part_files
    from hosts.study.store import read_study

    plan = plan_of(case, fmu, rows, 1.0, folder)
    begin_study(folder, plan.record, b"", plan.fmu)
    rng, chunk = np.random.default_rng(0), 20
    numbers = rng.random((rows, len(plan.work.columns))).tolist()
    table, spent = OutcomeTable(folder, plan.record), 0.0
    for first in range(0, rows, chunk):
        indices = list(range(first, min(first + chunk, rows)))
        outcomes = [
            Outcome(measures=dict(zip(plan.work.columns, numbers[k], strict=True)), simulated=1.0, wall=numbers[k][0])
            for k in indices
        ]
        begin = time.perf_counter()
        for run, outcome in zip(plan.runs_at(indices), outcomes, strict=True):
            table.take("", (run, outcome))
        if table.is_full:
            table.write()
        spent += time.perf_counter() - begin
    begin = time.perf_counter()
    table.write()
    spent += time.perf_counter() - begin
    del table, numbers
    size = sum(f.stat().st_size for f in part_files(folder))
    begin = time.perf_counter()
    assert sound_runs(folder, plan.record)[0].all()
    result = time.perf_counter() - begin
    begin, before = time.perf_counter(), psutil.Process().memory_info().rss
    frame = read_study(folder)
    read = time.perf_counter() - begin
    assert len(frame) == rows
    memory = psutil.Process().memory_info().rss - before
    row = {"table": "rows", "case": case, "runs": rows, "main_ms": 1e3 * spent / rows, "bytes": size / rows}
    return row | {"found_s": result, "read_s": read, "read_mb": 1e-6 * memory}


def measure_empty_tasks(tasks: int, workers: int) -> Row:
    """Row of empty tasks: the time of Dask itself."""
    from hosts.experiment.cluster import connected

    with _cluster(workers) as address, connected(address) as client:
        client.gather(client.map(_identity, range(100), pure=False))
        process = psutil.Process()
        begin, processor = time.perf_counter(), sum(process.cpu_times()[:2])
        client.gather(client.map(_identity, range(tasks), pure=False))
        elapsed, processor = time.perf_counter() - begin, sum(process.cpu_times()[:2]) - processor
    row = {"table": "empty tasks", "runs": tasks, "workers": workers, "elapsed_s": elapsed}
    return row | {"task_ms": 1e3 * elapsed / tasks, "main_ms": 1e3 * processor / tasks}


def _identity(number: int) -> int:
    return number


def measure(options: Namespace) -> list[Row]:
    """Rows of the selected parts, each with the name of its table."""
    if "overhead" in options.only and not Path(options.fmu).is_file():
        raise UserError(f"There is no file {options.fmu}; build it, or give --fmu.")
    with tempfile.TemporaryDirectory(prefix="study-") as folder:
        return [work() for work in watched(list(_measurements(options, Path(folder))))]


def _measurements(options: Namespace, folder: Path) -> Iterator[Callable[[], dict[str, Any]]]:
    """Yield the measurements, each of which runs in a new process."""
    if "overhead" in options.only:
        car = Path(options.fmu).absolute()
        stop = in_new_process(stop_time_for, "car", car, options.seconds, folder / "calibration")
        yield lambda: in_new_process(plain_loop, "car", car, _LOOP, stop, folder / "loop")
        for workers in options.workers:
            arguments = ("car", car, options.runs, workers, stop, folder / f"car-{workers}")
            yield lambda arguments=arguments: in_new_process(study_runs, *arguments)
    if not set(options.only) & {"memory", "single"}:
        return
    spring = spring_fmu(folder)
    if "memory" in options.only:
        for runs in options.sizes:
            study_folder = folder / f"spring-{runs}"
            yield lambda runs=runs, study_folder=study_folder: in_new_process(
                study_runs, "spring", spring, runs, max(options.workers), 1.0, study_folder
            )
            yield lambda runs=runs, study_folder=study_folder: start_again("spring", runs, study_folder)
    if "single" in options.only:
        for method in ("sobol", "latin_hypercube"):
            study_folder = folder / f"plan-{method}"
            yield lambda method=method, study_folder=study_folder: in_new_process(
                measure_plan, "spring", spring, options.rows, method, study_folder
            )
        yield lambda: in_new_process(measure_writer, "spring", spring, options.rows, folder / "rows")
        yield lambda: in_new_process(measure_empty_tasks, options.tasks, max(options.workers))
