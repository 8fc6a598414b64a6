"""Declarations of elements (element.h, ElementRecord) agree with their behaviour."""

import numpy as np
import pytest

from mbs.elements import Drag, EndStops, KerbRoad, PlaneRoad, ScalarSpringDamper, SpringDamper
from tests.elements.harness import Element, signals, vectors
from tests.elements.test_generic import elements
from tests.elements.tyre_data import TYRE, tyre_element, upright

INPUTS = (30.0, -20.0, 7.0)
H = 0.02
ROUND_OFF = 1e-11


def springs() -> dict[str, tuple[Element, bool]]:
    """Springs, and whether they take energy."""
    (d,), x = vectors(3), signals(1)[0]
    stops, lossy = EndStops(0.9, 8e3, 1.1, 5e3), EndStops(0.9, 8e3, 1.1, 5e3, rebound_loss=0.1)
    return {
        "spring": (Element(SpringDamper(1000.0, 0.0, 0.75).record("s", d)), False),
        "spring with damper": (Element(SpringDamper(1000.0, 1.0, 0.75).record("s", d)), True),
        "spring with stops": (Element(SpringDamper(1000.0, 0.0, 0.75, stops).record("s", d)), False),
        "spring with lossy stops": (Element(SpringDamper(1000.0, 0.0, 0.75, lossy).record("s", d)), True),
        "scalar spring": (Element(ScalarSpringDamper(30.0, 0.0, 0.3, 5.0).record("s", x)), False),
        "scalar spring with damper": (Element(ScalarSpringDamper(30.0, 2.0, 0.3, 5.0).record("s", x)), True),
        "drag": (Element(Drag(0.8).record("d", d)), True),
        "tyre": (tyre_element(), True),
    }


@pytest.mark.parametrize("name", springs())
def test_elements_that_take_energy_say_so(name: str) -> None:
    element, lossy = springs()[name]
    assert element.conservative is not lossy


@pytest.mark.parametrize("name", [*elements(), *(n for n in springs() if n != "tyre")])
def test_the_work_of_a_conservative_element_is_the_change_of_its_potential(name: str) -> None:
    element = (elements() | {n: e for n, (e, _) in springs().items()})[name]
    rng, taken = np.random.default_rng(1), 0.0
    for _ in range(20):
        u, ud = rng.normal(size=(2, len(element.element.signals)))
        power = element(u, ud).f @ ud  # no inputs: they bring energy of their own
        ahead, behind = (element(u + s * 1e-6 * ud, ud).potential for s in (1.0, -1.0))
        taken = min(taken, power + (ahead - behind) / 2e-6)
    if element.conservative:
        assert taken == pytest.approx(0.0, abs=0.05)  # stops have kinks: 8e3 N/m over 1e-6 m
    else:
        assert taken < -0.5


@pytest.mark.parametrize("name", [n for n, (e, lossy) in springs().items() if not lossy])
def test_steps_of_a_conservative_element_keep_its_energy(name: str) -> None:
    element = springs()[name][0]
    rng, n = np.random.default_rng(2), len(element.element.signals)
    for _ in range(50):
        u0, u1 = rng.normal(size=(2, n))
        middle, rate = 0.5 * (u0 + u1), (u1 - u0) / (2.0 * H)
        f = element(middle, rate, None, H, discrete=element.has_discrete).f
        before, after = (element(u, np.zeros(n)).potential for u in (u0, u1))
        assert f @ (u1 - u0) == pytest.approx(before - after, rel=ROUND_OFF, abs=ROUND_OFF * (abs(before) + abs(after)))


@pytest.mark.parametrize("name", [*elements(), "tyre"])
def test_an_element_without_a_tangent_declares_it(name: str) -> None:
    element = tyre_element() if name == "tyre" else elements()[name]
    rng, n, most = np.random.default_rng(3), len(element.element.signals), 0.0
    for _ in range(5):
        u = upright(0.25) + 0.01 * rng.normal(size=n) if name == "tyre" else rng.normal(size=n)
        f = element(u, rng.normal(size=n), None, 0.01, inputs=INPUTS).f
        other = element(u + 1e-3 * rng.normal(size=n), rng.normal(size=n), None, 0.01, inputs=INPUTS).f
        most = max(most, float(np.max(np.abs(f - other))))
    assert (most > 0.0) is element.element.tangent


def test_the_verdict_of_a_tyre_on_a_start() -> None:
    tyre, radius = tyre_element(), TYRE.radius
    assert tyre.start(upright(2.0 * radius)) == (-radius, 0.0)  # in the air
    excess, rise = tyre.start(upright(0.1))
    assert (excess, rise) == pytest.approx((-0.1, radius - 0.1))  # pressed in by less than its radius
    excess, rise = tyre.start(upright(-0.2))
    assert (excess, rise) == pytest.approx((0.2, radius + 0.2))
    assert tyre.start(upright(-0.2), raised=radius + 0.2) == pytest.approx((-radius, 0.0), abs=2e-16)


def test_the_rise_on_a_slope_and_before_a_kerb_clears_the_road_bit_by_bit() -> None:
    for road in (PlaneRoad(grade_x=0.3), KerbRoad(1.0, 0.4, -0.4)):
        tyre, raised = tyre_element(road=road), 0.0
        for _ in range(100):
            excess, rise = tyre.start(upright(-0.5, x=0.9), raised)
            if rise == 0.0:
                break
            raised += rise
        assert rise == 0.0
        assert excess == pytest.approx(-TYRE.radius, abs=2e-6)
        assert tyre.start(upright(-0.5, x=0.9), raised - 0.01)[1] > 0.0
