"""A scene that is not tied to the ground starts at the given position, heading and speed."""

import numpy as np
import pytest

from mbs import Model, ModelError, Simulation, compile
from mbs.simulation.state import Pose

EXACT = 1e-9


def trolley(floating=True):
    """A frame with a hinged arm and a wheel reduced to its spin."""
    m = Model("trolley")
    m.floating = floating
    frame = m.body("frame", mass=10.0, com=(0.1, 0.0, 0.5), inertia=(1.0, 1.2, 1.5))
    arm = m.body("arm", mass=2.0, com=(0.5, 0.4, 0.6), inertia=(0.1, 0.15, 0.2))
    m.revolute("hinge", frame, arm, point=(0.4, 0.2, 0.6), axis=(1.0, 0.5, 0.0))
    angle = m.relative_angle("theta", frame, arm, axis=(1.0, 0.5, 0.0), zero=0.2)
    m.spin(
        "wheel", carrier=arm, centre=(0.5, 0.7, 0.3), axis=(0, 1, 0), mass=5.0, spin_inertia=0.2,
        diametral_inertia=0.15, rolling_radius=0.3,
    )  # fmt: skip
    for c in "xyz":
        m.sense_position(f"p{c}", arm, (0.5, 0.7, 0.3), c)
        m.sense_position(f"v{c}", arm, (0.5, 0.7, 0.3), c, order=1)
    m.sense_angle("yaw", frame, "yaw")
    m.sense_coordinate("angle", angle)
    m.sense_coordinate("hinge", angle, order=1)
    m.sense_rotation("turn", frame, "z", order=1)
    m.sense_coordinate("spin", m.spins[0], order=1)
    return m


def test_pose_slides_and_turns_the_whole_scene():
    """Each point has the velocity of the origin and that of the turn about it; the hinge and the spin stay."""
    yaw, speed, lateral, rate = 0.9, 7.0, -1.5, 0.6
    s = Simulation(compile(trolley()), pose=Pose(3.0, -2.0, 0.4, yaw, speed, lateral, rate)).sensors
    c, d = np.cos(yaw), np.sin(yaw)
    turn = np.array([[c, -d, 0], [d, c, 0], [0, 0, 1]])
    place = turn @ [0.5, 0.7, 0.3] + [3.0, -2.0, 0.4]
    np.testing.assert_allclose([s["px"], s["py"], s["pz"]], place, rtol=0, atol=EXACT)
    assert (s["yaw"], s["angle"]) == pytest.approx((yaw, 0.2), abs=EXACT)
    expected = turn @ (np.array([speed, lateral, 0.0]) + np.cross([0.0, 0.0, rate], [0.5, 0.7, 0.3]))
    np.testing.assert_allclose([s["vx"], s["vy"], s["vz"]], expected, rtol=0, atol=EXACT)
    assert s["turn"] == pytest.approx(rate, abs=EXACT)
    assert s["hinge"] == pytest.approx(0.0, abs=EXACT)
    assert s["spin"] == pytest.approx(speed / 0.3, rel=EXACT)


def test_motion_does_not_depend_on_the_pose():
    """The same scene elsewhere and turned does the same, seen from itself."""
    here = Simulation(compile(trolley())).run(0.5, 0.005)
    yaw = 2.2
    present = Simulation(compile(trolley()), pose=Pose(5.0, 1.0, 0.0, yaw, 0.0)).run(0.5, 0.005)
    c, d = np.cos(yaw), np.sin(yaw)
    x, y = present["px"] - 5.0, present["py"] - 1.0
    np.testing.assert_allclose(c * x + d * y, here["px"], rtol=0, atol=1e-7)
    np.testing.assert_allclose(-d * x + c * y, here["py"], rtol=0, atol=1e-7)
    np.testing.assert_allclose(present["angle"], here["angle"], rtol=0, atol=1e-7)


def train():
    """Free bodies on springs, a slide and a rod, and one by table: no linear equation ties their positions."""
    m = trolley()
    frame = m.bodies[0]
    box, inertia = {"mass": 3.0, "inertia": (0.2, 0.2, 0.3)}, (0.1, 0.1, 0.1)
    free = m.body("free", com=(2.0, 0.1, 0.5), **box)
    slide = m.body("slide", com=(-1.0, 0.0, 0.7), **box)
    hung = m.body("hung", com=(0.3, 0.2, -0.6), **box)
    ball = m.point_mass("ball", mass=1.0, position=(0.5, -0.5, 0.1))
    m.spring_damper("coupling", (frame, (0.6, 0.0, 0.5)), (free, (1.6, 0.1, 0.5)), stiffness=400.0, damping=5.0)
    m.prismatic("rail", frame, slide, axis=(1.0, 0.0, 0.3), point=(-1.0, 0.0, 0.7))
    m.distance("rod", (frame, (0.3, 0.2, 0.2)), (hung, (0.3, 0.2, -0.3)))
    m.spring_damper("leash", (slide, (-1.0, 0.0, 0.9)), (ball, (0.5, -0.5, 0.1)), stiffness=50.0, damping=1.0)
    tabled = m.tabled_body(
        "tabled", base=frame, parameters=m.travel("stroke"), axes=[np.linspace(-9.0, 9.0, 9)], mass=0.5,
        places=np.linspace([-1.0, 0.0, -8.0], [1.0, 0.0, 10.0], 9), com=(0.0, 0.0, 1.0), inertia=inertia,
        rotations=np.tile(np.eye(3), (9, 1, 1)),
    )  # fmt: skip
    m.spring_damper("hanger", (frame, (0.0, 0.1, 2.0)), (tabled, (0.0, 0.0, 1.0)), stiffness=70.0, damping=1.0)
    for body in (free, slide, hung, ball, tabled):
        m.sense_position(f"{body.name}.z", body, tuple(body.com), "z")
    return m


def test_far_away_several_bodies_move_as_at_the_origin_bit_for_bit():
    system = compile(train())
    inputs = {"yaw": 0.3, "speed": 3.0, "yaw_rate": 0.5}
    near = Simulation(system, pose=Pose(**inputs)).run(0.5, 0.005)
    for shift in (5e5, 1e8):
        far = Simulation(system, pose=Pose(shift, -shift, **inputs)).run(0.5, 0.005)
        assert np.ptp(near["ball.z"]) > 0.1
        for name in near:
            if name not in ("px", "py"):
                np.testing.assert_array_equal(far[name], near[name], name)
        np.testing.assert_allclose(far["px"] - shift, near["px"], rtol=0, atol=1e-14 * shift)


def test_a_scene_tied_to_the_ground_cannot_float():
    m = trolley()
    m.spherical("anchor", m.bodies[0], m.ground, point=(0, 0, 0.5))
    with pytest.raises(ModelError, match="declared floating"):
        compile(m)
