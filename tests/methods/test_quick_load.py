"""What a report says of loads of tyres that change too quickly for the step, against the loads themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import mbs
from mbs.common.affine import Affine
from mbs.elements.road import KerbRoad, PlaneRoad
from mbs.vehicle import load
from tests.elements.tyre_data import TYRE

WHEELS = ("FL", "FR", "RL", "RR")
SPAN = 0.8  # s
LIMIT, MEMORY, LATER = 6e-4, 0.1, 0.2  # s^1.5, s, s


@pytest.fixture(scope="module")
def edge() -> mbs.System:
    """The hatchback before an edge of 5 cm."""
    return mbs.compile(load("hatchback").model(KerbRoad(3.0, 0.05, 0.05, "after", 1.0)))


WHOLE = mbs.Settings(max_halvings=0)  # of steps that are divided at abrupt forces the rows do not show the parts


def drive(system, h, every=1, speed=20.0, **chosen):
    pose = mbs.Pose(speed=speed)
    return mbs.simulate(system, SPAN, h, pose=pose, every=every, progress=False, estimate_error=False, **chosen)


def loads(run):
    return np.array([run[f"wheel_{w}.Fz"] for w in WHEELS])


def found(run, h):
    """The largest memory of squared changes, its step, and the largest load within 0.2 s of it."""
    forces, total, best, begin = loads(run), 0.0, 0.0, 0
    for k, change in enumerate(np.abs(np.diff(forces)).max(axis=0)):
        total = total / (1.0 + h / MEMORY) + change**2
        if total > best:
            best, begin = total, k
    return h * np.sqrt(h * best) / forces[:, : begin + 1 + round(LATER / h)].max(), run.t[begin]


@pytest.mark.parametrize("method", ["ali3p", "ali3p_generalised_alpha", "energy_momentum"])
def test_an_edge_at_10_ms_is_found(edge, method):
    run = drive(edge, 0.01, settings=replace(WHOLE, method=method))
    report, (worst, when) = run.report, found(run, 0.01)
    assert LIMIT < report.quick_load == pytest.approx(worst, rel=1e-9)
    assert report.load_time == pytest.approx(when, abs=1e-9)
    assert report.load_step == pytest.approx(0.01 * np.sqrt(0.3 * LIMIT / worst), rel=1e-9)
    assert f"a step of {report.load_step:.2g} s" in report.coarse_text


def test_the_step_that_it_names_is_enough(edge):
    """Loads that whole steps of 20 ms have wrong are right with the named step, of which nothing is said."""
    h, speed = 0.02, 35.0
    coarse, fine = drive(edge, h, speed=speed, settings=WHOLE), drive(edge, 1e-4, every=200, speed=speed)
    every = int(np.ceil(h / coarse.report.load_step))
    again = drive(edge, h / every, every, speed, settings=WHOLE)
    size = loads(fine).max()
    assert np.abs(loads(coarse) - loads(fine)).max() > 0.05 * size
    assert np.abs(loads(again) - loads(fine)).max() < 0.05 * size
    assert again.report.quick_load == 0.0
    assert again.report.coarse_text == ""


def test_parts_of_a_divided_step_are_weighed_by_their_own_size(edge):
    """At 20 ms they are less than half as far off as whole steps, and only these are told."""
    fine, divided, whole = (
        drive(edge, h, round(0.02 / h), 35.0, **chosen)
        for h, chosen in ((1e-4, {}), (0.02, {}), (0.02, {"settings": WHOLE}))
    )
    off = [np.abs(loads(run) - loads(fine)).max() / loads(fine).max() for run in (divided, whole)]
    assert off[1] > 0.05
    assert off[0] < 0.5 * off[1]
    assert divided.report.divisions > 10
    assert divided.report.quick_load == 0.0
    assert whole.report.quick_load > LIMIT


def test_small_falls_and_jumps_of_pedals_say_nothing():
    """Of the prototype at 10 ms, right within 3 %."""
    system = mbs.compile(load("prototype").model())
    t = np.array([0.0, 0.4, 0.4, 1.0])
    inputs = {"brake": (t, np.array([0.0, 0.0, 1.0, 1.0])), "steering": (t, np.array([0.0, 0.0, 0.8, 0.8]))}
    for z in (0.0, 0.05):
        pose = mbs.Pose(speed=15.0, z=z)
        run = mbs.simulate(system, 1.0, 0.01, inputs, pose=pose, progress=False, estimate_error=False)
        assert run.report.quick_load == 0.0
        assert run.report.coarse_text == ""


def test_a_wheel_that_leaves_the_ground_in_its_first_step_is_told_by_the_load_of_its_start():
    """It has no other load; a step of 0 s was named, and the state was not restored."""
    m = mbs.Model("wheel")
    hub = (0.0, 0.0, TYRE.radius - 0.01)
    wheel = m.body("wheel", mass=40.0, com=hub, inertia=(1.0, 1.0, 1.0))
    m.prismatic("column", wheel, m.ground, axis=(0.0, 0.0, 1.0), point=hub)
    m.initial_velocity(wheel, linear=(0.0, 0.0, 1.8))
    m.add(TYRE.record("tyre", wheel.point(hub), wheel.vector((0.0, 1.0, 0.0)), Affine(), m.road(PlaneRoad())))
    m.sense_element("load", "tyre", "vertical_force")
    simulation = mbs.Simulation(mbs.compile(m), settings=WHOLE)
    run = simulation.run(0.3, 0.01, estimate_error=False)
    assert run["load"][0] > 0.0
    assert not run["load"][1:].any()
    assert run.report.quick_load == pytest.approx(0.001)  # h sqrt(h) of a load that is gone
    simulation.restore(simulation.save())
