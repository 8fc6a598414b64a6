"""What a report says of a landing that is too quick for the step, against the motion of a wheel on a column."""

from __future__ import annotations

import numpy as np
import pytest

import mbs
from mbs.common.affine import Affine
from mbs.elements.road import PlaneRoad
from tests.elements.tyre_data import TYRE

G = 9.81
LIMIT, SPAN = 0.15, 0.2  # of the path of the velocity, s
WHOLE = mbs.Settings(max_halvings=0)


def falling(mass: float, h: float) -> mbs.Trajectory:
    """A wheel that falls 0.3 m onto its tyre."""
    m = mbs.Model("wheel")
    hub = (0.0, 0.0, TYRE.radius + 0.3)
    wheel = m.body("wheel", mass=mass, com=hub, inertia=(1.0, 1.0, 1.0))
    m.prismatic("column", wheel, m.ground, axis=(0.0, 0.0, 1.0), point=hub)
    m.add(TYRE.record("tyre", wheel.point(hub), wheel.vector((0.0, 1.0, 0.0)), Affine(), m.road(PlaneRoad())))
    m.sense_element("load", "tyre", "vertical_force")
    m.sense_position("speed", wheel, hub, component="z", order=1)
    return mbs.simulate(mbs.compile(m), 1.0, h, progress=False, estimate_error=False, settings=WHOLE)


def found(run: mbs.Trajectory, mass: float, h: float) -> tuple[float, float]:
    """What the steps from the worst one of the first landing on miss of v + h a, over the path of v; and when."""
    v, load = run["speed"], run["load"]
    change, miss = np.diff(v), np.diff(v) - h * (load[:-1] / mass - G)
    begin = int(np.flatnonzero(load > 0.0)[0]) - 1
    steps = slice(begin, begin + 1 + round(SPAN / h))
    assert np.abs(miss[steps]).argmax() == 0
    return float(np.sqrt(np.sum(miss[steps] ** 2)) / np.sum(np.abs(change[steps]))), float(run.t[begin])


@pytest.mark.parametrize(
    ("mass", "h", "told"), [(20.0, 0.015, True), (40.0, 0.02, True), (22.0, 0.015, False), (50.0, 0.0185, False)]
)
def test_a_landing_is_told_by_what_its_steps_miss(mass: float, h: float, told: bool) -> None:
    """The worst step is that of the landing; shares lie on both sides of the limit."""
    run = falling(mass, h)
    share, when = found(run, mass, h)
    assert (share > LIMIT) is told
    assert abs(share - LIMIT) < 0.03
    if not told:
        assert run.report.coarse_event == 0.0
        return
    assert run.report.coarse_event == pytest.approx(share, rel=1e-6)
    assert run.report.coarse_time == pytest.approx(when, abs=0.5 * h)  # the span is counted in whole steps
