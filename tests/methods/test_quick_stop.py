"""What a report says of a wheel that drops onto the metal of its rebound stop, against the law of the stop."""

from __future__ import annotations

import numpy as np
import pytest

import mbs
from mbs.vehicle import load

WHEELS = ("FL", "FR", "RL", "RR")
SPAN, JUDGED = 0.8, 0.5  # s
LIMIT = 0.047 / np.sqrt(0.005)  # of the largest force, at 5 ms


@pytest.fixture(scope="module")
def system() -> mbs.System:
    return mbs.compile(load("prototype").model())


def fall(system, h, settings=None):
    """At once from where the springs carried the car, so that the wheels hit their rebound stops before they land."""
    pose = mbs.Pose(z=0.27, speed=3.0)
    return mbs.simulate(system, SPAN, h, pose=pose, settings=settings, progress=False, estimate_error=False)


def stop_force(stops, x):
    """Rubber that fills its housing, then metal that sets in as a parabola; x, m, beyond the stop."""
    x = np.maximum(x, 0.0)
    metal, onset = stops.metal_stiffness, stops.metal_onset
    y = np.maximum(x - stops.rebound_travel, 0.0)
    hard = np.where(y < onset, metal * y**2 / (2.0 * onset), metal * (y - 0.5 * onset))
    return stops.stiffness * x * (1.0 + (x / stops.rebound_progression) ** 2) + hard


def changes(run, system):
    """Of each step the largest change of a stop's force by its tangent at the longer length, by differences, N."""
    car, worst, d = load("prototype"), np.zeros(len(run.t) - 1), 1e-8
    for wheel in WHEELS:
        stops = (car.front if wheel[0] == "F" else car.rear).stops
        number = [e["name"] for e in system.meta["elements"]].index(f"spring {wheel}")
        free = system.arrays["el_real"][
            system.arrays["el_real_ptr"][number] + 5
        ]  # length where the rebound stop is met
        beyond = run[f"spring_{wheel}.length"] - free
        longer = np.maximum(beyond[1:], beyond[:-1])
        tangent = (stop_force(stops, longer + d) - stop_force(stops, longer - d)) / (2.0 * d)
        worst = np.maximum(worst, np.where(longer > 0.0, tangent * np.abs(np.diff(beyond)), 0.0))
    return worst


def largest(run):
    """Of springs and tyres, N."""
    forces = [f"wheel_{w}.{f}" for w in WHEELS for f in ("Fx", "Fy", "Fz")] + [f"spring_{w}.force" for w in WHEELS]
    return max(np.abs(run[name][1:]).max() for name in forces)


@pytest.mark.parametrize("method", ["ali3p", "ali3p_generalised_alpha", "energy_momentum"])
def test_the_worst_step_is_found(system, method):
    """Of whole steps: of those that are divided at abrupt forces the rows do not show the parts."""
    run = fall(system, 0.005, mbs.Settings(method=method, max_halvings=0))
    report, found = run.report, changes(run, system)
    first = int(found.argmax())
    assert report.largest_force == pytest.approx(largest(run), rel=1e-6)
    assert LIMIT * report.largest_force < report.quick_change == pytest.approx(found.max(), rel=1e-4)
    assert 0.0 <= run.t[first] - report.quick_time < JUDGED
    assert report.quick_step == pytest.approx(0.3 * 0.005 * LIMIT * report.largest_force / found.max(), rel=1e-3)
    assert f"changes by {report.quick_change:.0f} N in a step" in report.quick_text


def test_the_step_that_it_names_is_enough(system):
    told = fall(system, 0.02).report
    assert told.quick_change > 0.0
    again, fine = fall(system, SPAN / np.ceil(SPAN / told.quick_step / 40) / 40), fall(system, 1e-4)
    assert again.report.quick_change == 0.0
    assert again.report.quick_text == ""
    for wheel in WHEELS:
        name = f"wheel_{wheel}.Fz"
        loads = [run[name][:: (len(run.t) - 1) // 40] for run in (again, fine)]
        assert np.abs(loads[0] - loads[1]).max() < 0.05 * np.ptp(fine[name])


def test_what_does_not_hit_the_metal_says_nothing(system):
    run = mbs.simulate(
        system, SPAN, 0.01, {"brake": 0.5}, pose=mbs.Pose(speed=15.0), progress=False, estimate_error=False
    )
    assert changes(run, system).max() == 0.0
    assert run.report.quick_change == 0.0
    assert run.report.largest_force > 1000.0
