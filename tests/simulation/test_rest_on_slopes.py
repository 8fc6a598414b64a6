"""Crates on slopes: they stand where the law of friction lets them, slide beyond it and tip where they must."""

import math

import numpy as np
import pytest

import mbs
from mbs.elements import ContactPoints, PlaneRoad

G = 9.81


def axes(slope):
    """Up the slope, across it, and away from it, as columns."""
    c, s = math.cos(slope), math.sin(slope)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]).T


def crate(sizes, mass, mu, slope, contact, fall=0.0, in_equilibrium=False):
    """A crate of `sizes` along `axes(slope)`, its lowest corners `fall` above the slope."""
    m = mbs.Model("crate")
    m.floating, m.start_in_equilibrium = not in_equilibrium, in_equilibrium
    road, half, R = m.road(PlaneRoad(grade_x=math.tan(slope), friction=mu)), 0.5 * np.asarray(sizes), axes(slope)
    com = R @ (0.0, 0.0, half[2] + fall)
    corners = [com + R @ (half * (i, j, k)) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    inertia = R @ np.diag(mass / 3.0 * (half @ half - half**2)) @ R.T
    body = m.body("crate", mass=mass, com=com, inertia=inertia)
    m.contact_points("feet", body, corners, road=road, contact=contact)
    for c in "xyz":
        m.sense_position(c, body, None, c)
        m.sense_position(f"v{c}", body, None, c, order=1)
    m.sense_angle("pitch", body, "pitch")
    return mbs.compile(m)


def moved(r, since):
    """Largest distance, m, from where the crate is at a time."""
    places = np.column_stack([r[c] for c in "xyz"])[np.searchsorted(r.t, since) :]
    return float(np.linalg.norm(places - places[0], axis=1).max())


def drawn(rng):
    """Sizes, mass, friction, contact, fall and step of a crate."""
    size, mass = 10.0 ** rng.uniform(-1.0, 1.0), 10.0 ** rng.uniform(-1.0, 4.0)
    depth = rng.choice([0.005, 0.001, 0.002 * size])
    if (h := rng.choice([1e-3, 2e-3, 5e-3, 1e-2])) > math.sqrt(depth / G):
        h = 1e-3  # steps that follow the impact
    sizes = size * np.array([1.0, rng.uniform(0.5, 1.0), rng.uniform(0.3, 1.0)])
    contact = ContactPoints.for_mass(mass / 4.0, depth)
    return sizes, mass, rng.uniform(0.2, 0.8), contact, size * rng.choice([0.0, 0.01, rng.uniform(0.0, 0.01)]), h


@pytest.mark.parametrize(("degrees", "h"), [(14.0, 1e-3), (25.0, 5e-3)])
def test_a_crate_stands(degrees, h):
    system = crate((1.0, 1.0, 1.0), 10.0, 0.5, math.radians(degrees), ContactPoints.for_mass(10.0, 0.001))
    r = mbs.simulate(system, 10.0, h, progress=False)
    assert moved(r, 5.0) < 1e-9


@pytest.mark.parametrize(("degrees", "fall"), [(0.0, 0.01), (3.0, -0.001), (25.0, 0.01)])
def test_it_starts_in_equilibrium_on_a_slope(degrees, fall):
    contact, slope = ContactPoints.for_mass(2.5), math.radians(degrees)
    r = mbs.simulate(crate((1.0, 0.8, 0.6), 10.0, 0.5, slope, contact, fall, True), 2.0, 5e-3, progress=False)
    assert moved(r, 0.0) < 1e-8
    assert axes(slope)[:, 2] @ [r[c][0] for c in "xyz"] == pytest.approx(0.3, abs=0.01)


def test_no_equilibrium_is_found_where_friction_cannot_hold():
    with pytest.raises(mbs.ModelError, match="has no static equilibrium near its drawing"):
        crate((1.0, 0.8, 0.6), 10.0, 0.5, math.atan(0.51), ContactPoints.for_mass(2.5), 0.0, True)


@pytest.mark.slow
def test_crates_drawn_by_chance_stand():
    rng, stood = np.random.default_rng(11), 0
    for _ in range(12):
        sizes, mass, mu, contact, fall, h = drawn(rng)
        steepest = min(math.atan(0.9 * mu), 0.7 * math.atan(sizes[0] / sizes[2]))
        system = crate(sizes, mass, mu, steepest * rng.choice([1.0, rng.uniform()]), contact, fall)
        r = mbs.simulate(system, 60.0 if h > 2e-3 else 20.0, h, progress=False)
        assert moved(r, 10.0) < 1e-3 * sizes[0]
        assert abs(r["vx"][-1]) < 1e-9
        stood += 1
    assert stood == 12


@pytest.mark.slow
def test_beyond_friction_they_slide_and_beyond_the_angle_they_tip():
    rng, slid, tipped = np.random.default_rng(12), 0, 0
    for k in range(10):
        sizes, mass, mu, contact, fall, h = drawn(rng)
        tips = k % 2
        if tips:
            mu, sizes = 0.8, sizes[0] * np.array([0.3, 0.8, 1.0])
        else:
            sizes[2] = 0.3 * sizes[0]
        slope = math.atan(0.3) * rng.uniform(1.05, 1.3) if tips else math.atan(mu * rng.uniform(1.05, 2.0))
        r = mbs.simulate(crate(sizes, mass, mu, slope, contact, fall), 10.0, h, progress=False, estimate_error=False)
        if tips:
            assert np.abs(r["pitch"] - r["pitch"][0]).max() > 1.5
            tipped += 1
        else:
            speed = -np.column_stack([r[f"v{c}"] for c in "xyz"]) @ axes(slope)[:, 0]
            i = np.searchsorted(r.t, 5.0)
            expected = G * (math.sin(slope) - mu * math.cos(slope))
            assert (speed[-1] - speed[i]) / (r.t[-1] - r.t[i]) == pytest.approx(expected, rel=1e-6)
            slid += 1
    assert slid == tipped == 5


def witness(sizes, mass, mu, slope, contact, fall, t_end, h):
    """The same law in the plane of the slope by another integrator: along it, away from it, angle about y."""
    a, c = 0.5 * sizes[0], 0.5 * sizes[2]
    inertia, points = mass / 3.0 * (a * a + c * c), [(-a, -c), (a, -c)]
    x, z, angle, vx, vz, rate = 0.0, c + fall, 0.0, 0.0, 0.0, 0.0
    stick = [0.0, 0.0]
    k, d, w = contact.stick_stiffness, contact.stick_damping, contact.onset
    bound = contact.restitution / (1.0 - contact.restitution)
    for _ in range(round(t_end / h)):
        fx, fz, moment = -mass * G * math.sin(slope), -mass * G * math.cos(slope), 0.0
        cos, sin = math.cos(angle), math.sin(angle)
        for i, (px, pz) in enumerate(points):
            rx, rz = cos * px + sin * pz, cos * pz - sin * px
            depth = -(z + rz)
            if depth <= 0.0:
                stick[i] = 0.0
                continue
            pressing, speed = -(vz - rate * rx), vx + rate * rz
            loss = contact.loss * abs(pressing) / (1.0 + bound * contact.loss * abs(pressing))
            force = contact.stiffness * (depth * depth / (2.0 * w) if depth < w else depth - 0.5 * w)
            force *= 1.0 + loss if pressing > 0.0 else 1.0 / (1.0 + loss)
            elastic = k * stick[i] + d * speed
            rub = max(-mu * force, min(mu * force, elastic))
            stick[i] += h * (rub - k * stick[i]) / d
            fx, fz = fx - 2.0 * rub, fz + 2.0 * force  # two corners each
            moment += 2.0 * (rz * -rub - rx * force)
        vx, vz, rate = vx + h * fx / mass, vz + h * fz / mass, rate + h * moment / inertia
        x, z, angle = x + h * vx, z + h * vz, angle + h * rate
    return x, z, angle


@pytest.mark.slow
def test_another_integrator_of_the_law_agrees():
    sizes, mass, mu, slope, fall = (1.0, 0.8, 0.6), 10.0, 0.5, math.radians(20.0), 0.01
    contact = ContactPoints.for_mass(10.0, 0.002)
    system = crate(sizes, mass, mu, slope, contact, fall)
    r = mbs.simulate(system, 0.25, 2e-5, progress=False, estimate_error=False)
    x, _, z = axes(slope).T @ [r[c][-1] for c in "xyz"]
    own = witness(sizes, mass, mu, slope, contact, fall, 0.25, 2e-6)
    start = 0.5 * sizes[2] + fall
    assert own[0] < -1e-3  # it has slid, and turned
    assert abs(own[2]) > 1e-4
    np.testing.assert_allclose((x, z - start), (own[0], own[1] - start), atol=2e-6)
    assert r["pitch"][-1] - r["pitch"][0] == pytest.approx(own[2], abs=4e-6)
