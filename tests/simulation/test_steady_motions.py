"""`linearise` about motions in which coordinates turn, against closed forms, and what it refuses."""

import numpy as np
import pytest
from scipy.interpolate import PPoly

from mbs import Model, Simulation, System, compile, linearise

GRAVITY = 9.81
RELATIVE = 1e-6
STILL = 2e-2  # rad/s, a double zero eigenvalue is split by the square root of round-off


def spinning_body(inertia, rates):
    m = Model("spinning body", dimension=3, gravity=(0.0, 0.0, 0.0))
    body = m.body("body", mass=1.0, com=(0.2, 0.0, 0.0), inertia=inertia)
    m.initial_velocity(body, linear=(0.0, 0.0, 0.0), angular=rates)
    return Simulation(compile(m))


def frequencies(model):
    """Imaginary parts of the eigenvalues, rad/s, without those of free motions."""
    return sorted(m.eigenvalue.imag for m in model.modes if m.eigenvalue.imag > STILL)


def test_a_symmetric_rotor_nutates_at_its_rate_seen_from_the_earth():
    """(I3/I1) W in earth axes, Euler's top."""
    model = linearise(spinning_body((0.05, 0.05, 0.07), (0.0, 0.0, 100.0)))
    assert model.frame_turning == (0.0, 0.0, 0.0)
    assert frequencies(model) == pytest.approx([140.0], rel=RELATIVE)


def test_a_body_of_three_inertias_wobbles_at_the_rate_of_eulers_equations():
    """W sqrt((I3 - I1)(I3 - I2)/(I1 I2)) in axes that turn with it, and free shifts that seem to turn."""
    model = linearise(spinning_body((0.05, 0.06, 0.07), (0.0, 0.0, 100.0)))
    assert model.frame_turning == pytest.approx((0.0, 0.0, 100.0), rel=RELATIVE)
    expected = 100.0 * np.sqrt((0.07 - 0.05) * (0.07 - 0.06) / (0.05 * 0.06))
    assert frequencies(model) == pytest.approx([expected, 100.0, 100.0, 100.0], rel=RELATIVE)


def test_the_middle_axis_is_unstable_at_its_rate():
    model = linearise(spinning_body((0.05, 0.06, 0.07), (0.0, 100.0, 0.0)))
    growth = 100.0 * np.sqrt((0.07 - 0.06) * (0.06 - 0.05) / (0.05 * 0.07))
    assert max(m.eigenvalue.real for m in model.modes) == pytest.approx(growth, rel=RELATIVE)


def test_a_tumbling_body_is_refused():
    with pytest.raises(ValueError, match=r"neither in equilibrium nor in a steady motion: 'body\..*mbs\.floquet"):
        linearise(spinning_body((0.05, 0.06, 0.07), (50.0, 100.0, 0.0)))


