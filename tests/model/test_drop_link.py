"""Levers with a link, and the bars they carry, against closed forms."""

import numpy as np
import pytest

import mbs
from mbs import Model, ModelError, compile

B = 0.5  # m, half the track
LEVER = 0.25  # m
ROD = 0.3  # m
K = 120.0  # N m/rad
INERTIA = 8.0  # kg m2
Y = (0.0, 1.0, 0.0)


def lifted(axis=Y, side=0.0):
    """A lever of 0.25 m on the ground and a rod down to a body that a driving function lifts by 0.1 m."""
    m = Model("lever", gravity=(0, 0, 0))
    body = m.body("body", mass=2.0, com=(LEVER, side, -ROD), inertia=(0.1, 0.1, 0.1))
    m.prismatic("column", body, m.ground, axis=(0, 0, 1))
    m.drive("lift", body.point(body.com)[2] + ROD, m.guide_time("way", ([0, 1, 2], [0, 0.1, 0]), unit="m"))
    angle = m.drop_link(
        "link", m.ground, body, pivot=(0, 0, 0), axis=axis, lever_end=(LEVER, side, 0), link_end=(LEVER, side, -ROD)
    )
    m.torsional_spring_damper("bar", angle, stiffness=K)
    m.sense_coordinate("angle", angle)
    m.sense_position("z", body, body.com, "z")
    m.sense_joint("tension", "link", "tension")
    return m


def exact_angle(z):
    """Angle of the lever about y (positive: its end goes down) with the rod's lower end at (LEVER, z)."""
    d = np.hypot(LEVER, z)
    turned = np.arccos((LEVER**2 + d**2 - ROD**2) / (2.0 * LEVER * d))  # between the lever and the line to the end
    return -(np.arctan2(z, LEVER) + turned)


def test_the_lever_follows_the_law_of_cosines_and_its_rod_carries_the_torque():
    run = mbs.simulate(compile(lifted()), 2.0, 0.01, progress=False)
    theta = exact_angle(run["z"])
    np.testing.assert_allclose(run["angle"], theta, atol=1e-9)
    assert np.ptp(theta) > 0.3
    end = LEVER * np.array([np.cos(theta), -np.sin(theta)])
    rod = (np.array([np.full_like(theta, LEVER), run["z"]]) - end) / ROD
    arm = end[0] * rod[1] - end[1] * rod[0]  # of the tension about the pivot, against y
    np.testing.assert_allclose(run["tension"] * -arm, K * theta, atol=1e-3 * K * 0.3)


def test_an_end_of_the_lever_beside_the_pivot_turns_in_its_own_plane():
    """The place of the pivot along the axis is of no account."""
    near, beside = (mbs.simulate(compile(lifted(side=y)), 2.0, 0.01, progress=False) for y in (0.0, 0.2))
    np.testing.assert_allclose(near["angle"], beside["angle"], atol=1e-12)


def test_a_bar_with_links_gives_the_roll_stiffness_of_its_levers():
    """A body that rolls about x, drop links to the ground: k (2 b / L)^2."""
    m = Model("roll", gravity=(0, 0, 0))
    body = m.body("body", mass=10.0, com=(0, 0, 0), inertia=(INERTIA, 9.0, 9.0))
    m.revolute("roll axis", m.ground, body, point=(0, 0, 0), axis=(1, 0, 0))
    angles = [
        m.drop_link(name, body, m.ground, pivot=(0, y, 0), axis=Y, lever_end=(LEVER, y, 0), link_end=(LEVER, y, -ROD))
        for name, y in (("left link", B), ("right link", -B))
    ]
    m.anti_roll_bar("bar", *angles, stiffness=K)
    system = compile(m)
    assert system.report["degrees_of_freedom"] == 1
    modes = mbs.linearise(mbs.Simulation(system)).modes
    expected = np.sqrt(K * (2.0 * B / LEVER) ** 2 / INERTIA) / (2.0 * np.pi)
    assert max(mode.frequency_hz for mode in modes) == pytest.approx(expected, rel=1e-6)


def link_of(m, body, **changes):
    places = {"pivot": (0, 0, 0), "axis": Y, "lever_end": (0.2, 0, 0), "link_end": (0.2, 0, -0.3)} | changes
    return m.drop_link("link", m.ground, body, **places)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda m, a: link_of(m, a, lever_end=(0, 0.2, 0)), "lever of drop link 'link' lies along its axis"),
        (lambda m, a: link_of(m, a, link_end=(0.2, 0, 0)), "rod has no length"),
        (lambda m, a: link_of(m, a, link_end=(0.4, 0, 0)), "drawn at a dead point"),
        (lambda m, a: link_of(m, m.point_mass("p", mass=1.0, position=(1, 0, 0))), "'p' is a point mass"),
    ],
)
def test_nonsense_is_refused_with_a_sentence(make, sentence):
    m = Model("nonsense")
    a = m.body("a", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))
    before = len(m.joints), len(m.coordinates)
    with pytest.raises(ModelError, match=sentence):
        make(m, a)
    assert len(m.joints) == before[0]
