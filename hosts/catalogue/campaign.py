"""Runs standard tests with cars: one after another in processes, with a store of what is done, tables and a report."""

import argparse
from collections.abc import Generator, Mapping, Sequence
from contextlib import closing

from ali3.cores import available_cores
from ali3.files import check_writable
from ali3.isolated_processes import Lost
from hosts.catalogue.car import TestedCar, cars_of
from hosts.catalogue.execution import Reason, reason_against, settings_of_test
from hosts.catalogue.limits import GivenLimits
from hosts.catalogue.output import print_measures, write_measures
from hosts.catalogue.registry import TESTS, standard_test
from hosts.catalogue.report import write_report
from hosts.catalogue.standard_test import StandardTest, TestRecord
from hosts.catalogue.task import Outcome, Task, find_record, perform_task, store_record, write_runs
from hosts.common.errors import HostError
from hosts.experiment.experiment import Experiment
from hosts.experiment.store import ResultStore, report_resumed
from hosts.fmu.fmu_file import fmu_file
from hosts.fmu.own_process import files_of_drives
from hosts.measures.limits import read_limits

_PENDING = "Not done yet: the command is still running, or was stopped."


def run_catalogue(options: argparse.Namespace, command: Sequence[str]) -> int:
    """Run the tests of the options, and write their results. Returns the exit code.

    `command`: words of the command line, for the report.
    """
    if not options.fmus:
        raise HostError("There is no FMU to test; name one or more. --list shows the tests.")
    names = [name.strip() for part in options.tests for name in part.split(",") if name.strip()] or list(TESTS)
    tests = [standard_test(name) for name in dict.fromkeys(names)]
    by_test = _test_settings(options.test_setting, [test.name for test in tests])
    settings = {test.name: settings_of_test(test, by_test.get(test.name, {})) for test in tests}
    requested = GivenLimits() if options.limits is None else GivenLimits(options.limits, read_limits(options.limits))
    limits = requested.of_tests(list(settings))
    if ignored := ", ".join(name for name in requested.entries if name not in limits.entries):
        print(f"{options.limits}: limits of tests that --tests leaves out are not evaluated: {ignored}", flush=True)
    for file in ("measures.csv", "measures.json", "report.html"):
        check_writable(options.out / file)
    fmus = [fmu_file(path).absolute() for path in options.fmus]
    cars = cars_of(fmus, options.aliases, options.variant, options.set, options.step)

    with ResultStore[TestRecord](options.out, TestRecord, "does tests", options.again) as store:
        return _run_tests(options, command, tests, cars, settings, limits, store)


def _run_tests(
    options: argparse.Namespace,
    command: Sequence[str],
    tests: Sequence[StandardTest],
    cars: Sequence[TestedCar],
    settings: Mapping[str, Mapping[str, float]],
    limits: GivenLimits,
    store: ResultStore[TestRecord],
) -> int:
    """Run the tests without a stored record, and write all results after each. Returns the exit code."""
    outcomes: dict[str, dict[str, Outcome]] = {test.name: {} for test in tests}
    tasks = []
    for test in tests:
        for car in cars:
            reason = reason_against(test, car, settings[test.name])
            if reason is not None:
                outcomes[test.name][car.label] = reason
            else:
                folder = None if options.no_runs else options.out.absolute()
                task = Task(test.name, car, settings[test.name], folder)
                record = find_record(store, task)
                outcomes[test.name][car.label] = _PENDING if record is None else record
                tasks += [task] if record is None else []
    found_count = sum(not isinstance(outcome, str) for by_car in outcomes.values() for outcome in by_car.values())
    report_resumed(found_count, len(tests) * len(cars), "tests")
    # Written before the first run, so that results of an earlier command are replaced.
    files = write_measures(options.out, tests, cars, limits.apply_to(outcomes)[0], settings)
    try:
        with closing(_finished_tasks(tasks, options.jobs or available_cores(), outcomes, store)) as finished:
            for _ in finished:
                write_measures(options.out, tests, cars, limits.apply_to(outcomes)[0], settings)
    finally:  # also after Ctrl-C
        judged, faults = limits.apply_to(outcomes)
        print_measures(tests, cars, judged)
        write_report(options.out / "report.html", tests, cars, judged, settings, command)
        files.append(options.out / "report.html")
        runs = "" if options.no_runs or not tasks else f", tables of the runs in {options.out / 'runs'}"
        print(f"\nwritten: {', '.join(map(str, files))}{runs}", flush=True)
        pending = sum(outcome == _PENDING for by_car in outcomes.values() for outcome in by_car.values())
        if pending:
            subject = "1 test is" if pending == 1 else f"{pending} tests are"
            print(f"{subject} not done yet; the same command resumes here.", flush=True)
    return _exit_code(judged, faults)


def _test_settings(assignments: Sequence[tuple[str, float]], names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Settings by test from ``TEST.NAME=VALUE``."""
    settings: dict[str, dict[str, float]] = {}
    for key, value in assignments:
        test, dot, name = key.partition(".")
        if not dot or test not in names:
            raise HostError(
                f"--test-setting {key}={value:g}: it must be TEST.NAME=VALUE with one of the tests that are done: "
                f"{', '.join(names)}."
            )
        if settings.setdefault(test, {}).setdefault(name, value) != value:
            raise HostError(f"--test-setting: {key} is given as {settings[test][name]:g} and as {value:g}.")
    return settings


def _finished_tasks(
    tasks: Sequence[Task], jobs: int, outcomes: Mapping[str, dict[str, Outcome]], store: ResultStore[TestRecord]
) -> Generator[None]:
    """Run all tasks with a progress bar; after each, its outcome is in `outcomes` and its record in the store."""
    experiment: Experiment[Task, Outcome] = Experiment(
        "catalogue",
        perform_task,
        TestRecord | Reason,
        lambda task: f"{task.test}, {task.car.label}",
        [file for task in tasks for file in files_of_drives(task.car.path, [task.car.start])],
    )
    with closing(experiment.results(tasks, experiment.pool(jobs))) as results:
        for _, task, outcome in results:
            outcome_or_message = f"The process of the test {outcome.how}." if isinstance(outcome, Lost) else outcome
            outcomes[task.test][task.car.label] = outcome_or_message
            if not isinstance(outcome_or_message, str):
                write_runs(task, outcome_or_message)
                store_record(store, task, outcome_or_message)
            yield


def _exit_code(outcomes: Mapping[str, Mapping[str, Outcome]], faults: Sequence[str]) -> int:
    """Print failed tests, violated limits and faults of limits. Returns the exit code."""
    results = [outcome for by_car in outcomes.values() for outcome in by_car.values()]
    failed_count = sum(isinstance(outcome, str) for outcome in results)
    violated = [m for o in results if not isinstance(o, str) for m in o.measures if m.is_kept is False]
    if failed_count:
        print(f"{failed_count} of {len(results)} tests could not be done, for the reasons above.")
    if violated:
        message = "1 measure does not keep its limit; it is"
        if len(violated) > 1:
            message = f"{len(violated)} measures do not keep their limits; they are"
        print(f"{message} marked (!).")
    for fault in faults:
        print(fault)
    return 1 if failed_count or violated or faults else 0