@pytest.mark.parametrize("driven", [False, True], ids=["free hub", "driven hub"])
def test_a_lag_hinge_swings_at_the_root_of_its_offset(driven):
    """W sqrt(e S / I) about a hub that keeps its rate: S first, I second moment of the blade about its hinge."""
    rate, offset, length, mass = 10.0, 0.1, 1.0, 2.0
    about_centre = mass * length**2 / 12.0
    m = Model("lag hinge", dimension=3, gravity=(0.0, 0.0, 0.0))
    hub = m.body("hub", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1e6, 1e6, 1e6))
    blade = m.body("blade", mass=mass, com=(offset + length / 2, 0.0, 0.0), inertia=(1e-3, about_centre, about_centre))
    m.revolute("shaft", m.ground, hub, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    m.revolute("lag", hub, blade, point=(offset, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    azimuth = m.relative_angle("azimuth", m.ground, hub, axis=(0.0, 0.0, 1.0))
    if driven:
        m.drive("motor", azimuth, m.guide_time("turning", PPoly([[rate], [0.0]], [0.0, 100.0])))
    m.initial_velocity(hub, linear=(0.0, 0.0, 0.0), angular=(0.0, 0.0, rate))
    m.initial_velocity(blade, linear=(0.0, rate * (offset + length / 2), 0.0), angular=(0.0, 0.0, rate))
    m.initial_rate(azimuth, rate)
    model = linearise(Simulation(compile(m)))
    inertia = about_centre + mass * length**2 / 4.0
    expected = rate * np.sqrt(offset * mass * length / 2.0 / inertia)
    assert frequencies(model) == pytest.approx([expected], rel=1e-5)  # a free hub swings along by 1e-6
    assert model.frame_turning == pytest.approx((0.0, 0.0, rate), rel=RELATIVE)


def test_the_nutation_of_a_steady_top_is_that_of_its_effective_potential():
    """Heavy symmetric top: sqrt(V''(theta)/I1) with the momenta about both axes held (Goldstein, section 5.7)."""
    angle, spin, mass, arm, across, along = 0.4, 150.0, 1.0, 0.2, 0.02, 0.006
    about_tip = across + mass * arm**2
    momentum = along * spin
    root = np.sqrt(momentum**2 - 4.0 * about_tip * np.cos(angle) * mass * GRAVITY * arm)
    precession = (momentum - root) / (2.0 * about_tip * np.cos(angle))
    axis = np.array([np.sin(angle), 0.0, np.cos(angle)])
    turn = np.array([[axis[2], 0.0, axis[0]], [0.0, 1.0, 0.0], [-axis[0], 0.0, axis[2]]])
    rates = precession * np.array([0.0, 0.0, 1.0]) + (spin - precession * np.cos(angle)) * axis
    m = Model("top", dimension=3)
    top = m.body("top", mass=mass, com=arm * axis, inertia=turn @ np.diag([across, across, along]) @ turn.T)
    m.spherical("tip", m.ground, top, point=(0.0, 0.0, 0.0))
    m.initial_velocity(top, linear=np.cross(rates, arm * axis), angular=rates)
    model = linearise(Simulation(compile(m)))

    s, c = np.sin(angle), np.cos(angle)
    vertical = about_tip * precession * s**2 + momentum * c
    lean = vertical - momentum * c
    second = (
        momentum**2 / about_tip
        - 3.0 * lean * momentum * c / (about_tip * s**2)
        + lean**2 * (1.0 + 2.0 * c**2) / (about_tip * s**4)
        - mass * GRAVITY * arm * c
    )
    assert frequencies(model) == pytest.approx([np.sqrt(second / about_tip)], rel=1e-5)
    assert model.frame_turning == pytest.approx((0.0, 0.0, precession), rel=1e-5)


def test_a_symmetric_rotor_on_springs_whirls_as_seen_from_the_earth():
    """Jeffcott rotor without gyroscopic moment: its frequency does not depend on its rate."""
    mass, stiffness = 2.0, 800.0
    m = Model("rotor", dimension=2, gravity=(0.0, 0.0))
    rotor = m.body("rotor", mass=mass, com=(0.0, 0.0), inertia=0.1)
    for k, end in enumerate([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]):
        m.spring_damper(f"spring {k}", (rotor, (0.0, 0.0)), (m.ground, end), stiffness=stiffness, free_length=1.0)
    m.initial_velocity(rotor, linear=(0.0, 0.0), angular=30.0)
    model = linearise(Simulation(compile(m)))
    assert frequencies(model) == pytest.approx([np.sqrt(2.0 * stiffness / mass)] * 2, rel=RELATIVE)


def test_a_state_at_rest_out_of_equilibrium_is_refused():
    m = Model("falling", dimension=2)
    m.point_mass("bob", mass=1.0, position=(0.0, 0.0))
    with pytest.raises(ValueError, match="changes its rate by -9.81 per second"):
        linearise(Simulation(compile(m)))


def test_a_moving_system_from_a_file_reports_unknown_axes():
    rotor = spinning_body((0.05, 0.05, 0.07), (0.0, 0.0, 100.0)).system
    with pytest.raises(ValueError, match="read from a file"):
        linearise(Simulation(System.from_bytes(rotor.to_bytes())))
