"""Bodies that touch a road, in the whole engine: closed forms, orders, energy, every kind of road."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import mbs
from mbs.common.errors import ModelError
from mbs.elements import ContactPoints, EndStops, GridRoad, KerbRoad, PlaneRoad

G = 9.81  # m/s2
MASS = 40.0  # kg
HALF = (0.3, 0.2)  # m
HEIGHT = 0.1  # m
MU = 0.4
CONTACT = ContactPoints.for_mass(10.0, depth=0.002, onset=0.001, loss=0.5)
CORNERS = [(x, y, -HEIGHT) for x in (-HALF[0], HALF[0]) for y in (-HALF[1], HALF[1])]


def block(road, speed=(0.0, 0.0, 0.0), lift=0.0, points=CORNERS, contact=CONTACT, com=(0.0, 0.0, HEIGHT), gravity=G):
    """A block on a road, its lower corners in contact as deep as its weight presses them."""
    m = mbs.Model("block", gravity=(0.0, 0.0, -gravity))
    m.floating = True
    number = m.road(road)
    place = np.add(com, (0.0, 0.0, lift))
    inertia = MASS / 12.0 * np.array([0.4**2 + 0.2**2, 0.6**2 + 0.2**2, 0.6**2 + 0.4**2])
    body = m.body("block", mass=MASS, com=place, inertia=inertia)
    m.contact_points("feet", body, place + np.array(points), road=number, contact=contact)
    m.initial_velocity(body, linear=speed)
    for c in "xyz":
        m.sense_position(c, body, None, c)
        m.sense_position(f"v{c}", body, None, c, order=1)
        m.sense_element(f"f{c}", "feet", f"force_{c}")
    for name in ("normal_force", "touching", "depth"):
        m.sense_element(name, "feet", name)
    m.sense_angle("pitch", body, "pitch")
    m.sense_energy("energy", "total")
    return mbs.compile(m)


def run(system, t, h, **more):
    # blocks that tumble are sensitive: what is asserted here is what holds for every step
    return mbs.simulate(system, t, h, progress=False, estimate_error=False, **more)


def test_energy_momentum_has_the_stiffness_of_its_mean_force():
    """A block that drops 50 mm, steps of 10 ms: four iterations a step, five and a half without that stiffness."""
    r = run(block(PlaneRoad(friction=MU), (1.0, 0.0, 0.0), 0.05), 0.5, 0.01, method="energy_momentum")
    assert r["touching"].max() == 4
    assert r.report.iterations < 4.8 * r.report.steps


def test_block_slides_to_rest():
    v = 3.0
    r = run(block(PlaneRoad(friction=MU), (v, 0.0, 0.0), -0.002), 1.5, 0.001)
    stop = v / (MU * G)
    assert r["x"][-1] == pytest.approx(v**2 / (2.0 * MU * G), rel=2e-3)
    sliding = (r.t > 0.1) & (r.t < stop - 0.1)
    # small rocking about the edge under the centre of mass changes no mean
    assert -r["fx"][sliding].mean() == pytest.approx(MU * MASS * G, rel=2e-3)
    rest = r.t > stop + 0.3
    assert np.abs(r["vx"][rest]).max() < 2e-3
    assert np.abs(r["x"][rest] - r["x"][-1]).max() < 1e-4
    assert r["normal_force"][-1] == pytest.approx(MASS * G, rel=1e-3)
    assert r["touching"][-1] == 4
    assert r["depth"][-1] == pytest.approx(0.002, rel=0.1)


@pytest.mark.parametrize(("grade", "holds"), [(0.9 * MU, True), (1.1 * MU, False)])
def test_block_on_a_slope(grade, holds):
    tilt = math.atan(grade)
    c, s = math.cos(tilt), math.sin(tilt)
    # the block is drawn level; its corners lie in the plane of the slope
    points = [(x * c + (HEIGHT + 0.002) * s, y, x * s - (HEIGHT + 0.002) * c) for x, y, _ in CORNERS]
    r = run(block(PlaneRoad(grade_x=grade, friction=MU), com=(-HEIGHT * s, 0.0, HEIGHT * c), points=points), 4.0, 0.002)
    if holds:
        late = r.t > 2.0
        assert np.abs(r["x"][late] - r["x"][-1]).max() < 2e-6  # it does not creep
        assert r["fx"][-1] == pytest.approx(0.0, abs=1e-3 * MASS * G)
        assert r["fz"][-1] == pytest.approx(MASS * G, rel=1e-4)
    else:
        a = G * (s - MU * c)
        along = -(r["vx"] * c + r["vz"] * s)
        i, j = np.searchsorted(r.t, [1.0, 3.0])
        assert (along[j] - along[i]) / (r.t[j] - r.t[i]) == pytest.approx(a, rel=2e-3)


def after_impact(v, chi):
    """Speed after an impact by Hunt and Crossley with the loss of `mbs.elements.ContactPoints`."""
    energy = (chi * v - math.log1p(chi * v)) / chi**2
    return brentq(lambda x: x * x / 2.0 + chi * x**3 / 3.0 - energy, 0.0, v, xtol=1e-14)


def test_ball_bounces_with_the_speed_of_the_closed_form():
    chi = 0.5
    contact = ContactPoints(4e6, 4e6, 1e4, onset=0.003, loss=chi, radius=0.1)
    system = block(PlaneRoad(), (0.0, 0.0, -4.0), 0.01, [(0.0, 0.0, 0.0)], contact, gravity=0.0)
    errors = []
    for h in (4e-4, 2e-4, 1e-4):
        r = run(system, 0.1, h)
        assert r["touching"].max() == 1
        assert r["touching"][-1] == 0
        errors.append(abs(r["vz"][-1] / after_impact(4.0, chi) - 1.0))
    assert errors[-1] < 3e-4
    assert errors[-1] < errors[0] / 6.0


@pytest.mark.parametrize(("e", "times"), [(0.3, 0.1), (0.5, 1.0), (0.8, 10.0)])
def test_the_default_loss_is_that_of_a_restitution(e, times):
    """At sqrt(g depth) it is e, and e/2 is the limit of fast impacts; else by quadrature of m v dv = -F g dx."""
    contact = ContactPoints.for_mass(MASS, 0.01, restitution=e)
    v, bound = times * math.sqrt(G * 0.01), 0.5 * e / (1.0 - 0.5 * e)

    def factor(u):
        return 1.0 + contact.loss * u / (1.0 + contact.loss * u * bound)

    taken = quad(lambda u: u / factor(u), 0.0, v)[0]
    out = brentq(lambda x: quad(lambda u: u * factor(u), 0.0, x)[0] - taken, 0.0, v)
    system = block(PlaneRoad(), (0.0, 0.0, -v), HEIGHT, [(0.0, 0.0, -HEIGHT)], contact, gravity=0.0)
    r = run(system, 0.3 + 3.0 * HEIGHT / (e * v), min(1e-4 / v, 1e-3), settings=mbs.Settings(tolerance_r=1e-12))
    assert r["touching"][-1] == 0
    assert r["vz"][-1] == pytest.approx(out, rel=2e-4)
    assert times != 1.0 or out == pytest.approx(e * v, rel=1e-9)
    assert times != 10.0 or 0.5 * e * v < out < 0.8 * e * v


def test_order_of_a_pressed_and_sliding_block():
    system = block(PlaneRoad(friction=MU), (3.0, 0.5, 0.0), -0.0015)
    fine = run(system, 0.4, 6.25e-5, settings=mbs.Settings(tolerance_r=1e-13))
    errors = []
    for h in (1e-3, 5e-4, 2.5e-4):
        r = run(system, 0.4, h, settings=mbs.Settings(tolerance_r=1e-13))
        errors.append(max(abs(r[k][-1] - fine[k][-1]) for k in "xyz"))
    assert 1.6 < math.log2(errors[0] / errors[1]) < 3.0
    assert 1.6 < math.log2(errors[1] / errors[2]) < 3.0


@pytest.mark.parametrize(("overhang", "falls"), [(-0.05, False), (0.02, True)])
def test_block_tilts_over_an_edge_when_its_centre_is_beyond_it(overhang, falls):
    # the foremost feet end at the edge: points only up to x = -overhang from the centre of mass
    points = [(x, y, -HEIGHT) for x in (-HALF[0], -overhang) for y in (-HALF[1], HALF[1])]
    r = run(block(PlaneRoad(height=0.0, friction=2.0), lift=-0.001, points=points), 1.0, 0.002)
    assert bool(np.abs(r["pitch"]).max() > 0.2) is falls
    assert falls or r["pitch"][-1] == pytest.approx(0.0, abs=0.02)


def test_grid_holds_a_block_like_the_plane_it_draws():
    grade = 0.1
    x = np.linspace(-5.0, 5.0, 21)
    grid = GridRoad((-5.0, -5.0), (0.5, 0.5), np.repeat(grade * x[:, None], 21, axis=1), MU)
    a, b = (run(block(road, (1.0, 0.3, 0.0), 0.03), 0.6, 0.001) for road in (grid, PlaneRoad(0.0, grade, 0.0, MU)))
    for k in "xyz":
        assert np.allclose(a[k], b[k], atol=1e-9)
    assert a["touching"].max() >= 2


def test_energy_momentum_keeps_the_energy_of_a_contact_without_loss():
    contact = ContactPoints(2e5, 2e5, 1e3, onset=0.01, friction_factor=0.0)
    r = run(
        block(PlaneRoad(0.0, 0.15, 0.0), (0.0, 0.0, -2.0), 0.15, contact=contact), 1.0, 2e-3, method="energy_momentum"
    )
    assert r["touching"].max() >= 2
    assert np.sum(np.diff((r["touching"] > 0).astype(int)) > 0) >= 2  # several blows
    scale = r["energy"].max() - MASS * G * 0.0 + 1.0
    assert np.abs(r["energy"] - r["energy"][0]).max() < 1e-6 * abs(scale)


def test_energy_only_falls_in_a_tumble():
    r = run(block(PlaneRoad(friction=MU), (4.0, 1.0, -3.0), 0.5), 3.0, 0.0005)
    # the trapezoidal rule errs with the square of the step at a blow
    assert np.diff(r["energy"]).max() < 2e-3 * (r["energy"][0] - r["energy"][-1])
    assert r["energy"][-1] < r["energy"][0] - 300.0


def test_vocabulary_refuses_by_name():
    m = mbs.Model("plane", dimension=2)
    body = m.body("b", mass=1.0, com=(0.0, 0.0), inertia=1.0)
    m.road(PlaneRoad())
    with pytest.raises(ModelError, match="rigid body in space"):
        m.contact_points("feet", body, [[0.0, 0.0, 0.0]], road=0, contact=CONTACT)
    m = mbs.Model("space")
    body = m.body("b", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    with pytest.raises(ModelError, match="ask for road 0; the model has 0"):
        m.contact_point("foot", body, (0.0, 0.0, 0.0), road=0, contact=CONTACT)
    m.road(PlaneRoad())
    with pytest.raises(ModelError, match=r"shape \(2,\)"):
        m.contact_points("feet", body, [0.0, 1.0], road=0, contact=CONTACT)
    assert m.contact_point("foot", body, (0.0, 0.0, 0.0), road=0, contact=CONTACT).integer == (0, 1)


@pytest.mark.parametrize("loss", [0.0, 0.5])
def test_energy_momentum_in_a_progressive_stop(loss):
    m = mbs.Model("stop")
    mass = m.point_mass("mass", mass=30.0, position=(0.0, 0.0, 0.7))
    stops = EndStops(
        0.6, 8e4, 0.8, 8e4, 0.02, 0.02, 0.03, 0.03, metal_stiffness=5e6, metal_onset=0.003,
        bump_loss=loss, rebound_loss=loss,
    )  # fmt: skip
    m.spring_damper("spring", mass, (m.ground, (0.0, 0.0, 0.0)), stiffness=2e3, stops=stops)
    m.initial_velocity(mass, linear=(0.3, 0.0, -3.0))
    m.sense_energy("energy", "total")
    m.sense_element("length", "spring", "length")
    r = run(mbs.compile(m), 1.0, 1e-3, method="energy_momentum")
    assert r["length"].min() < 0.58  # the metal end
    assert r["length"].max() > 0.8
    if loss == 0.0:
        assert np.abs(r["energy"] - r["energy"][0]).max() < 1e-6 * 135.0
    else:
        assert np.diff(r["energy"]).max() < 1e-6
        assert r["energy"][-1] < r["energy"][0] - 50.0


def test_energy_momentum_keeps_energy_on_the_edge_of_a_kerb():
    kerb = KerbRoad(0.01, 0.303, -0.3, "after")  # its top 3 mm above the foot that runs into it
    contact = ContactPoints(2e5, 2e5, 1e3, onset=0.01, friction_factor=0.0)
    system = block(kerb, (0.5, 0.0, 0.0), 0.0, [(0.0, 0.0, -HEIGHT)], contact, gravity=0.0)
    r = run(system, 0.3, 1e-3, method="energy_momentum")
    assert r["fx"].min() < -5.0
    assert r["fz"].max() > 10.0
    assert np.abs(r["energy"] - r["energy"][0]).max() < 1e-8 * r["energy"][0]


def test_steps_of_a_similar_box_of_a_microgram_are_divided_alike():
    """A box that slides and tumbles: changes of forces count, and not that of the number of points that touch."""

    def tumble(mass):
        m = mbs.Model("box", gravity=(0.0, 0.0, -G))
        body = m.body("box", mass=mass, com=(0.0, 0.0, 1.0), inertia=mass * np.array([0.1, 0.15, 0.2]))
        corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.4, 0.4) for z in (0.7, 1.3)]
        contact = ContactPoints(stiffness=2e3 * mass, stick_stiffness=2e3 * mass, stick_damping=50.0 * mass, loss=0.3)
        m.contact_points("corners", body, corners, road=m.road(PlaneRoad(friction=MU)), contact=contact)
        m.initial_velocity(body, linear=(3.0, 0.5, 0.0), angular=(1.0, 2.0, 0.5))
        for c in "xyz":
            m.sense_position(c, body, None, c)
        r = run(mbs.compile(m), 0.8, 0.02)
        return r.report.divisions, np.array([r[c] for c in "xyz"])

    (divisions, positions), (small_divisions, small_positions) = tumble(1.0), tumble(1e-6)
    assert 0 < small_divisions == divisions
    assert small_positions == pytest.approx(positions, abs=1e-6)


@pytest.mark.parametrize("speed", [(0.5, 0.0, 0.0), (0.0, 0.5, 0.0)])
def test_steps_in_which_friction_lets_go_are_divided_in_each_direction(speed):
    r = run(block(PlaneRoad(friction=MU), speed, -0.002), 0.3, 0.01)
    assert r.report.divisions > 0
