"""Synthetic records of tests: every kind that a report can contain."""

from pathlib import Path

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.standard_test import Clause, Line, Plot, Setting, Standard, StandardTest, TestRecord
from hosts.fmu.fmu_source import FmuSource
from hosts.measures.measure import Limit, Measure

EVIL = '<script>alert("x")</script> & "Ä"'


def synthetic_test(name: str, title: str, standards: tuple[Standard, ...] = ()) -> StandardTest:
    """A test whose records are made, and which is not driven."""
    settings = (Setting("speed", 100.0, "km/h", "of the test", 20.0, 200.0),)
    return StandardTest(name, title, _undriven, standards, settings, ("steering",))


def _undriven(*_: object) -> TestRecord:
    raise NotImplementedError


def standard():
    return Standard(
        "ISO 7401:2011",
        "Lateral transient response test methods",
        (Clause("8.2", "a step of the steering wheel in 0.1 s", True), Clause("", "at 100 km/h", False)),
    )


def record(k: int, points: int = 20_000) -> TestRecord:
    """That of car k."""
    time = np.linspace(0.0, 8.0, points)
    rate = (0.3 + 0.03 * k) * (1.0 - np.exp(-time / 0.3) * np.cos(6.0 * time))
    rate[points // 3] += 0.25  # an extreme of one point
    frequency = np.geomspace(0.2, 4.0, 60)
    measures = [
        Measure("yaw_rate.response_time", 0.21 + 0.02 * k, "s", "time to 90 % of the steady yaw rate"),
        Measure("yaw_rate.overshoot", 0.12 + 0.1 * k, "1", "of the steady value", Limit("a rule, 5.2", highest=0.2)),
        Measure("understeer.gradient", 0.002, "rad.s2/m", "steering for lateral acceleration"),
        Measure("roll.time", np.nan, "s", "time to 90 % of the roll angle", note="The car has no output chassis.roll."),
    ]
    plots = [
        Plot("Yaw rate", "time, s", "yaw rate, rad/s", [Line("", time, rate)]),
        Plot(
            "Gain",
            "frequency, Hz",
            "gain, 1/s",
            [Line("yaw rate", frequency, 1 / (1 + frequency**2) + 0.1 * k), Line("roll", frequency, 0.2 / frequency)],
            log_x=True,
        ),
        Plot("Path", "x, m", "y, m", [Line("", 30 * np.cos(time), 30 * np.sin(time) + k)], equal=True),
    ]
    return TestRecord(measures, plots, {}, ("The step was 12 ms; take 10 ms.",) if k else ())


def synthetic(fmu: Path, cars: int = 3, tests: int = 10, points: int = 20_000):
    """Arguments of a report."""
    labels = ["as built", EVIL, "with $stiff$ springs", "fourth", "fifth"][:cars]
    starts = [{}, {"front.spring.stiffness": 15_000.0}, {"initial.x": 0.0}, {}, {}]
    the_cars = [TestedCar(label, FmuSource(fmu), start=start) for label, start in zip(labels, starts, strict=False)]
    the_tests = [synthetic_test(f"test_{k}", f"Test {k} of steering", (standard(),)) for k in range(tests)]
    records = {t.name: {label: record(k, points) for k, label in enumerate(labels)} for t in the_tests}
    if tests > 1:
        records["test_1"][labels[-1]] = f"The FMU has no variable steering; {EVIL}."
    return the_tests, the_cars, records
