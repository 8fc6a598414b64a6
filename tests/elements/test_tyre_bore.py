"""Bore torque and camber thrust: turning on the spot, energy, rest, tangent, and both formulas alike."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import cos, hypot, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

from mbs.elements import MagicTyre, Tyre, TyreBore
from mbs.tyre_files import read_tyre
from tests.elements.harness import Element
from tests.elements.test_magic_tyre import element_of
from tests.elements.tyre_data import TYRE, tyre_element, upright

BORE = TyreBore(width=0.12, stiffness=4000.0, damping=25.0)
LOAD = 1500.0


@cache
def magic() -> MagicTyre:
    file = Path(__file__).parents[1] / "tyre_files" / "data" / "assumed_61.tir"
    return replace(read_tyre(file).tyre(), progression=0.0, bore=BORE)


def tmeasy() -> Tyre:
    return replace(TYRE, bore=BORE)


def elements() -> dict[str, Element]:
    return {"tmeasy": tyre_element(tmeasy()), "magic formula": element_of(magic())}


def turned(element: Element, angle: float, load: float = LOAD) -> np.ndarray:
    """Signals of an upright wheel that is steered to the left by an angle."""
    reals = dict(zip(element.element.real_names, element.element.real, strict=True))
    stiff = reals["stiffness"] * (1.0 + reals.get("PFZ1", 0.0) * reals.get("pressure", 0.0))
    u = upright(reals["radius"] * reals.get("Q_RE0", 1.0) - load / stiff)
    u[3:6] = -sin(angle), cos(angle), 0.0
    return u


def steered(element: Element, rate: float, duration: float, h: float, y: np.ndarray | None = None, at: float = 0.0):
    """Turn about the vertical on the spot at a rate, rad/s; results of all steps, the last angle."""
    y, angle, results = np.zeros(6) if y is None else y, at, []
    for _ in range(round(duration / h)):
        angle += rate * h
        ud = np.zeros(7)
        ud[3:6] = -rate * cos(angle), -rate * sin(angle), 0.0
        r = element(turned(element, angle), ud, y, h, 0.5 * h, 0.25 * h * h)
        results.append(r)
        y = r.y
    return results, angle


def lever(element: Element) -> float:
    """R of Rill: two thirds of the mean of half the length and half the width."""
    reals = dict(zip(element.element.real_names, element.element.real, strict=True))
    radius = reals["radius"] * reals.get("Q_RE0", 1.0)
    length = 2.0 * sqrt(radius * (radius - turned(element, 0.0)[2]))
    return (0.5 * length + 0.5 * BORE.width) / 2.0 * 2.0 / 3.0


@pytest.mark.parametrize("name", ["tmeasy", "magic formula"])
def test_on_the_spot_the_carcass_twists_then_the_patch_slides_at_its_friction(name: str) -> None:
    element, h = elements()[name], 0.002
    run, _ = steered(element, 0.5, 1.0, h)
    moments = np.array([r.out["aligning_moment"] for r in run])
    angle = 0.5 * 4.5 * h  # after five steps: the trapezoidal rule begins from rest
    assert moments[4] == pytest.approx(-BORE.stiffness * angle - BORE.damping * 0.5, rel=1e-4)
    reals = dict(zip(element.element.real_names, element.element.real, strict=True))
    friction = 1501.0 if name == "tmeasy" else None
    if friction is None:  # the peak of the formula with its shift, as its own limit has it
        slides = moments[-1] / lever(element)
        peak = reals["PDY1"] + reals["PDY2"] * (LOAD / reals["nominal_load"] - 1.0)
        assert -slides == pytest.approx(abs(peak) * LOAD, rel=0.05)
    else:
        assert moments[-1] == pytest.approx(-friction * lever(element), rel=1e-9)
    assert moments[-1] == pytest.approx(moments[-100], rel=1e-6)


@pytest.mark.parametrize("name", ["tmeasy", "magic formula"])
def test_turning_dissipates_energy_and_stored_energy_is_returned(name: str) -> None:
    """Work on the patch is what the potential gains and what damper and sliding take, in every step."""
    element, h = elements()[name], 0.001
    y, angle, worst, taken = np.zeros(6), 0.0, 0.0, 0.0
    stored = element(turned(element, 0.0), np.zeros(7), y).potential
    moment = 0.0
    for k in range(1500):
        rate = 0.6 * sin(2.0 * np.pi * k * h)
        angle += rate * h
        ud = np.zeros(7)
        ud[3:6] = -rate * cos(angle), -rate * sin(angle), 0.0
        r = element(turned(element, angle), ud, y, h)
        work = 0.5 * (r.out["aligning_moment"] + moment) * rate * h
        lost = -work - (r.potential - stored)
        worst, taken = min(worst, lost), taken + lost
        moment, stored, y = r.out["aligning_moment"], r.potential, r.y
    assert taken > 5.0
    assert worst > -2e-3 * taken


@pytest.mark.parametrize("name", ["tmeasy", "magic formula"])
def test_a_wheel_that_stops_turning_keeps_its_moment_and_is_quiet(name: str) -> None:
    element, h = elements()[name], 0.005
    run, angle = steered(element, 0.5, 0.02, h)  # well below sliding
    rest, _ = steered(element, 0.0, 1.0, h, run[-1].y, angle)
    moments = np.array([r.out["aligning_moment"] for r in rest])
    assert moments[-1] == pytest.approx(-BORE.stiffness * 0.01, rel=2e-3)
    assert np.ptp(moments[5:]) < 5e-3 * abs(moments[-1])
    none, _ = steered(element, 0.0, 0.1, h)
    assert none[-1].out["aligning_moment"] == 0.0


@pytest.mark.parametrize("name", ["tmeasy", "magic formula"])
def test_force_and_moment_share_friction(name: str) -> None:
    """A wheel that holds a side force while it turns lets go of it."""
    element, h = elements()[name], 0.002
    y = np.zeros(6)
    for _ in range(50):  # pushed to the left by 3 mm
        ud = np.zeros(7)
        ud[1] = 0.03
        y = element(turned(element, 0.0), ud, y, h).y
    sticking = element(turned(element, 0.0), np.zeros(7), y, h).out["lateral_force"]
    run, _ = steered(element, 0.5, 1.0, h, y)
    forces = [hypot(r.out["longitudinal_force"], r.out["lateral_force"]) for r in run]
    assert abs(sticking) > 150.0
    assert forces[-1] < 0.1 * abs(sticking)
    assert all(later <= before * (1.0 + 1e-9) for before, later in pairwise(forces))


@pytest.mark.parametrize("gamma", [0.0, 0.04, -0.04])
def test_a_rolling_wheel_on_a_circle_has_the_moment_of_its_slip(gamma: float) -> None:
    """Below sliding T = -dF/ds R^2 w_n/v by the initial slope of the curve; w_n has the spin of a leaning wheel."""
    element, h, y = tyre_element(tmeasy()), 0.01, np.zeros(6)
    depth = LOAD * cos(gamma) / TYRE.stiffness
    loaded = TYRE.radius - depth
    u = np.array([0.0, 0.0, loaded * cos(gamma), 0.0, cos(gamma), sin(gamma), 0.0])
    speed, rate = 20.0, 0.2
    omega = 3.0 * speed / (2.0 * TYRE.radius + loaded)
    for _ in range(400):
        r = element(u, np.array([speed, 1e-9, 0.0, -rate, 0.0, 0.0, omega]), y, h)
        y = r.y
    radius = (2.0 * sqrt(TYRE.radius * depth) + BORE.width) / 6.0
    q = r.out["vertical_force"] / TYRE.nominal_load
    turning = rate * cos(gamma) + omega * sin(gamma)
    expected = -q * _slope(q) * radius**2 * turning / speed
    assert r.out["aligning_moment"] == pytest.approx(expected, rel=1e-4)


def _slope(q: float) -> float:
    first, second = TYRE.lateral.slope
    return 2.0 * first - 0.5 * second - (first - 0.5 * second) * q


def test_of_the_formula_it_is_gone_where_the_wheel_rolls() -> None:
    y = np.zeros(6)
    element, plain = element_of(magic()), element_of(replace(magic(), bore=None))
    u = turned(element, 0.0)
    ud = np.array([5.0, 0.1, 0.0, -0.3, 0.0, 0.0, 5.0 / u[2]])
    for _ in range(200):
        r = element(u, ud, y, 0.01)
        y = r.y
    assert r.y[4] == 0.0
    other = np.zeros(4)
    for _ in range(200):
        p = plain(u, ud, other, 0.01)
        other = p.y
    assert r.out["aligning_moment"] == p.out["aligning_moment"]


@pytest.mark.parametrize("name", ["tmeasy", "magic formula"])
@pytest.mark.parametrize("before", [0.01, 0.5])
def test_the_tangent_about_the_normal_is_the_slope_of_the_moment_or_the_safe_share(name: str, before: float) -> None:
    element, h, rate = elements()[name], 0.005, 0.5
    run, angle = steered(element, rate, before, h)
    y, direction = run[-1].y, np.array([-cos(angle), -sin(angle)])

    def at(w: float):
        ud = np.zeros(7)
        ud[3:5] = w * direction
        return element(turned(element, angle), ud, y, h, 0.5 * h, 0.0)

    step = 1e-4
    slope = (at(rate + step).out["aligning_moment"] - at(rate - step).out["aligning_moment"]) / (2.0 * step)
    got = direction @ at(rate).S[3:5, 3:5] @ direction / (0.5 * h)
    sticks = 0.5 * h * BORE.stiffness + BORE.damping
    if before < 0.1:
        assert got == pytest.approx(sticks, rel=1e-3)
        assert got == pytest.approx(-slope, rel=1e-3)
        assert -slope > 1.0
    else:  # it slides: flat, but not below what Newton's method needs
        assert abs(slope) < 1e-3 * got
        assert 0.3 * sticks < got < 0.6 * sticks


@pytest.mark.parametrize("gamma", [0.02, -0.05])
def test_camber_thrust_is_that_of_the_slip_it_stands_for(gamma: float) -> None:
    """A leaning wheel that rolls straight has the force of an upright one at the slip camber_slip sin(gamma)."""
    element, h = tyre_element(replace(TYRE, camber_slip=0.1)), 0.02
    for speed in (3.0, -3.0):
        y, height = np.zeros(6), (TYRE.radius - LOAD * cos(gamma) / TYRE.stiffness) * cos(gamma)
        u = np.array([0.0, 0.0, height, 0.0, cos(gamma), sin(gamma), 0.0])
        loaded = height / cos(gamma)
        ud = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0 * speed / (2.0 * TYRE.radius + loaded)])
        for _ in range(500):
            r = element(u, ud, y, h)
            y = r.y
        load = r.out["vertical_force"]
        q, (m1, m2) = load / TYRE.nominal_load, TYRE.lateral.max_force
        slope, most = q * _slope(q), q * (2.0 * m1 - 0.5 * m2 - (m1 - 0.5 * m2) * q)
        x1, x2 = TYRE.lateral.max_slip
        s = 0.1 * abs(sin(gamma))
        x = s / (x1 + (x2 - x1) * (q - 1.0))
        expected = slope * s / ((1.0 - x) ** 2 + slope * s / most)  # Hirschberg, Rill and Weinfurter, up to the maximum
        assert r.out["lateral_force"] == pytest.approx(-np.sign(gamma) * expected, rel=1e-5)
        assert abs(r.out["aligning_moment"]) < 1e-6 * expected


@pytest.mark.parametrize("h", [0.01, 1.0])
def test_thrust_and_moment_only_take_energy(h: float) -> None:
    """Power on the wheel plus that on the carcass is never positive, from any state, in each of many motions."""
    bare = replace(TYRE, rolling_resistance=0.0, trail=(0.0, 0.0), camber_slip=0.3, bore=BORE)
    element, rng = tyre_element(bare), np.random.default_rng(5)
    largest = 0.0
    for _ in range(300):
        gamma, speed = 0.1 * rng.normal(), 10.0 ** rng.uniform(-4.0, 1.0)
        u = np.array([0.0, 0.0, 0.25 * cos(gamma), 0.0, cos(gamma), sin(gamma), 0.0])
        vx, vy, rate = speed * rng.normal(size=3) * [1.0, 0.1, 1.0]
        ud = np.array([vx, vy, 0.0, -rate, 0.0, 0.0, vx / 0.262 + rng.choice([0.0, 1.0]) * speed * rng.normal()])
        y = np.r_[0.01 * rng.normal(size=2), 0.1 * rng.normal(size=2), 0.01 * rng.normal(), 0.1 * rng.normal()]
        r = element(u, ud, y, h)
        forces = np.array([r.out["longitudinal_force"], r.out["lateral_force"], r.out["aligning_moment"]])
        on_wheel, on_carcass = r.f @ ud, forces @ r.y[[2, 3, 5]]
        largest = max(largest, abs(on_wheel))
        assert on_wheel + on_carcass <= 1e-9 * (abs(on_wheel) + abs(on_carcass))
    assert largest > 100.0


def test_a_leaning_wheel_at_rest_has_no_thrust() -> None:
    element = tyre_element(replace(TYRE, camber_slip=0.1))
    u = np.array([0.0, 0.0, 0.245, 0.0, cos(0.05), sin(0.05), 0.0])
    y = np.zeros(6)
    for _ in range(100):
        y = element(u, np.zeros(7), y, 0.1).y
    assert not y.any()


@pytest.mark.parametrize("change", [{"width": 0.0}, {"stiffness": -1.0}, {"damping": 0.0}])
def test_bad_numbers_are_refused_with_a_sentence(change: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=f"{next(iter(change))} of the bore torque of the tyre 'tyre'"):
        tyre_element(replace(TYRE, bore=replace(BORE, **change)))
