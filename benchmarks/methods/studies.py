"""Studies on Dask: overhead of a run, memory and disk, and the tables of `docs/scale.md`."""

import multiprocessing
import tempfile
import time
from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
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
from benchmarks.shared.command import watched
from benchmarks.shared.pages import Row, table
from fmu_src.build.build import build_fmu
from hosts.study.folder import begin_study
from hosts.study.missing_runs import cluster_runner, missing_runs
from hosts.study.plan import make_plan
from hosts.study.study_file import read_study_file
from hosts.study.study_runs import Bench, experiment_of, outcome_of
from hosts.study.trial_runs import make_trial_runs

T = TypeVar("T")

_CAR = """fmu = '{fmu}'
[[manoeuvres]]
manoeuvre = "slalom"
stop_time = {stop_time!r}
[sampling]
method = "sobol"
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
method = "sobol"
runs = {runs}
[parameters."spring.stiffness"]
range = [50.0, 200.0]
[parameters."spring.damping"]
range = [0.0, 5.0]
[measures]
low = "min(bob.y)"
end = "final(bob.y)"
"""
PARTS = ("overhead", "memory")
_LOOP = 50
OPTIONS = {
    "fmu": ("dist/PrototypeCar.fmu", "of the car"),
    "runs": (200, "of the car"),
    "seconds": (0.1, "of a run of the car, s"),
    "workers": ((1, 2), "of the cluster"),
    "sizes": ((500, 2000), "runs of a small FMU"),
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


def plan_of(case: str, fmu: Path, runs: int, stop_time: float, folder: Path) -> Any:
    """Write the file of a study into a folder and make its plan. `stop_time`: s."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{case}.toml"
    text = TEXTS[case].format(fmu=fmu.absolute(), stop_time=stop_time, runs=runs)
    file.write_text(text, encoding="utf-8")
    return make_plan(read_study_file(file)[0], file, fmu.absolute())


def stop_time_for(case: str, fmu: Path, seconds: float, folder: Path) -> float:
    """Simulated time, s, of a run that takes `seconds` in a plain loop."""
    trial = 1.0
    return round(max(0.1, trial * seconds / plain_loop(case, fmu, 5, trial, folder)["run_s"]), 2)


def plain_loop(case: str, fmu: Path, runs: int, stop_time: float, folder: Path) -> dict[str, Any]:
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


def study_runs(case: str, fmu: Path, runs: int, workers: int, stop_time: float, folder: Path) -> dict[str, Any]:
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
        runner = cluster_runner(client, plan, trial.seconds, plan.runs)
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


def measure(options: Namespace) -> list[dict[str, Any]]:
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
    if "memory" in options.only:
        spring = spring_fmu(folder)
        for runs in options.sizes:
            arguments = ("spring", spring, runs, max(options.workers), 1.0, folder / f"spring-{runs}")
            yield lambda arguments=arguments: in_new_process(study_runs, *arguments)


def study_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the page by the names of their marks, of the measured parts."""
    results: dict[str, str] = {}
    car, spring = ([r for r in rows if r["table"] == "runs" and r["case"] == case] for case in ("car", "spring"))
    if car:
        columns = {"workers": "d", "runs": ",d", "run, s": ".4f", "runs/s": ".2f", "chunks": ",d"}
        columns |= {"overhead, ms/run": ".2f", "overhead": ".2%", "bytes/run": ".0f", "parts": "d", "failed": "d"}
        loop = next((r for r in rows if r["table"] == "loop"), None)
        alone = f"\n\nThe same runs in a plain loop without Dask take {loop['run_s']:.4f} s each." if loop else ""
        results["study overhead"] = table(car, columns) + alone
    if spring:
        columns = {"runs": ",d", "main before, MB": ".0f", "main at most, MB": ".0f", "main, ms/run": ".3f"}
        results["study memory"] = table(spring, columns | {"worker, MB": ".0f", "bytes/run": ".0f", "parts": "d"})
    return results
